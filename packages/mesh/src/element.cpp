// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/element.hpp"

#include "rpc/core/error.hpp"

#include <algorithm>
#include <numeric>

namespace rpc::mesh
{
namespace
{

using Table = Element::Table;

/// A reference cell, with vertices, edges and faces in the order of Exodus.
struct ReferenceCell {
  Table vertices;              // (vertices, dim) on the lattice of order 1
  Table edges;                 // (edges, 2) vertices
  Table faces;                 // (faces, vertices of a face), seen from outside counterclockwise; 3D
  std::vector<int> face_nodes; // faces in the order in which their middle nodes come, after that of the cell; Q2 in 3D
};

const ReferenceCell &reference_cell(const int dim, const Shape shape)
{
  static const ReferenceCell interval{{{0}, {1}}, {{0, 1}}, {}, {}};
  static const ReferenceCell triangle{{{0, 0}, {1, 0}, {0, 1}}, {{0, 1}, {1, 2}, {2, 0}}, {}, {}};
  static const ReferenceCell quadrilateral{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {}, {}};
  static const ReferenceCell tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                         {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
                                         {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}},
                                         {}};
  static const ReferenceCell hexahedron{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}},
      {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}},
      {4, 5, 3, 1, 0, 2}};
  if (dim == 1) return interval;
  if (dim == 2) return shape == Shape::simplex ? triangle : quadrilateral;
  return shape == Shape::simplex ? tetrahedron : hexahedron;
}

/// What the registry holds of an element.
struct Entry {
  Element element;
  const char *exodus_name;
  int gmsh_type;
  std::vector<int> gmsh_place;
  Table lattice, edges, facets;
};

/// The position in the middle of vertices: at the order 2 the lattice has it.
std::vector<int> middle(const ReferenceCell &cell, const std::vector<int> &vertices)
{
  std::vector<int> sum(cell.vertices[0].size(), 0);
  for (const int v : vertices)
    for (std::size_t d = 0; d < sum.size(); ++d) sum[d] += cell.vertices[v][d];
  for (int &coordinate : sum) coordinate = 2 * coordinate / static_cast<int>(vertices.size());
  return sum;
}

Table lattice_of(const Element &element, const ReferenceCell &cell)
{
  Table lattice = cell.vertices;
  for (auto &vertex : lattice)
    for (int &coordinate : vertex) coordinate *= element.order;
  if (element.order == 1) return lattice;
  for (const auto &edge : cell.edges) lattice.push_back(middle(cell, edge));
  if (element.dim == 1 || element.shape == Shape::simplex) return lattice;
  lattice.push_back(std::vector<int>(element.dim, 1));
  for (const int face : cell.face_nodes) lattice.push_back(middle(cell, cell.faces[face]));
  return lattice;
}

/// The nodes of an edge or face, in the order of its own element `part`, by the cell's vertices that it has.
std::vector<int> nodes_of(const Entry &entry, const ReferenceCell &cell, const Element &part,
                          const std::vector<int> &vertices)
{
  const auto node_at = [&](const std::vector<int> &position) {
    return static_cast<int>(std::find(entry.lattice.begin(), entry.lattice.end(), position) - entry.lattice.begin());
  };
  std::vector<int> nodes = vertices;
  if (part.order == 1) return nodes;
  for (const auto &edge : reference_cell(part.dim, part.shape).edges)
    nodes.push_back(node_at(middle(cell, {vertices[edge[0]], vertices[edge[1]]})));
  if (part.dim == 2 && part.shape == Shape::tensor) nodes.push_back(node_at(middle(cell, vertices)));
  return nodes;
}

