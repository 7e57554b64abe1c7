// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bounded.hpp"
#include "space_stress.hpp"

/// What space_bound.hpp has, for hexahedra of order 1.
namespace rpc::bound
{

/// Why the bound of a body of hexahedra is not known; empty if it is.
/// @param[out] facets  of the tetrahedra
/// @throws rpc::Error (bad_input) where boundary conditions are not covered
std::string not_covered_of_hexahedra(const analysis::Problem &problem, const analysis::Step &step,
                                     FacetsOfMesh &facets);

/// @param steps  of conjugate gradients
Bounded<SpaceContact> bounded_hexahedra(const analysis::Problem &problem, const analysis::StepSolution &s,
                                        const solver::LinearSolverOptions &options, int steps,
                                        const SpaceFacets &facets, const std::vector<std::string> &flat);

} // namespace rpc::bound
