// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/bound/bound.hpp"
#include "space_stress.hpp"

/// What bound.hpp says, of bodies in space.
namespace rpc::bound
{

/// Why the bound of a body in space is not known; empty if it is. What does not depend on the dimension is not looked at.
/// @param[out] facets  of the mesh, for bounded_in_space()
/// @throws rpc::Error (bad_input) where boundary conditions are not covered
std::string not_covered_in_space(const analysis::Problem &problem, const analysis::Step &step, FacetsOfMesh &facets);

/// What the boundary is judged by: the stresses are not needed.
SpaceInput space_input(const fem::Discretization &d, const analysis::Model &model, const SpaceFacets &facets);

} // namespace rpc::bound
