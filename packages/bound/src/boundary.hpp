// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_pressure.hpp"
#include "equilibration.hpp"
#include "rpc/analysis/run.hpp"

#include <string>
#include <vector>

namespace rpc::bound
{

/// The contact sides of a step, and which tractions its boundary conditions prescribe.
struct Boundary {
  BoundaryTractions tractions;      ///< without the contact pressure
  std::vector<ContactFacets> sides; ///< in the order of the contact sides
};

/// @param pressure  (contact points) [Pa]
/// @throws rpc::Error (bad_input) where the sides are not covered
Boundary boundary_of(const analysis::Problem &problem, const analysis::Step &step, const Facets &facets,
                     const HostView<double *> &pressure);

/// The same tractions with those of contact pressures.
/// @param pressure  (sides; facets) Bernstein coefficients [Pa]
BoundaryTractions with_pressure(const BoundaryTractions &loads, const std::vector<ContactFacets> &sides,
                                const std::vector<std::vector<OfFacet>> &pressure);

/// A number as messages show it, small ones too.
std::string shown(double value);

} // namespace rpc::bound
