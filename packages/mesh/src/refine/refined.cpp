// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/refinement.hpp"

#include "../mesh_checks.hpp"
#include "add_middle_nodes.hpp"
#include "boundary_places.hpp"
#include "children.hpp"
#include "divide_cells.hpp"
#include "halved.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/memory.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>

namespace rpc::mesh
{
namespace
{

/// Refuses what could only run out of memory or of local numbers later; collective.
/// @param growth  times as many cells as the coarse mesh has on this rank
/// @param asked   what asks for them
void require_room(const Mesh &coarse, const double growth, const std::string &asked)
{
  constexpr double gib = 1 << 30;
  const double per_node = coarse.dim() == 2 ? 800 : 1400; // [B] less than a mesh of gmsh takes, which has a matrix
  const double nodes = growth * coarse.num_owned_nodes();
  const double entries = growth * coarse.num_cells() * coarse.element.num_nodes();
  std::optional<std::string> message;
  if (const double limit = memory_limit();
      per_node * nodes > limit || entries > static_cast<double>(std::numeric_limits<int>::max())) {
    std::ostringstream text;
    text << std::setprecision(3) << asked << " a rank about " << nodes << " nodes, which take at least "
         << per_node * nodes / gib << " GiB of memory; a rank can have at most " << limit / gib
         << " GiB here. Use fewer, or more ranks on more machines.";
    message = text.str();
  }
  throw_if_any(coarse.comm(), ExitCode::bad_input, message);
}

/// Where the map of the parent has the nodes of its children.                                       doc/theory.md (2.16)
class PlacesInParent
{
public:
  /// @param parents  of order 2   @param children  of order 1, with the same nodes, but for those that it dropped
  PlacesInParent(const LocalMesh &parents, const LocalMesh &children)
      : parents_(parents), children_(children),
        weights_(child_weights(parents.element, parents.element, children.child_vertices))
  {
  }
  void operator()(const int cell, const int node, double *const x) const
  {
    const int dim = parents_.dim();
    const int *const nodes = parents_.nodes_of(children_.parent[cell]);
    const std::vector<double> &weight = weights_[children_.kind[cell]][node];
    for (int d = 0; d < dim; ++d) x[d] = 0;
    for (std::size_t a = 0; a < weight.size(); ++a)
      for (int d = 0; d < dim && weight[a] != 0; ++d)
        x[d] += weight[a] * parents_.coords[std::size_t(dim) * nodes[a] + d];
  }

private:
  const LocalMesh &parents_, &children_;
  ChildWeights weights_;
};

/// Refuses inverted cells; only those with a node that was moved can be. Collective.
void require_good_cells(const LocalMesh &mesh)
{
  std::vector<int> cells;
  for (int c = 0; c < mesh.num_owned_cells(); ++c)
    if (std::any_of(mesh.nodes_of(c), mesh.nodes_of(c) + mesh.element.num_nodes(),
                    [&](const int node) { return mesh.moved[node] != 0; }))
      cells.push_back(c);
  const std::vector<int> bad = inverted_cells(mesh.element, mesh.coords, mesh.cells, cells);
  std::optional<std::string> message;
  if (!bad.empty()) {
    const double *const x = &mesh.coords[std::size_t(mesh.dim()) * *mesh.nodes_of(bad.front())];
    std::ostringstream text;
    text << "mesh: refinement inverts a cell, with a vertex at (" << x[0] << ", " << x[1];
    if (mesh.dim() == 3) text << ", " << x[2];
    text << "): the coarse cells are too large for the curved boundary. " << remedy_for_curved_boundaries;
    message = text.str();
  }
  throw_if_any(*mesh.owned_nodes->getComm(), ExitCode::bad_mesh, message);
}

/// The mesh with the vertices of its cells only; all nodes stay.
LocalMesh of_vertices(const LocalMesh &mesh)
{
  if (mesh.element.order == 1) return mesh;
  LocalMesh linear = mesh;
  linear.element.order = 1;
  linear.cells.clear();
  for (int c = 0; c < mesh.num_cells(); ++c)
    linear.cells.insert(linear.cells.end(), mesh.nodes_of(c), mesh.nodes_of(c) + mesh.element.num_vertices());
  return linear;
}

/// (edges) 1 where the middle node of a cell of order 2 is one of the mesh's named points: it is to stay a node of theirs.
std::vector<char> with_named_middles(const LocalMesh &whole, const Middles &edges)
{
  std::vector<char> named_node(whole.num_nodes(), 0), named(edges.size(), 0);
  for (const PointData &set : whole.points)
    for (const int node : set.node) named_node[node] = 1;
  if (whole.element.order == 1) return named;
  for (int c = 0; c < whole.num_cells(); ++c)
    for (int e = 0; e < edges.per_cell; ++e)
      if (named_node[whole.nodes_of(c)[edges.slot[e]]]) named[edges.of(c)[e]] = 1;
  return named;
}

/// Edges of children that are edges of their parents have a middle node there.
void mark_in_place(const LocalMesh &children, Middles &edges)
{
  const auto is_corner = [](const std::array<double, 3> &X) {
    return std::all_of(X.begin(), X.end(), [](const double x) { return x == 0 || x == 1; });
  };
  const Element with_middles{children.dim(), 2, children.element.shape};
  const auto &ends = with_middles.edges();
  edges.in_place.assign(edges.size(), 0);
  for (int c = 0; c < children.num_cells(); ++c) {
    const auto &vertices = children.child_vertices[children.kind[c]];
    for (int e = 0; e < edges.per_cell; ++e)
      if (is_corner(vertices[ends[e][0]]) && is_corner(vertices[ends[e][1]])) edges.in_place[edges.of(c)[e]] = 1;
  }
}

} // namespace

ChildWeights child_weights(const Element &coarse, const Element &fine, const ChildVertices &vertices)
{
  constexpr double rounding = 1e-12;
  ChildWeights weights;
  with_shape_functions(coarse, [&](const auto &shape) {
    constexpr int dim = std::decay_t<decltype(shape)>::dim, nodes = std::decay_t<decltype(shape)>::nodes;
    for (const auto &points : child_points(fine, vertices)) {
      weights.emplace_back();
      for (const auto &point : points) {
        double X[dim], N[nodes], dN[nodes][dim];
        std::copy_n(point.begin(), dim, X);
        shape.evaluate(X, N, dN);
        for (double &weight : N)
          if (std::abs(weight) < rounding) weight = 0;
        weights.back().emplace_back(N, N + nodes);
      }
    }
  });
  return weights;
}

Mesh refined(const std::shared_ptr<const Mesh> &coarse)
{
  RPC_REQUIRE_CODE(!coarse->element.mixed(), ExitCode::internal_error, "mesh: mixed elements are not refined");
  require_room(*coarse, std::pow(2, coarse->dim()), "deck: \"Mesh->Refinements\" give");
  const LocalMesh whole = local_mesh(*coarse);
  LocalMesh fine;
  if (whole.element.order == 1) {
    fine = divided(with_middle_nodes(whole, middles_of(whole), {}, coarse->geometry_file));
  } else {
    const LocalMesh children = divided(whole);
    fine = with_middle_nodes(children, middles_of(children), PlacesInParent(whole, children), coarse->geometry_file);
  }
  require_good_cells(fine);
  return mesh_of(fine, coarse);
}

Mesh halved(const std::shared_ptr<const Mesh> &coarse, const std::vector<Halving> &halving)
{
  const LocalMesh whole = local_mesh(*coarse);
  const LocalMesh linear = of_vertices(whole);
  const Middles edges = middles_of(linear).front();
  const EdgeMarks marks = marked_edges(linear, edges, halving, with_named_middles(whole, edges));
  const double cells = std::max(1, whole.num_cells());
  const auto cut = static_cast<double>(
      std::count_if(marks.edges.of_cell.begin(), marks.edges.of_cell.end(), [](const int edge) { return edge >= 0; }));
  require_room(*coarse, 1 + cut / cells, "mesh: sizes of cells give");
  LocalMesh fine;
  if (whole.element.order == 1) {
    fine = divided(with_middle_nodes(linear, {marks.edges}, {}, coarse->geometry_file), marks);
  } else {
    const LocalMesh children = divided(whole, marks);
    std::vector<Middles> middles = middles_of(children);
    mark_in_place(children, middles.front());
    fine = with_middle_nodes(children, middles, PlacesInParent(whole, children), coarse->geometry_file);
  }
  require_good_cells(fine);
  return mesh_of(fine, coarse);
}

} // namespace rpc::mesh
