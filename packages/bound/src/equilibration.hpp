// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cells.hpp"
#include "facet_exchange.hpp"

namespace rpc::bound
{

/// What is known of the tractions on the boundary.
struct BoundaryTractions {
  DeviceView<char **> known; ///< (facets, component) 1 where the traction is prescribed
  DeviceView<double ***>
      load; ///< (facets, polynomials up to degree_of_loads_in(dim), component) coefficients where it is [N]
};

/// The moments int t N_a over each facet of the known tractions with the element's functions: (facets, nodes of a facet, 2) [N].
DeviceView<double ***> known_moments(const CellInput &in, const BoundaryTractions &boundary);

/// Tractions in balance with the body force on each cell, from the moments of a Galerkin solution.     doc/bounds.md (13.7)
/// Collective.
/// @param Q     nodal_forces() of the solution of the loads `boundary`
/// @param mean  mean_moments() of it, to which the tractions are to be near
Tractions equilibrated(const CellInput &in, const BoundaryTractions &boundary, const DeviceView<double ***> &Q,
                       const DeviceView<double ***> &mean, const FacetExchange &exchange);

} // namespace rpc::bound
