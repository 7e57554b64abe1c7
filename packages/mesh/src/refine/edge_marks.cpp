// SPDX-License-Identifier: BSD-3-Clause
#include "edge_marks.hpp"

#include "routed.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace rpc::mesh
{
namespace
{

/// (edges) Places of all edges in the order of EdgeMarks.
std::vector<int> order_of(const LocalMesh &mesh, const Middles &edges)
{
  using Key = std::tuple<float, GO, GO>; // floats: lengths that differ by rounding are equal as a rule
  std::vector<Key> key;
  for (int e = 0; e < edges.size(); ++e) {
    const int *const ends = edges.vertices_of(e);
    double squared = 0;
    for (int d = 0; d < mesh.dim(); ++d) {
      const double along =
          mesh.coords[std::size_t(mesh.dim()) * ends[1] + d] - mesh.coords[std::size_t(mesh.dim()) * ends[0] + d];
      squared += along * along;
    }
    key.emplace_back(-static_cast<float>(squared), mesh.id[ends[0]], mesh.id[ends[1]]);
  }
  std::vector<int> edge(edges.size()), order(edges.size());
  std::iota(edge.begin(), edge.end(), 0);
  std::sort(edge.begin(), edge.end(), [&](const int a, const int b) { return key[a] < key[b]; });
  for (std::size_t k = 0; k < edge.size(); ++k) order[edge[k]] = static_cast<int>(k);
  return order;
}

/// The edges of each face of a cell, then of the whole cell, by ordinals.
Element::Table edges_of_faces(const Element &element)
{
  Element::Table faces;
  const auto &edges = element.edges();
  if (element.dim == 3)
    for (const auto &facet : element.facets()) {
      faces.emplace_back();
      for (std::size_t e = 0; e < edges.size(); ++e)
        if (std::all_of(edges[e].begin(), edges[e].end(),
                        [&](const int v) { return std::find(facet.begin(), facet.end(), v) != facet.end(); }))
          faces.back().push_back(static_cast<int>(e));
    }
  faces.emplace_back(edges.size());
  std::iota(faces.back().begin(), faces.back().end(), 0);
  return faces;
}

/// Marks of edges that ranks share.
class SharedMarks
{
public:
  /// Collective.
  SharedMarks(const LocalMesh &mesh, const Middles &edges)
  {
    const Comm &comm = *mesh.owned_nodes->getComm();
    if (comm.getSize() == 1) return;
    std::vector<GO> gids;
    std::vector<double> rows; // the first end's gid, the other end's id
    for (int e = 0; e < edges.size(); ++e) {
      const int *const ends = edges.vertices_of(e);
      if (ends[0] < mesh.num_owned_nodes()) continue;
      asking_.push_back(e);
      gids.push_back(mesh.gid[ends[0]]);
      rows.insert(rows.end(), {static_cast<double>(mesh.gid[ends[0]]), static_cast<double>(mesh.id[ends[1]])});
    }
    routed_ = std::make_unique<Routed>(comm, owners_of(mesh, gids));
    const std::vector<double> asked = routed_->forward(rows, 2);
    for (std::size_t k = 0; k < asked.size(); k += 2) {
      const int first = mesh.owned_nodes->getLocalElement(static_cast<GO>(asked[k]));
      const int *const found =
          std::find_if(edges.at_vertex.first(first), edges.at_vertex.last(first), [&](const int e) {
            return static_cast<double>(mesh.id[edges.vertices_of(e)[1]]) == asked[k + 1];
          });
      asked_.push_back(*found); // the owner has all cells around the edge
    }
  }

  /// Marks on every rank the edges that any has marked; collective.
  void unite(std::vector<char> &marked) const
  {
    if (!routed_) return;
    std::vector<double> mine;
    for (const int e : asking_) mine.push_back(marked[e]);
    const std::vector<double> others = routed_->forward(mine, 1);
    for (std::size_t k = 0; k < others.size(); ++k)
      if (others[k] != 0) marked[asked_[k]] = 1;
    std::vector<double> answers;
    for (const int e : asked_) answers.push_back(marked[e]);
    const std::vector<double> all = routed_->back(answers, 1);
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k] != 0) marked[asking_[k]] = 1;
  }

private:
  std::unique_ptr<Routed> routed_; // null on one rank
  std::vector<int> asking_, asked_;
};

/// The middles of some of the edges.
Middles those_of(const LocalMesh &mesh, const Middles &edges, const std::vector<char> &marked)
{
  Middles some;
  some.width = edges.width;
  some.per_cell = edges.per_cell;
  some.slot = edges.slot;
  std::vector<int> number(edges.size(), -1);
  for (int e = 0; e < edges.size(); ++e) {
    if (!marked[e]) continue;
    number[e] = some.size();
    some.vertices.insert(some.vertices.end(), edges.vertices_of(e), edges.vertices_of(e) + edges.width);
  }
  for (const int e : edges.of_cell) some.of_cell.push_back(number[e]);
  some.at_vertex.begin.reserve(mesh.num_nodes() + 1);
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    for (const int *e = edges.at_vertex.first(n); e != edges.at_vertex.last(n); ++e)
      if (marked[*e]) some.at_vertex.value.push_back(number[*e]);
    some.at_vertex.begin.push_back(some.at_vertex.value.size());
  }
  return some;
}

} // namespace

EdgeMarks marked_edges(const LocalMesh &mesh, const Middles &edges, const std::vector<Halving> &halving,
                       std::vector<char> marked)
{
  const std::vector<int> order = order_of(mesh, edges);
  const Element::Table faces = edges_of_faces(mesh.element);
  const auto mark_longest = [&](const int *const of_cell, const std::vector<int> &face) {
    const int longest = of_cell[*std::min_element(
        face.begin(), face.end(), [&](const int a, const int b) { return order[of_cell[a]] < order[of_cell[b]]; })];
    const bool is_new = !marked[longest];
    marked[longest] = 1;
    return is_new;
  };
  for (int c = 0; c < mesh.num_owned_cells(); ++c) {
    const int *const of_cell = edges.of(c);
    if (halving[c] == Halving::longest_edge) mark_longest(of_cell, faces.back());
    if (halving[c] != Halving::all_edges) continue;
    for (int e = 0; e < edges.per_cell; ++e) marked[of_cell[e]] = 1;
  }

  const SharedMarks shared(mesh, edges);
  const Comm &comm = *mesh.owned_nodes->getComm();
  for (bool changed = true; changed;) {
    shared.unite(marked);
    changed = false;
    for (bool here = true; here;) {
      here = false;
      for (int c = 0; c < mesh.num_owned_cells(); ++c) {
        const int *const of_cell = edges.of(c);
        for (const auto &face : faces)
          if (std::any_of(face.begin(), face.end(), [&](const int e) { return marked[of_cell[e]] != 0; }))
            here |= mark_longest(of_cell, face);
      }
      changed |= here;
    }
    changed = sum_all(comm, GO(changed ? 1 : 0)) > 0;
  }

  EdgeMarks result;
  result.edges = those_of(mesh, edges, marked);
  for (int e = 0; e < edges.size(); ++e)
    if (marked[e]) result.order.push_back(order[e]);
  return result;
}

} // namespace rpc::mesh
