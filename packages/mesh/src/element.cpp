#include "rpc/mesh/element.hpp"

#include "rpc/core/error.hpp"

#include <array>

namespace rpc::mesh
{
namespace
{

using Table = std::vector<std::vector<int>>;

int power(const int base, const int exponent)
{
  return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

// Vertices counterclockwise, then edges, then faces, then the centre: the order of QUAD4/QUAD9 and HEX8/HEX27 in
// Exodus.
Table quad_lattice(const int p)
{
  Table nodes = {{0, 0}, {p, 0}, {p, p}, {0, p}};
  if (p == 2) nodes.insert(nodes.end(), {{1, 0}, {2, 1}, {1, 2}, {0, 1}, {1, 1}});
  return nodes;
}

Table hex_lattice(const int p)
{
  Table nodes;
  for (const int z : {0, p})
    for (const auto &corner : quad_lattice(1)) nodes.push_back({p * corner[0], p * corner[1], z});
  if (p == 2) {
    nodes.insert(nodes.end(), {{1, 0, 0},
                               {2, 1, 0},
                               {1, 2, 0},
                               {0, 1, 0},
                               {0, 0, 1},
                               {2, 0, 1},
                               {2, 2, 1},
                               {0, 2, 1},
                               {1, 0, 2},
                               {2, 1, 2},
                               {1, 2, 2},
                               {0, 1, 2},
                               {1, 1, 1},
                               {1, 1, 0},
                               {1, 1, 2},
                               {0, 1, 1},
                               {2, 1, 1},
                               {1, 0, 1},
                               {1, 2, 1}});
  }
  return nodes;
}

Table triangle_lattice(const int p)
{
  Table nodes = {{0, 0}, {p, 0}, {0, p}};
  if (p == 2) nodes.insert(nodes.end(), {{1, 0}, {1, 1}, {0, 1}});
  return nodes;
}

Table triangle_facets(const int p)
{
  if (p == 1) return {{0, 1}, {1, 2}, {2, 0}};
  return {{0, 1, 3}, {1, 2, 4}, {2, 0, 5}};
}

Table lattice_of(const int dim, const int order)
{
  return dim == 2 ? quad_lattice(order) : hex_lattice(order);
}

// A facet's nodes in the order of the facet's own lattice (an edge's two ends then its middle, or a quadrilateral),
// found by walking that lattice from its origin along its tangents.
Table facets_of(const int dim, const int order)
{
  struct Frame {
    std::array<int, 3> origin;
    std::array<std::array<int, 3>, 2> tangent;
  };
  // Exodus' order of element sides. The normal (tangent turned clockwise, or first x second tangent) points outward.
  const std::vector<Frame> frames =
      dim == 2 ? std::vector<Frame>{{{0, 0, 0}, {{{1, 0, 0}, {}}}},
                                    {{1, 0, 0}, {{{0, 1, 0}, {}}}},
                                    {{1, 1, 0}, {{{-1, 0, 0}, {}}}},
                                    {{0, 1, 0}, {{{0, -1, 0}, {}}}}}
               : std::vector<Frame>{{{0, 0, 0}, {{{1, 0, 0}, {0, 0, 1}}}},  {{1, 0, 0}, {{{0, 1, 0}, {0, 0, 1}}}},
                                    {{1, 1, 0}, {{{-1, 0, 0}, {0, 0, 1}}}}, {{0, 0, 0}, {{{0, 0, 1}, {0, 1, 0}}}},
                                    {{0, 0, 0}, {{{0, 1, 0}, {1, 0, 0}}}},  {{0, 0, 1}, {{{1, 0, 0}, {0, 1, 0}}}}};
  const Table nodes = lattice_of(dim, order);
  Table own; // the facet's lattice
  if (dim == 2) {
    own = {{0, 0}, {order, 0}};
    if (order == 2) own.push_back({1, 0});
  } else {
    own = quad_lattice(order);
  }
  Table facets;
  for (const auto &frame : frames) {
    std::vector<int> facet;
    for (const auto &step : own) {
      std::vector<int> position(dim);
      for (int d = 0; d < dim; ++d)
        position[d] = order * frame.origin[d] + step[0] * frame.tangent[0][d] + step[1] * frame.tangent[1][d];
      for (std::size_t a = 0; a < nodes.size(); ++a)
        if (nodes[a] == position) facet.push_back(static_cast<int>(a));
    }
    facets.push_back(facet);
  }
  return facets;
}

} // namespace

std::string Element::name() const
{
  return (shape == Shape::simplex ? "P" : "Q") + std::to_string(order);
}
std::string Element::exodus_name() const
{
  const char *const cell = shape == Shape::simplex ? "TRI" : (dim == 2 ? "QUAD" : "HEX");
  return cell + std::to_string(num_nodes());
}
int Element::num_nodes() const
{
  return shape == Shape::simplex ? (order + 1) * (order + 2) / 2 : power(order + 1, dim);
}
int Element::num_vertices() const
{
  return shape == Shape::simplex ? dim + 1 : power(2, dim);
}
int Element::num_facet_nodes() const
{
  return power(order + 1, dim - 1);
}
int Element::num_facets() const
{
  return shape == Shape::simplex ? dim + 1 : 2 * dim;
}

const std::vector<std::vector<int>> &Element::lattice() const
{
  static const std::array<std::array<Table, 2>, 2> tables = {
      {{lattice_of(2, 1), lattice_of(2, 2)}, {lattice_of(3, 1), lattice_of(3, 2)}}};
  static const std::array<Table, 2> triangles = {triangle_lattice(1), triangle_lattice(2)};
  return shape == Shape::simplex ? triangles[order - 1] : tables[dim - 2][order - 1];
}

const std::vector<std::vector<int>> &Element::facets() const
{
  static const std::array<std::array<Table, 2>, 2> tables = {
      {{facets_of(2, 1), facets_of(2, 2)}, {facets_of(3, 1), facets_of(3, 2)}}};
  static const std::array<Table, 2> triangles = {triangle_facets(1), triangle_facets(2)};
  return shape == Shape::simplex ? triangles[order - 1] : tables[dim - 2][order - 1];
}

Element parse_element(const std::string &name, const int dim)
{
  const bool known = name == "P1" || name == "P2" || name == "Q1" || name == "Q2";
  RPC_REQUIRE(known, "deck: \"Mesh->Element\" must be one of P1, P2, Q1, Q2, got \"" << name << "\"");
  RPC_REQUIRE(name == "Q1" || dim == 2, "deck: \"Mesh->Element\" must be Q1 in 3D, got \"" << name << "\"");
  return Element{dim, name[1] == '1' ? 1 : 2, name[0] == 'P' ? Shape::simplex : Shape::tensor};
}

} // namespace rpc::mesh
