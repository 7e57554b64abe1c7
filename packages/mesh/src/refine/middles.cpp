// SPDX-License-Identifier: BSD-3-Clause
#include "middles.hpp"

#include "../sorted_lists.hpp"
#include "routed.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/topology.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <numeric>
#include <utility>

namespace rpc::mesh
{
namespace
{

/// Sorts vertices by ids, and lists the middles at the first of them.
void sort_by_ids(const LocalMesh &mesh, Middles &middles)
{
  const auto less = [&](const int a, const int b) { return mesh.id[a] < mesh.id[b]; };
  std::vector<int> first;
  for (int m = 0; m < middles.size(); ++m) {
    const auto begin = middles.vertices.begin() + std::ptrdiff_t(middles.width) * m;
    std::sort(begin, begin + middles.width, less);
    first.push_back(*begin);
  }
  middles.at_vertex = sorted_into_lists(first, mesh.num_nodes());
  for (int n = 0; n < mesh.num_nodes(); ++n)
    std::sort(middles.at_vertex.first(n), middles.at_vertex.last(n), [&](const int a, const int b) {
      const int *const of_a = middles.vertices_of(a), *const of_b = middles.vertices_of(b);
      return std::lexicographical_compare(of_a, of_a + middles.width, of_b, of_b + middles.width, less);
    });
}

Middles middles_of_entities(Entities entities, const Element::Table &nodes)
{
  Middles middles;
  middles.width = entities.num_vertices;
  middles.per_cell = entities.per_cell;
  middles.vertices = std::move(entities.vertices);
  middles.of_cell = std::move(entities.of_cell);
  for (const auto &local : nodes) middles.slot.push_back(local.back());
  return middles;
}

Middles middles_of_cells(const LocalMesh &mesh, const Element &whole)
{
  Middles middles;
  middles.width = mesh.element.num_nodes();
  middles.per_cell = 1;
  middles.vertices = mesh.cells;
  middles.of_cell.resize(mesh.num_cells());
  std::iota(middles.of_cell.begin(), middles.of_cell.end(), 0);
  const auto &lattice = whole.lattice();
  const std::vector<int> centre(whole.dim, 1);
  middles.slot = {static_cast<int>(std::find(lattice.begin(), lattice.end(), centre) - lattice.begin())};
  return middles;
}

} // namespace

std::vector<Middles> middles_of(const LocalMesh &mesh)
{
  const Element whole{mesh.dim(), 2, mesh.element.shape};
  const bool tensor = whole.shape == Shape::tensor;
  std::vector<Middles> all;
  all.push_back(middles_of_entities(edges_of(mesh.element, mesh.cells), whole.edges()));
  if (tensor && mesh.dim() == 3)
    all.push_back(middles_of_entities(facets_of(mesh.element, mesh.cells), whole.facets()));
  if (tensor) all.push_back(middles_of_cells(mesh, whole));
  for (Middles &middles : all) sort_by_ids(mesh, middles);
  return all;
}

std::vector<GO> sums_before(const Comm &comm, const GO num_ids, const std::vector<GO> &id,
                            const std::vector<int> &count, GO &total)
{
  const GO ranks = comm.getSize(), block = (num_ids + ranks - 1) / ranks, first = block * comm.getRank();
  std::vector<int> rank;
  std::vector<double> rows;
  for (std::size_t n = 0; n < count.size(); ++n) {
    rank.push_back(static_cast<int>(id[n] / block));
    rows.insert(rows.end(), {static_cast<double>(id[n]), static_cast<double>(count[n])});
  }
  const Routed routed(comm, rank);
  const std::vector<double> received = routed.forward(rows, 2);
  std::vector<GO> before(block + 1, 0);
  for (std::size_t k = 0; k < received.size(); k += 2)
    before[static_cast<GO>(received[k]) - first + 1] = static_cast<GO>(received[k + 1]);
  std::partial_sum(before.begin(), before.end(), before.begin());
  const GO others = sum_before(comm, before.back());
  total = sum_all(comm, before.back());
  std::vector<double> answers;
  for (std::size_t k = 0; k < received.size(); k += 2)
    answers.push_back(static_cast<double>(others + before[static_cast<GO>(received[k]) - first]));
  const std::vector<double> sums = routed.back(answers, 1);
  return {sums.begin(), sums.end()};
}

std::vector<GO> ids_of(const LocalMesh &mesh, const Middles &middles, GO &first)
{
  std::vector<int> count;
  for (int n = 0; n < mesh.num_owned_nodes(); ++n) count.push_back(middles.at_vertex.size_of(n));
  GO total = 0;
  const std::vector<GO> before = sums_before(
      *mesh.owned_nodes->getComm(), static_cast<GO>(mesh.owned_nodes->getGlobalNumElements()), mesh.id, count, total);
  std::vector<GO> ids(middles.size(), -1);
  for (int n = 0; n < mesh.num_owned_nodes(); ++n)
    for (int k = 0; k < count[n]; ++k) ids[middles.at_vertex.first(n)[k]] = first + before[n] + k;
  first += total;
  return ids;
}

std::vector<int> owners_of(const LocalMesh &mesh, const std::vector<GO> &gids)
{
  std::vector<int> ranks(gids.size());
  if (mesh.owned_nodes->getComm()->getSize() > 1)
    mesh.owned_nodes->getRemoteIndexList(Teuchos::ArrayView<const GO>(gids), Teuchos::ArrayView<int>(ranks));
  return ranks;
}

} // namespace rpc::mesh
