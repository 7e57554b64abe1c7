// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_mesh.hpp"

#include "gmsh_types.hpp"
#include "mesh_checks.hpp"
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

constexpr const char *kind_of_group[] = {"point", "curve", "surface", "volume"};
constexpr const char *statement_for_group[] = {"Point", "Curve", "Surface", "Volume"}; // of a .geo

bool is_control(const unsigned char c)
{
  return std::iscntrl(c) != 0;
}

/// A group without a name is named by its number.
void name_groups(GmshContents &contents)
{
  for (GmshGroup &group : contents.groups)
    if (group.name.empty()) group.name = std::to_string(group.tag);
}

void check_groups(const std::string &where, const GmshContents &contents)
{
  const bool body = std::any_of(contents.elements.begin(), contents.elements.end(), [&](const auto &elements) {
    return contents.groups[elements.group].dim == contents.dim;
  });
  const char *const kind_of_body = kind_of_group[contents.dim];
  RPC_REQUIRE_CODE(body, ExitCode::bad_mesh,
                   where << "has no cells in a " << kind_of_body
                         << "; where there are physical groups, gmsh writes those only: add Physical "
                         << statement_for_group[contents.dim] << "(\"body\") = {...};");
  std::map<std::pair<int, std::string>, int> tags;
  for (const auto &[dim, tag, name] : contents.groups) {
    const char *const kind = kind_of_group[dim];
    RPC_REQUIRE_CODE(name.size() <= longest_name && std::none_of(name.begin(), name.end(), is_control),
                     ExitCode::bad_mesh,
                     where << "physical " << kind << " " << tag << " must have a name of at most " << longest_name
                           << " characters, none of them a control character, got \"" << name << "\"");
    const auto [same, fresh] = tags.insert({{dim, name}, tag});
    RPC_REQUIRE_CODE(fresh, ExitCode::bad_mesh,
                     where << "physical " << kind << "s " << same->second << " and " << tag << " share the name \""
                           << name << "\"");
  }
  std::set<int> filled;
  for (const auto &elements : contents.elements) filled.insert(elements.group);
  for (int g = 0; g < static_cast<int>(contents.groups.size()); ++g)
    RPC_REQUIRE_CODE(filled.count(g) || contents.groups[g].dim == 0, ExitCode::bad_mesh,
                     where << "physical " << kind_of_group[contents.groups[g].dim] << " \"" << contents.groups[g].name
                           << "\" has no elements");
}

std::string name_of_type(const int number)
{
  const GmshType *const type = gmsh_type(number);
  return type ? type->name() : std::to_string(number);
}

/// The name of a type within a sentence, "triangle".
std::string noun_of_type(const int number)
{
  std::string noun = gmsh_type(number) ? gmsh_type(number)->shape : "element";
  noun[0] = static_cast<char>(std::tolower(noun[0]));
  return noun;
}

/// What to do about cells of a type that cannot be read, if there is something.
std::string remedy_for_type(const int number)
{
  const GmshType *const type = gmsh_type(number);
  const std::string shape = type ? type->shape : "";
  if (shape == "Prism" || shape == "Pyramid")
    return "; without Recombine there are tetrahedra, and with Mesh.SubdivisionAlgorithm = 2 besides hexahedra";
  constexpr int quadrilateral_8 = 16, hexahedron_20 = 17;
  if (number == quadrilateral_8 || number == hexahedron_20) return "; mesh with Mesh.SecondOrderIncomplete = 0";
  return "";
}

