#include "children.hpp"

#include <algorithm>

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
  const Element &whole = children.whole;
  // Opposite corners of the octahedron sum to the same place.
  children.diagonal = {{4, 9}, {5, 7}, {6, 8}};
  for (int d = 0; d < 3; ++d) {
    const std::vector<int> &ends = children.diagonal[d], &one = children.diagonal[(d + 1) % 3],
                           &other = children.diagonal[(d + 2) % 3];
    const int ring[] = {one[0], other[0], one[1], other[1]};
    for (int i = 0; i < 4; ++i) {
      std::vector<int> nodes = {ends[0], ends[1], ring[i], ring[(i + 1) % 4]};
      if (orientation(whole, nodes) < 0) std::swap(nodes[2], nodes[3]);
      children.vertices.push_back(nodes);
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
  children.whole = {dim, 2, shape};
  children.per_cell = 1 << dim;
  children.vertices = at_vertices(children.whole);
  if (shape == Shape::simplex && dim == 2) children.vertices.push_back({3, 4, 5});
  if (shape == Shape::simplex && dim == 3) add_inner_tetrahedra(children);
  const Element child{dim, 1, shape};
  for (const auto &vertices : children.vertices) {
    children.facets.emplace_back();
    for (const auto &facet : child.facets()) {
      std::vector<int> nodes;
      for (const int v : facet) nodes.push_back(vertices[v]);
      children.facets.back().push_back(facet_with(children.whole, nodes));
    }
  }
  return children;
}

} // namespace

const Children &children_of(const Element &element)
{
  static const Children all[] = {make_children(2, Shape::simplex), make_children(2, Shape::tensor),
                                 make_children(3, Shape::simplex), make_children(3, Shape::tensor)};
  return all[2 * (element.dim - 2) + (element.shape == Shape::tensor ? 1 : 0)];
}

std::vector<std::vector<std::array<double, 3>>> child_points(const Element &element)
{
  const Children &children = children_of(element);
  const Element linear{element.dim, 1, element.shape};
  const bool simplex = element.shape == Shape::simplex;
  const auto reference = [&](const int node, const int d) { // of the parent
    return children.whole.lattice()[node][d] / 2. * (simplex ? 1 : 2) - (simplex ? 0 : 1);
  };
  std::vector<int> along; // the vertex next to the first one in each direction
  for (int d = 0; d < element.dim; ++d) {
    std::vector<int> unit(element.dim, 0);
    unit[d] = 1;
    along.push_back(node_at(linear, unit));
  }
  std::vector<std::vector<std::array<double, 3>>> points;
  for (const auto &vertices : children.vertices) {
    points.emplace_back();
    for (const auto &place : element.lattice()) {
      std::array<double, 3> X{};
      for (int i = 0; i < element.dim; ++i) {
        X[i] = reference(vertices[0], i);
        for (int d = 0; d < element.dim; ++d)
          X[i] += (reference(vertices[along[d]], i) - reference(vertices[0], i)) * place[d] / element.order;
      }
      points.back().push_back(X);
    }
  }
  return points;
}

} // namespace rpc::mesh
