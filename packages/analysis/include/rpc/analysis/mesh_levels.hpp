// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/nested_mesh.hpp"
#include "rpc/analysis/problem.hpp"
#include "rpc/solver/mesh_levels.hpp"

#include <memory>

namespace rpc::analysis
{

/// The mesh's body for algebraic multigrid: its nodes and rigid motions.
solver::Body body_of(const fem::Discretization &d);

/// The largest Poisson's ratio of the blocks.
double largest_ratio(const fem::Discretization &d, const fem::Materials &materials);

/// Whether some block has a Poisson's ratio from which bodies have solvers of their own, by `LinearRules`, outside plane stress.    (4.13)
bool is_nearly_incompressible(const fem::Discretization &d, const fem::Materials &materials);

/// Levels of multigrid: a mesh and its coarser meshes, down to a few hundred unknowns; a single level where there is no coarser one. Collective.
/// @param prescribed  (overlap dofs) 1 where the displacement of the finest mesh is prescribed
solver::MeshLevels mesh_levels(const NestedMesh &finest, const Model &model, const DeviceView<char *> &prescribed);

/// The same, made when the solver first asks for them; coarser meshes that nothing else holds are then freed.
solver::MakeMeshLevels make_mesh_levels(std::shared_ptr<const NestedMesh> finest, const Model &model,
                                        const DeviceView<char *> &prescribed);

} // namespace rpc::analysis
