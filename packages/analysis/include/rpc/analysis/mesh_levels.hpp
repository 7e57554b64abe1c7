#pragma once

#include "rpc/analysis/problem.hpp"
#include "rpc/solver/mesh_levels.hpp"

namespace rpc::analysis
{

/// Whether there are coarser meshes of a body for multigrid: of lower order, or boxes.
bool has_mesh_levels(const mesh::Mesh &mesh);

/// The same body on coarser and coarser meshes: of order 1 on the same cells, then boxes of half as many cells in each direction
/// down to a few hundred unknowns. A body from gmsh has no others than the first. Collective.
/// @param prescribed  (overlap dofs) 1 where the displacement of the finest mesh is prescribed
solver::MeshLevels mesh_levels(const fem::Discretization &finest, const Model &model,
                               const DeviceView<char *> &prescribed);

} // namespace rpc::analysis
