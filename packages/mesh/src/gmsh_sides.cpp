// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_sides.hpp"

#include "gmsh_types.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace rpc::mesh
{
namespace
{

/// The name of a type within a sentence, "triangle".
std::string noun_of_type(const int number)
{
  std::string noun = gmsh_type(number) ? gmsh_type(number)->shape : "element";
  noun[0] = static_cast<char>(std::tolower(noun[0]));
  return noun;
}

/// "1 and 2", "1, 2 and 3".
std::string listed(const std::vector<std::size_t> &numbers)
{
  std::string text;
  for (std::size_t n = 0; n < numbers.size(); ++n)
    text += (n == 0 ? "" : n + 1 < numbers.size() ? ", " : " and ") + std::to_string(numbers[n]);
  return text;
}

/// An element of a side, as the file has it.
struct SideElement {
  const std::string &kind; ///< of the group
  const std::string &side;
  int type;
  std::size_t tag;
  std::vector<std::size_t> vertices, middle; // tags of its nodes
};

std::optional<int> find_facet(const TaggedMesh &draft, const Entities &facets, const std::vector<std::size_t> &tags)
{
  std::vector<int> vertices;
  for (const std::size_t tag : tags) vertices.push_back(find_node(draft, tag));
  return facets.find(vertices);
}

/// The number in `facets` of the facet that it lies on.
int facet_of(const TaggedMesh &draft, const Entities &facets, const SideElement &element)
{
  const bool plane = draft.mesh.element.dim == 2;
  const auto label = [&] {
    return draft.where + noun_of_type(element.type) + " " + std::to_string(element.tag) + " of " + element.kind +
           " \"" + element.side + "\", " + (plane ? "between" : "with the") + " nodes " + listed(element.vertices) +
           ", ";
  };
  const std::optional<int> facet = find_facet(draft, facets, element.vertices);
  RPC_REQUIRE_CODE(facet, ExitCode::bad_mesh, label() << "is " << (plane ? "an edge" : "a face") << " of no cell");
  const int num_cells = facets.num_cells_at(*facet);
  RPC_REQUIRE_CODE(num_cells == 1, ExitCode::bad_mesh,
                   label() << "lies inside the body, between the cells " << draft.cell_tag[facets.cell(*facet, 0)]
                           << " and " << draft.cell_tag[facets.cell(*facet, num_cells - 1)]
                           << "; a side must be part of the boundary, and others of this group are: give those inside "
                              "a group of their own");
  if (element.middle.empty()) return *facet;
  std::vector<std::size_t> own = element.middle, of_cell;
  const std::vector<int> nodes = nodes_of_facet(draft.mesh, facets.cell(*facet, 0), facets.ordinal(*facet, 0));
  for (std::size_t a = element.vertices.size(); a < nodes.size(); ++a) of_cell.push_back(draft.node_tag[nodes[a]]);
  std::sort(own.begin(), own.end());
  std::sort(of_cell.begin(), of_cell.end());
  RPC_REQUIRE_CODE(own == of_cell, ExitCode::bad_mesh,
                   label() << "has the middle node" << (plane ? " " : "s ") << listed(own)
                           << ", but the cell there has " << listed(of_cell));
  return *facet;
}

/// Of a group's elements that are no facets of the boundary: all of them lie inside the body, or are no facets of cells at all.
enum class NoSide { boundary, inner, stray };

NoSide kind_of_side(const GmshContents &contents, const int group, const Entities &facets, const TaggedMesh &draft)
{
  const Element element = draft.mesh.element.facet();
  const std::ptrdiff_t width = element.num_nodes();
  bool inner = false;
  for (const auto &elements : contents.elements) {
    if (elements.group != group) continue;
    if (elements.type != element.gmsh_type()) return NoSide::boundary; // refused later
    for (auto nodes = elements.nodes.begin(); nodes != elements.nodes.end(); nodes += width) {
      const auto facet = find_facet(draft, facets, {nodes, nodes + element.num_vertices()});
      if (facet && facets.num_cells_at(*facet) == 1) return NoSide::boundary;
      inner = inner || facet;
    }
  }
  return inner ? NoSide::inner : NoSide::stray;
}

/// A group inside the body is no side. Its nodes are points, which may be held.
void take_inner_group(const GmshContents &contents, const int group, TaggedMesh &draft)
{
  PointData set{contents.groups[group].name, {}};
  for (const auto &elements : contents.elements)
    if (elements.group == group)
      for (const std::size_t tag : elements.nodes)
        if (const int node = find_node(draft, tag); node >= 0) set.node.push_back(node);
  std::sort(set.node.begin(), set.node.end());
  set.node.erase(std::unique(set.node.begin(), set.node.end()), set.node.end());
  draft.mesh.notes.push_back(
      contents.kind[contents.groups[group].dim] + " \"" + set.name +
      "\" lies inside the body: it is no side; its nodes are points, which \"Dirichlet\" may hold");
  draft.mesh.points.push_back(std::move(set));
}

void take_side(const GmshContents &contents, const int group, const Entities &facets, TaggedMesh &draft)
{
  const Element element = draft.mesh.element.facet();
  const std::ptrdiff_t width = element.num_nodes(), num_vertices = element.num_vertices();
  const std::string &kind = contents.kind[element.dim];
  const std::string &name = contents.groups[group].name;
  SideData side{name, {}, {}};
  std::set<int> taken; // facets
  for (const auto &elements : contents.elements) {
    if (elements.group != group) continue;
    RPC_REQUIRE_CODE(elements.type == element.gmsh_type(), ExitCode::bad_mesh,
                     draft.where << noun_of_type(elements.type) << "s of type \"" << name_of_gmsh_type(elements.type)
                                 << "\" in " << kind << " \"" << name << "\", which do not fit cells of "
                                 << (element.dim == 1
                                         ? "order " + std::to_string(element.order)
                                         : "type \"" + name_of_gmsh_type(draft.mesh.element.gmsh_type()) + "\""));
    auto nodes = elements.nodes.begin();
    for (const std::size_t tag : elements.tags) {
      const int facet = facet_of(
          draft, facets,
          {kind, name, elements.type, tag, {nodes, nodes + num_vertices}, {nodes + num_vertices, nodes + width}});
      nodes += width;
      if (!taken.insert(facet).second) continue;
      side.cell.push_back(facets.cell(facet, 0));
      side.ordinal.push_back(facets.ordinal(facet, 0));
    }
  }
  draft.mesh.sides.push_back(std::move(side));
}

/// Whether nodes are those of whole facets of the boundary: they become a side then, unless there is one of that name.
/// @param last_node  the tags of nodes that the file lacks are beyond
bool is_side(const PointData &set, const std::size_t last_node, const Entities &facets, TaggedMesh &draft)
{
  std::vector<char> in_set(draft.mesh.num_nodes(), 0), covered(draft.mesh.num_nodes(), 0);
  for (const int node : set.node) in_set[node] = 1;
  const auto fits = [&](const int node) { return in_set[node] || draft.node_tag[node] > last_node; };
  SideData side{set.name, {}, {}};
  for (int f = 0; f < facets.size(); ++f) {
    if (facets.num_cells_at(f) != 1) continue;
    const std::vector<int> nodes = nodes_of_facet(draft.mesh, facets.cell(f, 0), facets.ordinal(f, 0));
    if (!std::all_of(nodes.begin(), nodes.end(), fits)) continue;
    for (const int node : nodes) covered[node] = in_set[node];
    side.cell.push_back(facets.cell(f, 0));
    side.ordinal.push_back(facets.ordinal(f, 0));
  }
  const auto &sides = draft.mesh.sides;
  const bool known =
      std::any_of(sides.begin(), sides.end(), [&](const SideData &each) { return each.name == set.name; });
  if (known) return true;
  if (covered != in_set || side.cell.empty()) return false;
  draft.mesh.notes.push_back("the nodes of set \"" + set.name + "\" are those of " + std::to_string(side.cell.size()) +
                             " whole facets of the boundary: it is a side");
  draft.mesh.sides.push_back(std::move(side));
  return true;
}

} // namespace

void take_sides(const GmshContents &contents, const Entities &facets, TaggedMesh &draft)
{
  std::set<int> filled;
  for (const auto &elements : contents.elements) filled.insert(elements.group);
  for (const int group : filled) {
    if (contents.groups[group].dim != draft.mesh.element.dim - 1) continue;
    const NoSide kind = kind_of_side(contents, group, facets, draft);
    if (kind == NoSide::boundary)
      take_side(contents, group, facets, draft);
    else if (kind == NoSide::inner)
      take_inner_group(contents, group, draft);
    else
      draft.mesh.notes.push_back(contents.kind[draft.mesh.element.dim - 1] + " \"" + contents.groups[group].name +
                                 "\" belongs to no cell of the body: it is left out");
  }
}

void take_geometry(const GmshContents &contents, const Entities &facets, TaggedMesh &draft)
{
  const Element element = draft.mesh.element.facet();
  const std::ptrdiff_t width = element.num_nodes();
  for (const GmshBoundary &boundary : contents.boundary) {
    if (boundary.type != element.gmsh_type()) continue;
    BoundaryPart part{boundary.shape, {}, {}};
    for (auto nodes = boundary.nodes.begin(); nodes != boundary.nodes.end(); nodes += width) {
      std::vector<int> vertices;
      for (auto tag = nodes; tag != nodes + element.num_vertices(); ++tag) vertices.push_back(find_node(draft, *tag));
      const std::optional<int> facet = facets.find(vertices);
      if (!facet || facets.num_cells_at(*facet) != 1) continue;
      part.cell.push_back(facets.cell(*facet, 0));
      part.ordinal.push_back(facets.ordinal(*facet, 0));
    }
    if (!part.cell.empty()) draft.mesh.geometry.push_back(std::move(part));
  }
}

void take_points(const GmshContents &contents, const Entities &facets, TaggedMesh &draft)
{
  std::map<int, PointData> sets; // by group
  for (const auto &elements : contents.elements) {
    if (contents.groups[elements.group].dim != 0) continue;
    for (const std::size_t tag : elements.nodes)
      if (const int node = find_node(draft, tag); node >= 0) sets[elements.group].node.push_back(node);
  }
  for (auto &[group, set] : sets) {
    set.name = contents.groups[group].name;
    std::sort(set.node.begin(), set.node.end());
    set.node.erase(std::unique(set.node.begin(), set.node.end()), set.node.end());
    if (contents.node_sets && is_side(set, contents.last_node, facets, draft)) continue;
    draft.mesh.points.push_back(set);
  }
}

} // namespace rpc::mesh
