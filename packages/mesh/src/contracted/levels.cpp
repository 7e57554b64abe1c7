// SPDX-License-Identifier: BSD-3-Clause
#include "../middle_nodes.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/contracted.hpp"
#include "rpc/mesh/distribute.hpp"

#include <utility>
#include <vector>

namespace rpc::mesh
{
namespace
{

// Unknowns below which no coarser mesh is made: multigrid factors as many in no time.
constexpr int enough_2d = 800, enough_3d = 400;
// Fewer cells than this for each rank are not divided.
constexpr int least_cells_divided = 16;

/// From the finest to the coarsest, on rank 0.
std::vector<MeshData> contracted_levels(MeshData whole, const int num_ranks)
{
  std::vector<MeshData> levels;
  levels.push_back(std::move(whole));
  if (levels.front().element.shape != Shape::simplex) return levels;
  const int dim = levels.front().element.dim, order = levels.front().element.order;
  for (MeshData mesh = levels.front();;) { // of order 1 but for the first
    const int vertices = mesh.num_nodes();
    if (dim * vertices <= (dim == 2 ? enough_2d : enough_3d)) break;
    auto coarse = contracted(mesh);
    if (!coarse || coarse->num_cells() < least_cells_divided * num_ranks) break;
    levels.push_back(order == 2 ? with_middle_nodes(*coarse) : *coarse);
    mesh = std::move(*coarse);
  }
  return levels;
}

} // namespace

std::shared_ptr<const Mesh> distribute_with_contracted(MeshData whole, const RCP<const Comm> &comm)
{
  std::vector<MeshData> levels;
  on_root(*comm, ExitCode::internal_error, [&] { levels = contracted_levels(std::move(whole), comm->getSize()); });
  const GO num_levels = sum_all(*comm, static_cast<GO>(levels.size()));
  levels.resize(num_levels); // empty ones on other ranks
  std::shared_ptr<const Mesh> coarse;
  for (GO k = num_levels; k-- > 0;) {
    auto mesh = std::make_shared<Mesh>(distribute(levels[k], comm));
    levels[k] = {};
    if (coarse) {
      auto parents = std::make_shared<Parents>();
      parents->mesh = coarse;
      parents->nested = false;
      mesh->parents = std::move(parents);
    }
    coarse = std::move(mesh);
  }
  return coarse;
}

} // namespace rpc::mesh
