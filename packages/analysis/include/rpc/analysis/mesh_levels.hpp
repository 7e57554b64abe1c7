#pragma once

#include "rpc/analysis/nested_mesh.hpp"
#include "rpc/analysis/problem.hpp"
#include "rpc/solver/mesh_levels.hpp"

#include <optional>

namespace rpc::analysis
{

/// The mesh's body for algebraic multigrid: its nodes and rigid motions.
solver::Body body_of(const fem::Discretization &d);

/// The largest Poisson's ratio of the blocks.
double largest_ratio(const fem::Discretization &d, const fem::Materials &materials);

/// Whether multigrid's smoothers solve on stars of vertices: nearly incompressible boxes of Q2 want it.               (4.7f)
bool smooths_on_stars(const fem::Discretization &d, const fem::Materials &materials);

/// The materials of the soft part of the stiffness where a mixed form of the equations takes the least time: for nearly incompressible
/// bodies of order 2, but for boxes that nothing touches and that stars of vertices suit. Else nothing.               (4.13)
std::optional<fem::Materials> materials_of_mixed(const fem::Discretization &d, const Model &model);

/// Levels of multigrid on the meshes that a mesh leads to, down to a few hundred unknowns. Collective.
/// @param prescribed  (overlap dofs) 1 where the displacement of the finest mesh is prescribed
solver::MeshLevels mesh_levels(const NestedMesh &finest, const Model &model, const DeviceView<char *> &prescribed);

} // namespace rpc::analysis