/// @param gmsh_place  empty if nodes are in the same order
Entry make_entry(const Element &element, const char *const exodus_name, const int gmsh_type,
                 const std::vector<int> &gmsh_place = {})
{
  const ReferenceCell &cell = reference_cell(element.dim, element.shape);
  Entry entry{element, exodus_name, gmsh_type, gmsh_place, lattice_of(element, cell), {}, {}};
  if (gmsh_place.empty()) {
    entry.gmsh_place.resize(entry.lattice.size());
    std::iota(entry.gmsh_place.begin(), entry.gmsh_place.end(), 0);
  }
  for (const auto &edge : cell.edges) entry.edges.push_back(nodes_of(entry, cell, element.edge(), edge));
  if (element.dim == 2) entry.facets = entry.edges;
  for (const auto &face : cell.faces) entry.facets.push_back(nodes_of(entry, cell, element.facet(), face));
  return entry;
}

/// Q2's entry without the nodes in the middle of linear directions.
Entry mixed_entry(const Element &mixed, const Entry &whole)
{
  Entry entry{mixed, "", 0, {}, {}, {}, {}};
  std::vector<int> place(whole.lattice.size(), -1); // of Q2's nodes among those that stay
  for (std::size_t a = 0; a < place.size(); ++a) {
    std::vector<int> position = whole.lattice[a];
    bool stays = true;
    for (int d = 0; d < mixed.dim; ++d) {
      if (!mixed.linear[d]) continue;
      stays = stays && position[d] != 1;
      position[d] /= 2;
    }
    if (!stays) continue;
    place[a] = static_cast<int>(entry.lattice.size());
    entry.lattice.push_back(position);
  }
  const auto without_others = [&place](const Table &table) {
    Table left;
    for (const auto &nodes : table) {
      left.emplace_back();
      for (const int a : nodes)
        if (place[a] >= 0) left.back().push_back(place[a]);
    }
    return left;
  };
  entry.edges = without_others(whole.edges);
  entry.facets = without_others(whole.facets);
  return entry;
}

/// All elements but the mixed ones; cells from `first_cell` on.
constexpr std::size_t first_cell = 2;
const std::vector<Entry> &registry()
{
  constexpr Shape tensor = Shape::tensor, simplex = Shape::simplex;
  static const std::vector<Entry> entries = {
      make_entry({1, 1, tensor}, "BAR2", 1),
      make_entry({1, 2, tensor}, "BAR3", 8),
      make_entry({2, 1, simplex}, "TRI3", 2),
      make_entry({2, 2, simplex}, "TRI6", 9),
      make_entry({2, 1, tensor}, "QUAD4", 3),
      make_entry({2, 2, tensor}, "QUAD9", 10),
      make_entry({3, 1, simplex}, "TETRA4", 4),
      make_entry({3, 2, simplex}, "TETRA10", 11, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}),
      make_entry({3, 1, tensor}, "HEX8", 5),
      make_entry({3, 2, tensor}, "HEX27", 12,
                 {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 10, 12, 14, 15, 16, 18, 19, 17, 26, 20, 25, 22, 23, 21, 24})};
  return entries;
}

constexpr int quadrilateral_2 = 5, hexahedron_2 = 9; // Q2's places there

/// Of a dimension, in the order of the number whose binary digits say which directions are linear, from 1 on.
const std::vector<Entry> &mixed_registry(const int dim)
{
  static const auto all_of = [](const int of_dim) {
    std::vector<Entry> entries;
    for (int directions = 1; directions < (1 << of_dim) - 1; ++directions) {
      Element mixed{of_dim, 2, Shape::tensor};
      for (int d = 0; d < of_dim; ++d) mixed.linear[d] = (directions >> d) % 2 == 1;
      entries.push_back(mixed_entry(mixed, registry()[of_dim == 2 ? quadrilateral_2 : hexahedron_2]));
    }
    return entries;
  };
  static const std::vector<Entry> in_plane = all_of(2), in_space = all_of(3);
  return dim == 2 ? in_plane : in_space;
}