/// The one kind of cell that the whole body has.
Element element_of(const std::string &where, const GmshContents &contents)
{
  const GmshElements *first = nullptr;
  for (const auto &elements : contents.elements) {
    const auto &group = contents.groups[elements.group];
    if (group.dim != contents.dim) continue;
    RPC_REQUIRE_CODE(element_of_gmsh_type(elements.type), ExitCode::bad_mesh,
                     where << "cells of type \"" << name_of_type(elements.type) << "\" in physical "
                           << kind_of_group[group.dim] << " \"" << group.name << "\"; "
                           << (contents.dim == 2 ? "triangles of 3 or 6 nodes and quadrilaterals of 4 or 9"
                                                 : "tetrahedra of 4 or 10 nodes and hexahedra of 8 or 27")
                           << " can be read" << remedy_for_type(elements.type));
    if (!first) first = &elements;
  }
  const auto summary = [&](const int type) {
    std::size_t count = 0;
    std::set<std::string> names;
    for (const auto &elements : contents.elements) {
      if (elements.type != type) continue;
      count += elements.tags.size();
      names.insert("\"" + contents.groups[elements.group].name + "\"");
    }
    std::string text = std::to_string(count) + " of type \"" + name_of_type(type) + "\" in ";
    for (const auto &group : names) text += (group == *names.begin() ? "" : ", ") + group;
    return text;
  };
  for (const auto &elements : contents.elements)
    RPC_REQUIRE_CODE(
        contents.groups[elements.group].dim != contents.dim || elements.type == first->type, ExitCode::bad_mesh,
        where << "cells must be of one kind, got " << summary(first->type) << " and " << summary(elements.type)
              << "; a .geo that recombines may need Mesh.SubdivisionAlgorithm = " << contents.dim - 1);
  return *element_of_gmsh_type(first->type);
}

/// The tags of cells' nodes, once each.
void number_nodes(const GmshContents &contents, TaggedMesh &draft)
{
  std::size_t count = 0, greatest = 0;
  const auto each_tag = [&](const auto &call) {
    for (const auto &elements : contents.elements)
      if (contents.groups[elements.group].dim == contents.dim)
        std::for_each(elements.nodes.begin(), elements.nodes.end(), call);
  };
  each_tag([&](const std::size_t tag) {
    ++count;
    greatest = std::max(greatest, tag);
  });
  if (greatest <= count) { // as gmsh numbers them: a table is faster than to sort and to search
    draft.node_of_tag.assign(greatest + 1, -1);
    each_tag([&](const std::size_t tag) { draft.node_of_tag[tag] = 0; });
    for (std::size_t tag = 0; tag <= greatest; ++tag)
      if (draft.node_of_tag[tag] == 0) {
        draft.node_of_tag[tag] = static_cast<int>(draft.node_tag.size());
        draft.node_tag.push_back(tag);
      }
    return;
  }
  each_tag([&](const std::size_t tag) { draft.node_tag.push_back(tag); });
  std::sort(draft.node_tag.begin(), draft.node_tag.end());
  draft.node_tag.erase(std::unique(draft.node_tag.begin(), draft.node_tag.end()), draft.node_tag.end());
}

void take_nodes(const GmshContents &contents, TaggedMesh &draft)
{
  number_nodes(contents, draft);

  std::vector<std::pair<std::size_t, std::size_t>> places; // tag, where in contents.coords
  places.reserve(contents.node_tags.size());
  for (std::size_t n = 0; n < contents.node_tags.size(); ++n) places.push_back({contents.node_tags[n], n});
  if (!std::is_sorted(places.begin(), places.end())) std::sort(places.begin(), places.end());
  for (std::size_t n = 1; n < places.size(); ++n)
    RPC_REQUIRE_CODE(places[n].first != places[n - 1].first, ExitCode::bad_mesh,
                     draft.where << "there are two nodes " << places[n].first);
  auto place = places.begin(); // both run upwards
  for (const std::size_t tag : draft.node_tag) {
    while (place != places.end() && place->first < tag) ++place;
    RPC_REQUIRE_CODE(place != places.end() && place->first == tag, ExitCode::bad_mesh,
                     draft.where << "cells use node " << tag << ", which the file lacks");
    const double *const x = &contents.coords[3 * place->second];
    draft.mesh.coords.insert(draft.mesh.coords.end(), x, x + contents.dim);
    if (contents.dim == 2) draft.z.push_back(x[2]);
  }
}

