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

/// Of a solution, on the host.
struct PointTractions {
  HostView<double *> pressure; ///< (contact points) [Pa]
  HostView<double **> along;   ///< (contact points, 2) friction; empty where there is none [Pa]
};
/// @throws rpc::Error (bad_input) where the sides are not covered
Boundary boundary_of(const analysis::Problem &problem, const analysis::Step &step, const Facets &facets,
                     const PointTractions &solution);

/// Tractions of contact on the facets of a side: Bernstein coefficients [Pa].
struct SideTractions {
  std::vector<OfFacet> pressure, friction; ///< the latter empty where there is none
};
/// The same tractions with those of contact.
BoundaryTractions with_contact(const BoundaryTractions &loads, const std::vector<ContactFacets> &sides,
                               const std::vector<SideTractions> &contact);

/// A number as messages show it, small ones too.
std::string shown(double value);

} // namespace rpc::bound
