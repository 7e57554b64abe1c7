#include "../size_tree.hpp"
#include "halved.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/refinement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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
  for (LO c = 0; c < mesh.num_owned_cells; ++c) {
    if (settled[c]) continue;
    std::array<std::array<double, dim>, dim + 1> vertex;
    std::array<double, dim> centre{};
    for (int v = 0; v <= dim; ++v)
      for (int d = 0; d < dim; ++d) {
        vertex[v][d] = coords(cells(c, v), d);
        centre[d] += vertex[v][d] / (dim + 1);
      }
    halving[c] = halving_of(cell_size<dim>(vertex) / size(centre), dim);
  }
  return halving;
}

template <int dim>
std::shared_ptr<const Mesh> refined_in(std::shared_ptr<const Mesh> mesh, const SizeField &sizes)
{
  const SizeTree<dim> size(sizes);
  for (std::vector<Halving> halving;;) {
    halving = halving_by<dim>(size, *mesh, settled_cells(*mesh, halving));
    const auto asked = static_cast<GO>(halving.size()) - std::count(halving.begin(), halving.end(), Halving::none);
    if (sum_all(mesh->comm(), GO(asked)) == 0) return mesh;
    mesh = std::make_shared<Mesh>(halved(mesh, halving));
  }
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