/// The node with that tag, -1 if cells use none.
int find_node(const TaggedMesh &draft, const std::size_t tag)
{
  if (!draft.node_of_tag.empty()) return tag < draft.node_of_tag.size() ? draft.node_of_tag[tag] : -1;
  const auto it = std::lower_bound(draft.node_tag.begin(), draft.node_tag.end(), tag);
  return it == draft.node_tag.end() || *it != tag ? -1 : static_cast<int>(it - draft.node_tag.begin());
}

/// Leaves no nodes of cells in the contents: of a large body they take much memory.
void take_cells(GmshContents &contents, TaggedMesh &draft)
{
  const std::vector<int> &place = draft.mesh.element.gmsh_place();
  int block = -1, group = -1;
  for (auto &elements : contents.elements) {
    if (contents.groups[elements.group].dim != contents.dim) continue;
    if (elements.group != group) {
      group = elements.group;
      block = static_cast<int>(draft.mesh.blocks.size());
      draft.mesh.blocks.push_back(contents.groups[group].name);
    }
    for (std::size_t first = 0; first < elements.nodes.size(); first += place.size())
      for (const int a : place) draft.mesh.cells.push_back(find_node(draft, elements.nodes[first + a]));
    draft.mesh.block.insert(draft.mesh.block.end(), elements.tags.size(), block);
    draft.cell_tag.insert(draft.cell_tag.end(), elements.tags.begin(), elements.tags.end());
    elements.nodes = {};
  }
}

void check_blocks(const TaggedMesh &draft)
{
  std::vector<std::pair<std::size_t, int>> cells; // tag, cell
  cells.reserve(draft.cell_tag.size());
  for (std::size_t c = 0; c < draft.cell_tag.size(); ++c) cells.push_back({draft.cell_tag[c], static_cast<int>(c)});
  if (!std::is_sorted(cells.begin(), cells.end())) std::sort(cells.begin(), cells.end());
  for (std::size_t c = 1; c < cells.size(); ++c) {
    const auto block = [&](const std::size_t at) { return draft.mesh.blocks[draft.mesh.block[cells[at].second]]; };
    RPC_REQUIRE_CODE(cells[c].first != cells[c - 1].first || block(c - 1) == block(c), ExitCode::bad_mesh,
                     draft.where << "cell " << cells[c].first << " belongs to the physical "
                                 << kind_of_group[draft.mesh.element.dim] << "s \"" << block(c - 1) << "\" and \""
                                 << block(c) << "\"; each cell must belong to one");
    RPC_REQUIRE_CODE(cells[c].first != cells[c - 1].first, ExitCode::bad_mesh,
                     draft.where << "there are two cells " << cells[c].first << " in \"" << block(c) << "\"");
  }
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
  const std::string &side;
  int type;
  std::size_t tag;
  std::vector<std::size_t> vertices, middle; // tags of its nodes
};

/// The number in `facets` of the facet that it lies on.
int facet_of(const TaggedMesh &draft, const Entities &facets, const SideElement &element)
{
  const bool plane = draft.mesh.element.dim == 2;
  const auto label = [&] {
    return draft.where + noun_of_type(element.type) + " " + std::to_string(element.tag) + " of physical " +
           kind_of_group[draft.mesh.element.dim - 1] + " \"" + element.side + "\", " +
           (plane ? "between" : "with the") + " nodes " + listed(element.vertices) + ", ";
  };
  std::vector<int> vertices;
  for (const std::size_t tag : element.vertices) vertices.push_back(find_node(draft, tag));
  const std::optional<int> facet = facets.find(vertices);
  RPC_REQUIRE_CODE(facet, ExitCode::bad_mesh, label() << "is " << (plane ? "an edge" : "a face") << " of no cell");
  const int num_cells = facets.num_cells_at(*facet);
  RPC_REQUIRE_CODE(num_cells == 1, ExitCode::bad_mesh,
                   label() << "lies inside the body, between the cells " << draft.cell_tag[facets.cell(*facet, 0)]
                           << " and " << draft.cell_tag[facets.cell(*facet, num_cells - 1)]
                           << "; a side must be part of the boundary");
  if (element.middle.empty()) return *facet;
  std::vector<std::size_t> own = element.middle, of_cell;
  const std::vector<int> nodes = nodes_of_facet(draft.mesh, facets.cell(*facet, 0), facets.ordinal(*facet, 0));
  for (std::size_t a = vertices.size(); a < nodes.size(); ++a) of_cell.push_back(draft.node_tag[nodes[a]]);
  std::sort(own.begin(), own.end());
  std::sort(of_cell.begin(), of_cell.end());
  RPC_REQUIRE_CODE(own == of_cell, ExitCode::bad_mesh,
                   label() << "has the middle node" << (plane ? " " : "s ") << listed(own)
                           << ", but the cell there has " << listed(of_cell));
  return *facet;
}

