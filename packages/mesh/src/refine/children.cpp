// SPDX-License-Identifier: BSD-3-Clause
#include "children.hpp"

#include <algorithm>
#include <numeric>

namespace rpc::mesh
{
namespace
{

using Table = Element::Table;

int node_at(const Element &element, const std::vector<int> &place)
{
  const Table &lattice = element.lattice();
  return static_cast<int>(std::find(lattice.begin(), lattice.end(), place) - lattice.begin());
}

std::vector<int> sum(std::vector<int> a, const std::vector<int> &b)
{
  for (std::size_t d = 0; d < a.size(); ++d) a[d] += b[d];
  return a;
}

/// One child at each vertex, of half the size.
Table at_vertices(const Element &whole)
{
  const Element linear{whole.dim, 1, whole.shape};
  Table children;
  for (const auto &origin : linear.lattice()) {
    children.emplace_back();
    for (const auto &vertex : linear.lattice()) children.back().push_back(node_at(whole, sum(origin, vertex)));
  }
  return children;
}

/// Six times the volume of a tetrahedron between nodes.
int orientation(const Element &whole, const std::vector<int> &nodes)
{
  int J[3][3];
  for (int k = 0; k < 3; ++k)
    for (int d = 0; d < 3; ++d) J[k][d] = whole.lattice()[nodes[k + 1]][d] - whole.lattice()[nodes[0]][d];
  return J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) - J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
         J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
}

/// The four parts of the octahedron for each diagonal: the nodes between vertices a, b and between the other two are its ends.
void add_inner_tetrahedra(Children &children)
{
  const Element &whole = children.kinds.whole;
  // Opposite corners of the octahedron sum to the same place.
  children.diagonal = {{4, 9}, {5, 7}, {6, 8}};
  for (int d = 0; d < 3; ++d) {
    const std::vector<int> &ends = children.diagonal[d], &one = children.diagonal[(d + 1) % 3],
                           &other = children.diagonal[(d + 2) % 3];
    const int ring[] = {one[0], other[0], one[1], other[1]};
    for (int i = 0; i < 4; ++i) {
      std::vector<int> nodes = {ends[0], ends[1], ring[i], ring[(i + 1) % 4]};
      if (orientation(whole, nodes) < 0) std::swap(nodes[2], nodes[3]);
      children.kinds.add(nodes);
    }
  }
}

/// The whole's facet that has some nodes; -1: none.
int facet_with(const Element &whole, const std::vector<int> &nodes)
{
  for (int f = 0; f < whole.num_facets(); ++f) {
    const auto &facet = whole.facets()[f];
    if (std::all_of(nodes.begin(), nodes.end(),
                    [&](const int n) { return std::find(facet.begin(), facet.end(), n) != facet.end(); }))
      return f;
  }
  return -1;
}

Children make_children(const int dim, const Shape shape)
{
  Children children;
  children.kinds.whole = {dim, 2, shape};
  children.per_cell = 1 << dim;
  for (const auto &nodes : at_vertices(children.kinds.whole)) children.kinds.add(nodes);
  if (shape == Shape::simplex && dim == 2) children.kinds.add({3, 4, 5});
  if (shape == Shape::simplex && dim == 3) add_inner_tetrahedra(children);
  return children;
}

} // namespace

void ChildKinds::add(const std::vector<int> &nodes)
{
  vertices.push_back(nodes);
  facets.emplace_back();
  const Element linear{whole.dim, 1, whole.shape};
  for (const auto &facet : linear.facets()) {
    std::vector<int> of_facet;
    for (const int v : facet) of_facet.push_back(nodes[v]);
    facets.back().push_back(facet_with(whole, of_facet));
  }
}

ChildVertices ChildKinds::places() const
{
  const bool simplex = whole.shape == Shape::simplex;
  ChildVertices all;
  for (const auto &nodes : vertices) {
    all.emplace_back();
    for (const int node : nodes) {
      std::array<double, 3> X{};
      for (int d = 0; d < whole.dim; ++d) X[d] = whole.lattice()[node][d] / 2. * (simplex ? 1 : 2) - (simplex ? 0 : 1);
      all.back().push_back(X);
    }
  }
  return all;
}

Bisection::Bisection(const Element &element)
{
  kinds_.whole = {element.dim, 2, element.shape};
}

const std::vector<int> &Bisection::children(const std::vector<int> &order)
{
  found_.clear();
  std::vector<int> nodes(kinds_.whole.num_vertices());
  std::iota(nodes.begin(), nodes.end(), 0);
  divide(nodes, order);
  return found_;
}

void Bisection::divide(const std::vector<int> &nodes, const std::vector<int> &order)
{
  const auto &edges = kinds_.whole.edges();
  const auto place = [&](const int node) { return std::find(nodes.begin(), nodes.end(), node) - nodes.begin(); };
  const auto end = static_cast<std::ptrdiff_t>(nodes.size());
  int first = -1;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (order[e] >= 0 && (first < 0 || order[e] < order[first]) && place(edges[e][0]) < end && place(edges[e][1]) < end)
      first = static_cast<int>(e);
  if (first < 0) {
    const auto [at, is_new] = kind_of_.emplace(nodes, kinds_.size());
    if (is_new) kinds_.add(nodes);
    found_.push_back(at->second);
    return;
  }
  for (const int kept : {0, 1}) { // in the other end's place comes the middle, which keeps the orientation
    std::vector<int> part = nodes;
    part[place(edges[first][1 - kept])] = edges[first].back();
    divide(part, order);
  }
}

const Children &children_of(const Element &element)
{
  static const Children all[] = {make_children(2, Shape::simplex), make_children(2, Shape::tensor),
                                 make_children(3, Shape::simplex), make_children(3, Shape::tensor)};
  return all[2 * (element.dim - 2) + (element.shape == Shape::tensor ? 1 : 0)];
}

ChildVertices child_points(const Element &element, const ChildVertices &vertices)
{
  const Element linear{element.dim, 1, element.shape};
  std::vector<int> along; // the vertex next to the first one in each direction
  for (int d = 0; d < element.dim; ++d) {
    std::vector<int> unit(element.dim, 0);
    unit[d] = 1;
    along.push_back(node_at(linear, unit));
  }
  ChildVertices points;
  for (const auto &at : vertices) {
    points.emplace_back();
    for (const auto &place : element.lattice()) {
      std::array<double, 3> X = at[0];
      for (int i = 0; i < element.dim; ++i)
        for (int d = 0; d < element.dim; ++d) X[i] += (at[along[d]][i] - at[0][i]) * place[d] / element.order;
      points.back().push_back(X);
    }
  }
  return points;
}

} // namespace rpc::mesh
