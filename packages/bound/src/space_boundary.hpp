// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "boundary.hpp"
#include "space_cells.hpp"
#include "space_contact_terms.hpp"

#include <vector>

namespace rpc::bound
{

/// What boundary.hpp has in the plane.
struct SpaceBoundary {
  BoundaryTractions tractions;     ///< without the contact pressure
  std::vector<SpaceContact> sides; ///< in the order of the contact sides
  bool beyond = false;             ///< whether loads have more than the degree of the stresses
};

/// Collective.
/// @param d  of the tetrahedra   @param model  seen at the time of the step
/// @throws rpc::Error (bad_input) where the sides are not covered
SpaceBoundary boundary_of(const fem::Discretization &d, const analysis::Model &model, const analysis::Step &step,
                          const SpaceInput &in, const PointTractions &solution);

/// The same tractions with those of contact. @param contact  (sides)
BoundaryTractions with_contact(const SpaceInput &in, const SpaceBoundary &boundary,
                               const std::vector<SpaceTractions> &contact);

} // namespace rpc::bound
