// SPDX-License-Identifier: BSD-3-Clause
#include "../size_tree.hpp"
#include "halved.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/refinement.hpp"
#include "rpc/mesh/rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace rpc::mesh
{
namespace
{

/// (kinds) Whether the child is the whole cell.
std::vector<char> whole_kinds(const ChildVertices &kinds)
{
  std::vector<char> whole;
  for (const auto &vertices : kinds) {
    bool is_whole = true;
    for (std::size_t v = 0; v < vertices.size(); ++v)
      for (std::size_t d = 0; d < 3; ++d) is_whole = is_whole && vertices[v][d] == (v == d + 1 ? 1 : 0);
    whole.push_back(is_whole ? 1 : 0);
  }
  return whole;
}

/// (owned cells) Those that the last level left alone, as they were small enough for it.
std::vector<char> settled_cells(const Mesh &mesh, const std::vector<Halving> &last)
{
  std::vector<char> settled(mesh.num_owned_cells, 0);
  if (last.empty()) return settled;
  const std::vector<char> whole = whole_kinds(mesh.parents->vertices);
  for (LO c = 0; c < mesh.num_owned_cells; ++c)
    settled[c] = whole[mesh.parents->kind[c]] && last[mesh.parents->cell[c]] == Halving::none;
  return settled;
}

/// Sizes are a factor of 2^(1/dim) apart where cells are halved at one edge. In the mean over their logarithm cells end at the size that is
/// asked for.
/// @param times  as large as asked for
Halving halving_of(const double times, const int dim)
{
  if (times > std::sqrt(2.)) return Halving::all_edges;
  return times > std::pow(2, 1. / (2 * dim)) ? Halving::longest_edge : Halving::none;
}

/// (owned cells) How those of a level are to be halved.
template <int dim>
std::vector<Halving> halving_by(const SizeTree<dim> &size, const Mesh &mesh, const std::vector<char> &settled)
{
  const auto cells = to_host(mesh.cells);
  const auto coords = to_host(mesh.coords);
  std::vector<Halving> halving(mesh.num_owned_cells, Halving::none);
  const Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, LO> all(0, mesh.num_owned_cells);
  Kokkos::parallel_for("rpc::mesh::sizes_of_cells", all, [&](const LO c) {
    if (settled[c]) return;
    SimplexVertices<dim> vertex;
    for (int v = 0; v <= dim; ++v)
      for (int d = 0; d < dim; ++d) vertex[v][d] = coords(cells(c, v), d);
    halving[c] = halving_of(excess<dim>(size, vertex), dim);
  });
  return halving;
}

/// A level with hardly more nodes than its parent costs multigrid as much as that one, and gains little.
bool adds_little(const Mesh &mesh)
{
  const auto nodes = [](const Mesh &of) { return static_cast<double>(of.owned_nodes->getGlobalNumElements()); };
  return mesh.parents && nodes(mesh) < coarsening_rules.least_added * nodes(*mesh.parents->mesh);
}

/// A mesh's grandparents as its parents.
std::shared_ptr<const Parents> grandparents(const Mesh &mesh)
{
  const Parents &own = *mesh.parents, &above = *own.mesh->parents;
  auto joined = std::make_shared<Parents>();
  joined->mesh = above.mesh;
  std::map<std::pair<int, int>, int> number; // of the kind, by those of both levels
  for (std::size_t c = 0; c < own.cell.size(); ++c) {
    const LO parent = own.cell[c];
    joined->cell.push_back(above.cell[parent]);
    const auto [at, is_new] =
        number.emplace(std::make_pair(above.kind[parent], own.kind[c]), static_cast<int>(joined->vertices.size()));
    joined->kind.push_back(at->second);
    if (!is_new) continue;
    const auto &outer = above.vertices[above.kind[parent]];
    joined->vertices.emplace_back();
    for (const auto &X : own.vertices[own.kind[c]]) { // affine, as cells are simplices
      auto Y = outer[0];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t d = 0; d + 1 < outer.size(); ++d) Y[i] += X[d] * (outer[d + 1][i] - outer[0][i]);
      joined->vertices.back().push_back(Y);
    }
  }
  return joined;
}

template <int dim>
std::shared_ptr<const Mesh> refined_in(std::shared_ptr<const Mesh> base, const SizeField &sizes)
{
  const SizeTree<dim> size(sizes);
  std::shared_ptr<Mesh> mesh; // null: the base
  for (std::vector<Halving> halving;;) {
    const std::shared_ptr<const Mesh> last = mesh ? mesh : base;
    halving = halving_by<dim>(size, *last, settled_cells(*last, halving));
    const auto asked = static_cast<GO>(halving.size()) - std::count(halving.begin(), halving.end(), Halving::none);
    if (sum_all(base->comm(), GO(asked)) == 0) break;
    // Of two levels that are nearly the same the coarser one is left out.
    if (mesh && adds_little(*mesh) && mesh->parents->mesh != base) mesh->parents = grandparents(*mesh);
    mesh = std::make_shared<Mesh>(halved(last, halving));
  }
  if (!mesh) return base;
  if (adds_little(*mesh) && mesh->parents->mesh != base) mesh->parents = grandparents(*mesh);
  return mesh;
}

} // namespace

std::shared_ptr<const Mesh> refined_to(std::shared_ptr<const Mesh> mesh, const SizeField &sizes)
{
  RPC_REQUIRE(mesh->element.shape == Shape::simplex && sizes.dim == mesh->dim(),
              "mesh: only triangles and tetrahedra are refined to sizes of cells, in space by a field in space; got "
                  << mesh->element.name() << " cells in " << mesh->dim() << "D and a field in " << sizes.dim << "D");
  return sizes.dim == 2 ? refined_in<2>(std::move(mesh), sizes) : refined_in<3>(std::move(mesh), sizes);
}

} // namespace rpc::mesh
