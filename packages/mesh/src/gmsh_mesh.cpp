// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_mesh.hpp"

#include "cell_kinds.hpp"
#include "gmsh_sides.hpp"
#include "gmsh_types.hpp"
#include "mesh_checks.hpp"
#include "mesh_mending.hpp"
#include "mixed_cells.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace rpc::mesh
{
namespace
{

bool is_control(const unsigned char c)
{
  return std::iscntrl(c) != 0;
}

/// A group without a name is named by its number. Blanks at the end of a name are none of it.
void name_groups(GmshContents &contents)
{
  for (GmshGroup &group : contents.groups) {
    const std::size_t length = group.name.find_last_not_of(" \t") + 1;
    if (length < group.name.size() && length > 0)
      contents.notes.push_back("the name of " + contents.kind[group.dim] + " \"" + group.name +
                               "\" ends in blanks, which do not count: \"" + group.name.substr(0, length) + "\"");
    group.name.resize(length);
    if (group.name.empty()) group.name = std::to_string(group.tag);
  }
}

/// Groups without elements are left out.
void note_empty_groups(GmshContents &contents)
{
  std::set<int> filled;
  for (const auto &elements : contents.elements) filled.insert(elements.group);
  for (int g = 0; g < static_cast<int>(contents.groups.size()); ++g)
    if (!filled.count(g) && contents.groups[g].dim > 0)
      contents.notes.push_back(contents.kind[contents.groups[g].dim] + " \"" + contents.groups[g].name +
                               "\" has no elements: it is left out");
}

void check_groups(const std::string &where, const GmshContents &contents)
{
  const bool body = std::any_of(contents.elements.begin(), contents.elements.end(), [&](const auto &elements) {
    return contents.groups[elements.group].dim == contents.dim;
  });
  RPC_REQUIRE_CODE(body, ExitCode::bad_mesh,
                   where << (contents.kind == GmshContents().kind
                                 ? std::string("has no cells in a ") + (contents.dim == 2 ? "surface" : "volume") +
                                       "; where there are physical groups, gmsh writes those only: add Physical " +
                                       (contents.dim == 2 ? "Surface" : "Volume") + "(\"body\") = {...};"
                                 : std::string("has no cells: triangles or quadrilaterals in the plane, tetrahedra or "
                                               "hexahedra in space")));
  std::map<std::pair<int, std::string>, int> tags;
  for (const auto &[dim, tag, name] : contents.groups) {
    const std::string &kind = contents.kind[dim];
    RPC_REQUIRE_CODE(name.size() <= longest_name && std::none_of(name.begin(), name.end(), is_control),
                     ExitCode::bad_mesh,
                     where << kind << " " << tag << " must have a name of at most " << longest_name
                           << " characters, none of them a control character, got \"" << name << "\"");
    const auto [same, fresh] = tags.insert({{dim, name}, tag});
    RPC_REQUIRE_CODE(fresh, ExitCode::bad_mesh,
                     where << kind << "s " << same->second << " and " << tag << " share the name \"" << name << "\"");
  }
}

/// Each cell is in one block, once.
void check_blocks(const std::string &where, const GmshContents &contents)
{
  std::vector<std::pair<std::size_t, int>> cells; // tag, group
  for (const auto &elements : contents.elements)
    if (contents.groups[elements.group].dim == contents.dim)
      for (const std::size_t tag : elements.tags) cells.push_back({tag, elements.group});
  if (!std::is_sorted(cells.begin(), cells.end())) std::sort(cells.begin(), cells.end());
  for (std::size_t c = 1; c < cells.size(); ++c) {
    const auto block = [&](const std::size_t at) { return contents.groups[cells[at].second].name; };
    RPC_REQUIRE_CODE(cells[c].first != cells[c - 1].first || cells[c].second == cells[c - 1].second, ExitCode::bad_mesh,
                     where << "cell " << cells[c].first << " belongs to the " << contents.kind[contents.dim] << "s \""
                           << block(c - 1) << "\" and \"" << block(c) << "\"; each cell must belong to one");
    RPC_REQUIRE_CODE(cells[c].first != cells[c - 1].first, ExitCode::bad_mesh,
                     where << "there are two cells " << cells[c].first << " in \"" << block(c) << "\"");
  }
}

/// The one kind of cell that the whole body has: cells of several kinds have been divided, if they are of one order.
Element element_of(const std::string &where, const GmshContents &contents)
{
  const GmshElements *first = nullptr;
  for (const auto &elements : contents.elements) {
    const auto &group = contents.groups[elements.group];
    if (group.dim != contents.dim) continue;
    RPC_REQUIRE_CODE(cell_kind(elements.type), ExitCode::bad_mesh,
                     where << "cells of type \"" << name_of_gmsh_type(elements.type) << "\" in "
                           << contents.kind[group.dim] << " \"" << group.name << "\"; "
                           << (contents.dim == 2 ? "triangles of 3 or 6 nodes and quadrilaterals of 4, 8 or 9"
                                                 : "tetrahedra of 4 or 10 nodes, hexahedra of 8, 20 or 27, wedges "
                                                   "of 6, 15 or 18 and pyramids of 5, 13 or 14")
                           << " can be read");
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
    std::string text = std::to_string(count) + " of type \"" + name_of_gmsh_type(type) + "\" in ";
    for (const auto &group : names) text += (group == *names.begin() ? "" : ", ") + group;
    return text;
  };
  const auto is_linear = [](const GmshElements &elements) { return cell_kind(elements.type)->linear == elements.type; };
  const GmshElements *other = nullptr; // one of another order: those of one order would have been divided
  for (const auto &elements : contents.elements)
    if (contents.groups[elements.group].dim == contents.dim && elements.type != first->type &&
        (!other || is_linear(elements) != is_linear(*first)))
      other = &elements;
  RPC_REQUIRE_CODE(!other, ExitCode::bad_mesh,
                   where << "cells must be of one order, 1 or 2, got " << summary(first->type) << " and "
                         << summary(other->type) << "; mesh all of them with order 1, or with 2");
  return *element_of_gmsh_type(first->type);
}

bool has_pyramids(const GmshContents &contents)
{
  return std::any_of(contents.elements.begin(), contents.elements.end(), [](const GmshElements &elements) {
    const CellKind *const kind = cell_kind(elements.type);
    return kind && kind->num_vertices == 5;
  });
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

/// A mesh in the plane at one z other than 0 lies in the plane.
void drop_height(TaggedMesh &draft)
{
  if (draft.z.empty()) return;
  double size = 0;
  for (const double x : draft.mesh.coords) size = std::max(size, std::abs(x - draft.mesh.coords[0]));
  const double height = draft.z[0];
  const bool flat =
      std::all_of(draft.z.begin(), draft.z.end(), [&](const double z) { return std::abs(z - height) <= 1e-10 * size; });
  if (!flat || std::abs(height) <= 1e-10 * size) return;
  draft.z.assign(draft.z.size(), 0.);
  std::ostringstream note;
  note << "all nodes have z = " << height << ": the body lies in the plane";
  draft.mesh.notes.push_back(note.str());
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

/// Nodes that no cell uses are left out.
void note_unused_nodes(const GmshContents &contents, TaggedMesh &draft)
{
  const std::set<std::size_t> elsewhere(contents.ungrouped_nodes.begin(), contents.ungrouped_nodes.end());
  std::size_t count = 0, first = 0;
  for (std::size_t n = 0; n < contents.node_tags.size(); ++n) {
    const std::size_t tag = contents.node_tags[n];
    if (find_node(draft, tag) >= 0 || elsewhere.count(tag)) continue;
    if (count++ == 0) first = n;
  }
  if (count == 0) return;
  const double *const x = &contents.coords[3 * first];
  std::ostringstream note;
  note << "no cell uses node " << contents.node_tags[first] << " at (" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  if (count > 1) note << ", nor " << count - 1 << (count == 2 ? " other" : " others");
  note << (count > 1 ? ": they are left out" : ": it is left out");
  draft.mesh.notes.push_back(note.str());
}

} // namespace

MeshData mesh_of_gmsh(const std::string &where, GmshContents contents, const bool made)
{
  TaggedMesh draft;
  draft.where = where;
  name_groups(contents);
  check_groups(draft.where, contents);
  note_empty_groups(contents);
  check_blocks(draft.where, contents);
  complete_serendipity(where, contents);
  if (made && has_pyramids(contents))
    draft.overlap_remedy =
        ". Of some sizes of cells gmsh makes such meshes where it puts pyramids between quadrilaterals "
        "and tetrahedra: try another size, or leave out Recombine there";
  divide_mixed_cells(draft.where, contents, made);
  draft.mesh.element = element_of(draft.where, contents);
  take_nodes(contents, draft);
  take_cells(contents, draft);
  if (!made) drop_height(draft);
  check_nodes(draft);
  turn_mirrored_cells(draft);
  check_cells(draft);
  const Entities facets = facets_of(draft.mesh.element, draft.mesh.cells);
  check_facets(draft, facets);
  take_sides(contents, facets, draft);
  take_points(contents, facets, draft);
  take_geometry(contents, facets, draft);
  if (!made) note_unused_nodes(contents, draft);
  draft.mesh.notes.insert(draft.mesh.notes.begin(), contents.notes.begin(), contents.notes.end());
  return std::move(draft.mesh);
}

} // namespace rpc::mesh
