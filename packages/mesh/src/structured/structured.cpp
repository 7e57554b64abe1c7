// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/structured.hpp"

#include "../division.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/distribute.hpp"
#include "rpc/mesh/rules.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace rpc::mesh
{
namespace
{

/// The meshes from the finest to the coarsest, each with its division; on rank 0.
struct Levels {
  std::vector<MeshData> mesh;
  std::vector<CoarserMesh> link; ///< without their meshes: what leads from a mesh to the next one
  std::vector<std::vector<int>> order;
  std::vector<Division> division;
};

Levels levels_of(MeshData whole)
{
  Levels levels;
  levels.mesh.push_back(std::move(whole));
  for (;;) {
    const MeshData &fine = levels.mesh.back();
    if (fine.element.dim * fine.num_nodes() <= coarsening_rules.few) break;
    LayeredMesh found = layered(fine);
    if (!found.coarser || found.coarser->mesh.num_nodes() > coarsening_rules.most_kept * fine.num_nodes() ||
        found.coarser->mesh.num_cells() < coarsening_rules.least_cells_of_rank)
      break;
    levels.mesh.push_back(std::exchange(found.coarser->mesh, {}));
    levels.link.push_back(std::move(*found.coarser));
    levels.order.push_back(std::move(found.order));
  }
  levels.order.emplace_back();
  return levels;
}

/// Each rank also has the parents of its cells, those on other ranks as a part of its halo.
void add_parents(Division &division, const std::vector<int> &rank, const std::vector<int> &rank_of_child,
                 const std::vector<int> &parent)
{
  const int num_ranks = division.halo.size();
  std::vector<std::vector<int>> halo(num_ranks);
  for (int r = 0; r < num_ranks; ++r) halo[r].assign(division.halo.first(r), division.halo.last(r));
  for (std::size_t c = 0; c < parent.size(); ++c)
    if (rank[parent[c]] != rank_of_child[c]) halo[rank_of_child[c]].push_back(parent[c]);
  division.halo = {};
  for (auto &cells : halo) {
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    division.halo.value.insert(division.halo.value.end(), cells.begin(), cells.end());
    division.halo.begin.push_back(division.halo.value.size());
  }
}

/// Ranks have about as many of the finest cells. Children are on the rank of their parent down to the last mesh that has enough cells for all
/// ranks; coarser ones are on fewer ranks.
void divide(Levels &levels, const int num_ranks)
{
  const std::size_t num_levels = levels.mesh.size();
  levels.division.resize(num_levels);
  std::size_t last = num_levels - 1; // on all ranks
  while (last > 0 && ranks_for(levels.mesh[last], num_ranks) < num_ranks) --last;
  std::vector<double> weight(levels.mesh.front().num_cells(), 1.);
  for (std::size_t k = 0; k < last; ++k) {
    std::vector<double> of_parents(levels.mesh[k + 1].num_cells(), 0.);
    for (std::size_t c = 0; c < weight.size(); ++c) of_parents[levels.link[k].parent[c]] += weight[c];
    weight = std::move(of_parents);
  }
  const std::vector<int> of_last = ranks_of_cells(levels.mesh[last], num_ranks, weight);
  std::vector<int> rank = of_last;
  for (std::size_t k = last + 1; k-- > 0;) {
    levels.division[k] = divide_by(levels.mesh[k], num_ranks, rank, levels.order[k]);
    if (k == 0) break;
    std::vector<int> of_children;
    for (const int parent : levels.link[k - 1].parent) of_children.push_back(rank[parent]);
    rank = std::move(of_children);
  }
  std::vector<int> of_children = of_last;
  for (std::size_t k = last + 1; k < num_levels; ++k) {
    rank = ranks_of_cells(levels.mesh[k], ranks_for(levels.mesh[k], num_ranks));
    levels.division[k] = divide_by(levels.mesh[k], num_ranks, rank, levels.order[k]);
    add_parents(levels.division[k], rank, of_children, levels.link[k - 1].parent);
    of_children = std::exchange(rank, {});
  }
}

/// Of each kind its vertices, of rank 0 on all ranks.
ChildVertices broadcast(const Comm &comm, const Element &element, const ChildVertices &vertices)
{
  std::vector<double> flat;
  for (const auto &kind : vertices)
    for (const auto &X : kind) flat.insert(flat.end(), X.begin(), X.end());
  flat = gathered_by_all(comm, flat);
  const std::size_t width = element.num_vertices();
  ChildVertices all(flat.size() / (3 * width));
  for (std::size_t k = 0; k < all.size(); ++k)
    for (std::size_t v = 0; v < width; ++v) {
      const double *const X = &flat[3 * (width * k + v)];
      all[k].push_back({X[0], X[1], X[2]});
    }
  return all;
}

/// @param halo  (coarse cells of other ranks) their ids
/// @param link  read on rank 0 only
std::shared_ptr<const Parents> parents_of(const Mesh &fine, const std::shared_ptr<const Mesh> &coarse,
                                          const std::vector<int> &halo, const CoarserMesh &link)
{
  const Comm &comm = fine.comm();
  Parents parents;
  parents.mesh = coarse;
  parents.vertices = broadcast(comm, fine.element, link.vertices);
  const auto ids = fine.cell_id.list(), coarse_ids = coarse->cell_id.list();
  const std::vector<GO> wanted(ids.data(), ids.data() + ids.extent(0));
  const std::vector<int> parent = scattered_from_root(comm, link.parent, wanted);
  parents.kind = scattered_from_root(comm, link.kind, wanted);
  std::unordered_map<GO, LO> lid;
  for (std::size_t c = 0; c < coarse_ids.extent(0); ++c) lid.emplace(coarse_ids(c), static_cast<LO>(c));
  for (const int id : halo) lid.emplace(id, static_cast<LO>(lid.size()));
  for (const int id : parent) parents.cell.push_back(lid.at(id));
  parents.cell.resize(fine.num_cells(), -1); // an owned node has an owned cell, which tells its place
  parents.kind.resize(fine.num_cells(), 0);
  return std::make_shared<const Parents>(std::move(parents));
}

} // namespace

std::shared_ptr<const Mesh> distribute_with_parents(MeshData whole, const RCP<const Comm> &comm)
{
  Levels levels;
  on_root(*comm, ExitCode::internal_error, [&] { levels = levels_of(std::move(whole)); });
  const GO num_levels = sum_all(*comm, static_cast<GO>(levels.mesh.size()));
  levels.mesh.resize(num_levels); // empty ones on other ranks
  if (num_levels == 1) return std::make_shared<Mesh>(distribute(levels.mesh.front(), comm));
  levels.link.resize(num_levels - 1);
  levels.division.resize(num_levels);
  on_root(*comm, ExitCode::internal_error, [&] { divide(levels, comm->getSize()); });
  std::shared_ptr<Mesh> coarse;
  std::vector<int> coarse_halo;
  for (GO k = num_levels; k-- > 0;) {
    std::vector<int> halo;
    auto mesh = std::make_shared<Mesh>(distribute(levels.mesh[k], comm, levels.division[k], &halo));
    if (coarse) mesh->parents = parents_of(*mesh, coarse, coarse_halo, levels.link[k]);
    coarse = std::move(mesh);
    coarse_halo = std::move(halo);
  }
  return coarse;
}

} // namespace rpc::mesh