const Entry &entry_of(const Element &element)
{
  const int dim = element.dim, order = element.order;
  const bool simplex = element.shape == Shape::simplex;
  if (element.mixed()) {
    const int directions = element.linear[0] + 2 * element.linear[1] + 4 * element.linear[2];
    RPC_REQUIRE_CODE(!simplex && order == 2 && (dim == 2 || dim == 3) && directions < (1 << dim) - 1,
                     ExitCode::internal_error, "mesh: there is no such mixed element in " << dim << "D");
    return mixed_registry(dim)[directions - 1];
  }
  const bool known = dim >= 1 && dim <= 3 && (order == 1 || order == 2) && !(dim == 1 && simplex);
  RPC_REQUIRE_CODE(known, ExitCode::internal_error,
                   "mesh: there is no element of order " << order << " in " << dim << "D");
  if (dim == 1) return registry()[order - 1];
  return registry()[first_cell + 4 * (dim - 2) + 2 * (simplex ? 0 : 1) + order - 1];
}

} // namespace

Element Element::with_order_one_along(const std::array<bool, 3> &directions) const
{
  Element lower = *this;
  if (order == 1) return lower;
  int left = dim; // directions of order 2
  for (int d = 0; d < dim; ++d) {
    lower.linear[d] = linear[d] || directions[d];
    left -= lower.linear[d];
  }
  if (left > 0) return lower;
  return {dim, 1, shape};
}
std::string Element::name() const
{
  if (mixed()) {
    std::string name = "Q";
    for (int d = 0; d < dim; ++d) name += std::to_string(order_along(d));
    return name;
  }
  return (shape == Shape::simplex ? "P" : "Q") + std::to_string(order);
}
std::string Element::exodus_name() const
{
  return entry_of(*this).exodus_name;
}
int Element::gmsh_type() const
{
  return entry_of(*this).gmsh_type;
}
int Element::num_nodes() const
{
  return static_cast<int>(lattice().size());
}
int Element::num_vertices() const
{
  return shape == Shape::simplex ? dim + 1 : 1 << dim;
}
int Element::num_facets() const
{
  return static_cast<int>(facets().size());
}
int Element::num_facet_nodes() const
{
  return facet().num_nodes();
}
Element Element::facet() const
{
  RPC_REQUIRE_CODE(!mixed(), ExitCode::internal_error, "mesh: the facets of a mixed element differ");
  return {dim - 1, order, dim == 2 ? Shape::tensor : shape};
}
Element Element::edge() const
{
  RPC_REQUIRE_CODE(!mixed(), ExitCode::internal_error, "mesh: the edges of a mixed element differ");
  return {1, order, Shape::tensor};
}
const Table &Element::lattice() const
{
  return entry_of(*this).lattice;
}
const Table &Element::facets() const
{
  return entry_of(*this).facets;
}
const Table &Element::edges() const
{
  return entry_of(*this).edges;
}
const std::vector<int> &Element::gmsh_place() const
{
  return entry_of(*this).gmsh_place;
}

const std::vector<Element> &all_elements()
{
  static const std::vector<Element> elements = [] {
    std::vector<Element> cells;
    for (std::size_t e = first_cell; e < registry().size(); ++e) cells.push_back(registry()[e].element);
    return cells;
  }();
  return elements;
}

const std::vector<Element> &mixed_elements(const int dim)
{
  static const auto all_of = [](const int of_dim) {
    std::vector<Element> elements;
    for (const Entry &entry : mixed_registry(of_dim)) elements.push_back(entry.element);
    return elements;
  };
  static const std::vector<Element> in_plane = all_of(2), in_space = all_of(3);
  return dim == 2 ? in_plane : in_space;
}

std::optional<Element> element_of_gmsh_type(const int type)
{
  for (const Element &element : all_elements())
    if (element.gmsh_type() == type) return element;
  return std::nullopt;
}

Element parse_element(const std::string &name, const int dim)
{
  const bool known = name == "P1" || name == "P2" || name == "Q1" || name == "Q2";
  RPC_REQUIRE(known, "deck: \"Mesh->Element\" must be one of P1, P2, Q1, Q2, got \"" << name << "\"");
  return Element{dim, name[1] == '1' ? 1 : 2, name[0] == 'P' ? Shape::simplex : Shape::tensor};
}

} // namespace rpc::mesh
