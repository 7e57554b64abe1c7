// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "equilibration.hpp"
#include "rpc/analysis/run.hpp"
#include "space_cells.hpp"
#include "space_contact.hpp"

#include <vector>

namespace rpc::bound
{

/// What boundary.hpp has in the plane.
struct SpaceBoundary {
  BoundaryTractions tractions;     ///< without the contact pressure
  std::vector<SpaceContact> sides; ///< in the order of the contact sides
  bool beyond = false;             ///< whether loads have more than the degree of the stresses
};

/// @param pressure  (contact points) [Pa]
/// @throws rpc::Error (bad_input) where the sides are not covered
SpaceBoundary boundary_of(const analysis::Problem &problem, const analysis::Step &step, const SpaceInput &in,
                          const HostView<double *> &pressure);

/// The same tractions with those of contact pressures.
/// @param pressure  (sides; facets) at the corners [Pa]
BoundaryTractions with_pressure(const SpaceInput &in, const SpaceBoundary &boundary,
                                const std::vector<std::vector<OfTriangle>> &pressure);

} // namespace rpc::bound