void take_sides(const GmshContents &contents, const Entities &facets, TaggedMesh &draft)
{
  const Element element = draft.mesh.element.facet();
  const std::ptrdiff_t width = element.num_nodes(), num_vertices = element.num_vertices();
  int group = -1;
  std::set<int> taken; // facets
  for (const auto &elements : contents.elements) {
    if (contents.groups[elements.group].dim != element.dim) continue;
    const std::string &name = contents.groups[elements.group].name;
    RPC_REQUIRE_CODE(
        elements.type == element.gmsh_type(), ExitCode::bad_mesh,
        draft.where << noun_of_type(elements.type) << "s of type \"" << name_of_type(elements.type) << "\" in physical "
                    << kind_of_group[element.dim] << " \"" << name << "\", which do not fit cells of "
                    << (element.dim == 1 ? "order " + std::to_string(element.order)
                                         : "type \"" + name_of_type(draft.mesh.element.gmsh_type()) + "\""));
    if (elements.group != group) {
      group = elements.group;
      draft.mesh.sides.push_back({name, {}, {}});
      taken.clear();
    }
    SideData &side = draft.mesh.sides.back();
    auto nodes = elements.nodes.begin();
    for (const std::size_t tag : elements.tags) {
      const int facet =
          facet_of(draft, facets,
                   {name, elements.type, tag, {nodes, nodes + num_vertices}, {nodes + num_vertices, nodes + width}});
      nodes += width;
      if (!taken.insert(facet).second) continue;
      side.cell.push_back(facets.cell(facet, 0));
      side.ordinal.push_back(facets.ordinal(facet, 0));
    }
  }
}

/// What the facets of the boundary lie on; elements inside the body, between two cells, do not count.
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

/// Physical points, those that lie at nodes of cells: a circle's centre may lie at none.
void take_points(const GmshContents &contents, TaggedMesh &draft)
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
    draft.mesh.points.push_back(set);
  }
}

void check_unused_nodes(const GmshContents &contents, const TaggedMesh &draft)
{
  const std::set<std::size_t> elsewhere(contents.ungrouped_nodes.begin(), contents.ungrouped_nodes.end());
  for (std::size_t n = 0; n < contents.node_tags.size(); ++n) {
    const std::size_t tag = contents.node_tags[n];
    const double *const x = &contents.coords[3 * n];
    RPC_REQUIRE_CODE(find_node(draft, tag) >= 0 || elsewhere.count(tag), ExitCode::bad_mesh,
                     draft.where << "no cell uses node " << tag << " at (" << x[0] << ", " << x[1] << ", " << x[2]
                                 << "); leave it out (gmsh does unless Mesh.SaveAll = 1)");
  }
}

} // namespace

MeshData mesh_of_gmsh(const std::string &where, GmshContents contents, const bool any_nodes)
{
  TaggedMesh draft;
  draft.where = where;
  name_groups(contents);
  check_groups(draft.where, contents);
  draft.mesh.element = element_of(draft.where, contents);
  take_nodes(contents, draft);
  take_cells(contents, draft);
  check_blocks(draft);
  check_nodes(draft);
  check_cells(draft);
  const Entities facets = facets_of(draft.mesh.element, draft.mesh.cells);
  check_facets(draft, facets);
  take_sides(contents, facets, draft);
  take_points(contents, draft);
  take_geometry(contents, facets, draft);
  if (!any_nodes) check_unused_nodes(contents, draft);
  return std::move(draft.mesh);
}

} // namespace rpc::mesh
