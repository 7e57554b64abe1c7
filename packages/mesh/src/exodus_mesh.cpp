// SPDX-License-Identifier: BSD-3-Clause
#include "exodus_mesh.hpp"

#include "cell_kinds.hpp"
#include "gmsh_types.hpp"
#include "gmsh_wire.hpp"
#include "rpc/core/child_process.hpp"
#include "rpc/core/error.hpp"
#include "rpc/mesh/element.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <exodusII.h>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

namespace rpc::mesh
{
namespace
{

using Integers = std::vector<std::int64_t>;

/// gmsh's number of an element type, by the first three letters of Exodus' name and the nodes; 0: there is none.
int gmsh_type_of(const std::string &name, const std::int64_t num_nodes)
{
  static const std::map<std::pair<std::string, std::int64_t>, int> types = {
      {{"HEX", 8}, 5},   {{"HEX", 20}, 17}, {{"HEX", 27}, 12}, {{"TET", 4}, 4},   {{"TET", 10}, 11}, {{"TRI", 3}, 2},
      {{"TRI", 6}, 9},   {{"QUA", 4}, 3},   {{"QUA", 8}, 16},  {{"QUA", 9}, 10},  {{"SHE", 3}, 2},   {{"SHE", 4}, 3},
      {{"SHE", 8}, 16},  {{"SHE", 9}, 10},  {{"WED", 6}, 6},   {{"WED", 15}, 18}, {{"WED", 18}, 13}, {{"PYR", 5}, 7},
      {{"PYR", 13}, 19}, {{"PYR", 14}, 14}, {{"BAR", 2}, 1},   {{"BAR", 3}, 8},   {{"BEA", 2}, 1},   {{"BEA", 3}, 8},
      {{"TRU", 2}, 1},   {{"TRU", 3}, 8},   {{"EDG", 2}, 1},   {{"EDG", 3}, 8},   {{"SPH", 1}, 15},  {{"NOD", 1}, 15}};
  std::string begin = name.substr(0, 3);
  for (char &c : begin) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto found = types.find({begin, num_nodes});
  return found == types.end() ? 0 : found->second;
}

/// The element whose first nodes a cell of gmsh's type has: serendipity cells lack the last ones of Q2.
std::optional<Element> element_with(const int type)
{
  constexpr int quadrilateral_8 = 16, hexahedron_20 = 17;
  if (type == quadrilateral_8) return Element{2, 2, Shape::tensor};
  if (type == hexahedron_20) return Element{3, 2, Shape::tensor};
  return element_of_gmsh_type(type);
}

/// (nodes) Place of each node of a cell in gmsh's list; empty for cells that no body has.
std::vector<int> places_by_gmsh(const int type)
{
  if (const auto element = element_with(type)) return element->gmsh_place();
  const CellKind *const kind = cell_kind(type);
  if (!kind) return {};
  if (kind->num_vertices == 6) return {0, 1, 2, 3, 4, 5, 6, 9, 7, 8, 10, 11, 12, 14, 13, 15, 17, 16};
  return {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12, 13};
}

/// Faces of a wedge or pyramid in Exodus' order, each by its number in CellKind::faces.
std::vector<int> faces_in_order(const CellKind &kind)
{
  return kind.num_vertices == 6 ? std::vector<int>{2, 4, 3, 0, 1} : std::vector<int>{0, 1, 2, 3, 4};
}

/// Nodes in Exodus' order in that of gmsh.
void append_in_gmsh_order(const std::vector<int> &places, const std::int64_t *const nodes, const int count,
                          std::vector<std::size_t> &all)
{
  const std::size_t begin = all.size();
  all.resize(begin + count);
  for (int a = 0; a < count; ++a) all[begin + places[a]] = static_cast<std::size_t>(nodes[a]);
}

struct ExodusBlock {
  std::string name;
  int type = 0;
  std::int64_t first = 0, count = 0; ///< cells, from 0
  int width = 0;                     ///< nodes of a cell
  int faces = 0;                     ///< sides that come before its edges: the two faces of shells
  Integers nodes;
};

class ExodusMesh
{
public:
  ExodusMesh(std::string where, const std::string &path) : where_(std::move(where))
  {
    ex_opts(EX_DEFAULT); // errors come as return codes, not on the console
    int word_size = sizeof(double), file_word_size = 0;
    float version = 0;
    file_ = ex_open(path.c_str(), EX_READ | EX_ALL_INT64_API, &word_size, &file_word_size, &version);
    RPC_REQUIRE_CODE(file_ >= 0, ExitCode::bad_mesh, where_ << "is no Exodus file, or is damaged");
    std::error_code ignored;
    constexpr double most_compressed = 1032; // zlib's largest ratio
    most_ = most_compressed * static_cast<double>(std::filesystem::file_size(path, ignored));
    const auto length = ex_inquire_int(file_, EX_INQ_DB_MAX_USED_NAME_LENGTH);
    name_length_ = static_cast<int>(std::clamp<std::int64_t>(length, MAX_STR_LENGTH, 4096));
    ex_set_max_name_length(file_, name_length_);
  }
  ~ExodusMesh() { ex_close(file_); }
  ExodusMesh(const ExodusMesh &) = delete;
  ExodusMesh &operator=(const ExodusMesh &) = delete;

  GmshContents contents()
  {
    take_nodes();
    take_blocks();
    take_side_sets();
    take_node_sets();
    return std::move(contents_);
  }

private:
  [[noreturn]] void refuse(const std::string &what) const { throw Error(ExitCode::bad_mesh, where_ + what); }
  void check(const int status, const std::string &what) const
  {
    if (status < 0) refuse(what + " cannot be read: the file is damaged");
  }
  std::int64_t count(const ex_inquiry what, const std::string &name) const
  {
    return plausible(ex_inquire_int(file_, what), name);
  }
  /// A count that the file has room for.
  std::int64_t plausible(const std::int64_t count, const std::string &name) const
  {
    if (count < 0 || static_cast<double>(count) > most_)
      refuse("the number of " + name + " cannot be " + std::to_string(count) + ": the file is damaged");
    return count;
  }

  void take_nodes()
  {
    num_nodes_ = count(EX_INQ_NODES, "nodes");
    const auto dim = ex_inquire_int(file_, EX_INQ_DIM);
    in_space_ = dim == 3;
    if (dim != 2 && dim != 3) refuse("its nodes must have 2 or 3 coordinates, got " + std::to_string(dim));
    std::vector<std::vector<double>> x(3, std::vector<double>(num_nodes_, 0.));
    if (num_nodes_ > 0)
      check(ex_get_coord(file_, x[0].data(), x[1].data(), dim == 3 ? x[2].data() : nullptr), "the coordinates");
    for (std::int64_t n = 0; n < num_nodes_; ++n) {
      contents_.node_tags.push_back(static_cast<std::size_t>(n + 1));
      for (int d = 0; d < 3; ++d) contents_.coords.push_back(x[d][n]);
    }
  }

  Integers ids(const ex_inquiry what, const ex_entity_type type, const std::string &kind) const
  {
    Integers all(count(what, kind));
    if (!all.empty()) check(ex_get_ids(file_, type, all.data()), "the numbers of " + kind);
    return all;
  }

  /// Its name, "" if it has none.
  std::string name_of(const ex_entity_type type, const std::int64_t id) const
  {
    std::vector<char> name(static_cast<std::size_t>(name_length_) + 1, '\0');
    if (ex_get_name(file_, type, id, name.data()) < 0) return "";
    std::string text(name.data());
    text.erase(text.find_last_not_of(" \t") + 1); // names are filled up with blanks
    return text;
  }

  /// Exodus gives the same name to things that have none: they are named by their numbers.
  int add_group(const int dim, const std::int64_t id, const std::string &name)
  {
    contents_.groups.push_back({dim, static_cast<int>(id), name});
    return static_cast<int>(contents_.groups.size()) - 1;
  }

  void take_blocks()
  {
    std::int64_t first = 0;
    for (const std::int64_t id : ids(EX_INQ_ELEM_BLK, EX_ELEM_BLOCK, "blocks")) {
      std::vector<char> kind(static_cast<std::size_t>(std::max<std::int64_t>(name_length_, MAX_STR_LENGTH)) + 1, '\0');
      std::int64_t width = 0, edges = 0, faces = 0, attributes = 0;
      ExodusBlock block;
      const std::string label = "block " + std::to_string(id);
      check(ex_get_block(file_, EX_ELEM_BLOCK, id, kind.data(), &block.count, &width, &edges, &faces, &attributes),
            label);
      plausible(block.count, "cells of " + label);
      plausible(width, "nodes of a cell of " + label);
      block.first = first;
      first += block.count;
      block.name = name_of(EX_ELEM_BLOCK, id);
      const std::string type(kind.data());
      if (block.count == 0) {
        contents_.notes.push_back(label + (block.name.empty() ? "" : " \"" + block.name + "\"") +
                                  " has no cells: it is left out");
        continue;
      }
      block.type = gmsh_type_of(type, width);
      if (block.type == 0)
        refuse(
            label + " has cells of type \"" + printable(type) + "\" with " + std::to_string(width) +
            " nodes, which are unknown; triangles of 3 or 6 nodes, quadrilaterals of 4, 8 or 9, tetrahedra of 4 or 10, "
            "hexahedra of 8, 20 or 27, wedges of 6, 15 or 18 and pyramids of 5, 13 or 14 can be read");
      block.width = static_cast<int>(width);
      block.faces = is_shell(type) ? 2 : 0;
      block.nodes.resize(plausible(block.count * width, "nodes of the cells of " + label));
      check(ex_get_conn(file_, EX_ELEM_BLOCK, id, block.nodes.data(), nullptr, nullptr), "the cells of " + label);
      for (std::size_t k = 0; k < block.nodes.size(); ++k)
        if (block.nodes[k] < 1 || block.nodes[k] > num_nodes_)
          refuse("cell " + std::to_string(block.first + 1 + static_cast<std::int64_t>(k) / width) + " of " + label +
                 " uses node " + std::to_string(block.nodes[k]) + "; there are 1 to " + std::to_string(num_nodes_));
      contents_.dim = std::max(contents_.dim, gmsh_type(block.type)->dim);
      blocks_.push_back(std::move(block));
      block_ids_.push_back(id);
    }
    for (std::size_t b = 0; b < blocks_.size(); ++b) take_block(blocks_[b], block_ids_[b]);
  }

  /// Whether sides 1 and 2 are the faces: of shells, and of triangles in space.
  bool is_shell(const std::string &type) const
  {
    std::string begin = type.substr(0, 3);
    for (char &c : begin) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return begin == "SHE" || (begin == "TRI" && (in_space_ || type.size() > 7)); // TRISHELL3
  }

  void take_block(const ExodusBlock &block, const std::int64_t id)
  {
    const int dim = gmsh_type(block.type)->dim;
    if (dim > 0 && dim < contents_.dim - 1) {
      contents_.notes.push_back("block " + std::to_string(id) +
                                " has lines, which are no cells of a body in space: it is left out");
      return;
    }
    GmshElements elements;
    elements.group = add_group(dim, id, block.name);
    elements.type = block.type;
    const std::vector<int> places = places_by_gmsh(block.type);
    for (std::int64_t c = 0; c < block.count; ++c) {
      elements.tags.push_back(static_cast<std::size_t>(block.first + c + 1));
      const std::int64_t *const nodes = &block.nodes[static_cast<std::size_t>(c) * block.width];
      if (places.empty())
        elements.nodes.insert(elements.nodes.end(), nodes, nodes + block.width);
      else
        append_in_gmsh_order(places, nodes, block.width, elements.nodes);
    }
    contents_.elements.push_back(std::move(elements));
  }

  void take_side_sets()
  {
    for (const std::int64_t id : ids(EX_INQ_SIDE_SETS, EX_SIDE_SET, "side sets")) {
      const std::string label = "side set " + std::to_string(id);
      std::int64_t size = 0, factors = 0;
      check(ex_get_set_param(file_, EX_SIDE_SET, id, &size, &factors), label);
      Integers cells(plausible(size, "facets of " + label)), sides(cells.size());
      if (size > 0) check(ex_get_set(file_, EX_SIDE_SET, id, cells.data(), sides.data()), label);
      if (std::any_of(blocks_.begin(), blocks_.end(), [](const ExodusBlock &b) { return b.faces > 0; }))
        leave_out_faces(label, cells, sides);
      const int group = add_group(contents_.dim - 1, id, name_of(EX_SIDE_SET, id));
      std::map<int, GmshElements> by_type;
      for (std::size_t f = 0; f < cells.size(); ++f) take_facet(label, cells[f], sides[f], by_type);
      for (auto &[type, elements] : by_type) {
        elements.group = group;
        elements.type = type;
        contents_.elements.push_back(std::move(elements));
      }
    }
  }

  /// The two faces of a shell are no facets of a body.
  void leave_out_faces(const std::string &label, Integers &cells, Integers &sides)
  {
    std::size_t kept = 0;
    for (std::size_t f = 0; f < cells.size(); ++f) {
      const auto of_shell = [&](const ExodusBlock &b) {
        return b.faces >= sides[f] && sides[f] > 0 && cells[f] > b.first && cells[f] <= b.first + b.count;
      };
      if (std::any_of(blocks_.begin(), blocks_.end(), of_shell)) continue;
      cells[kept] = cells[f];
      sides[kept++] = sides[f];
    }
    if (kept < cells.size())
      contents_.notes.push_back(std::to_string(cells.size() - kept) + " entries of " + label +
                                " are faces of shells, which bound no body: they are left out");
    cells.resize(kept);
    sides.resize(kept);
  }

  void take_facet(const std::string &label, const std::int64_t cell, const std::int64_t side,
                  std::map<int, GmshElements> &by_type)
  {
    const auto block = std::find_if(blocks_.begin(), blocks_.end(),
                                    [&](const ExodusBlock &b) { return cell > b.first && cell <= b.first + b.count; });
    if (block == blocks_.end()) refuse(label + " names cell " + std::to_string(cell) + ", which there is not");
    const CellKind *const kind = cell_kind(block->type);
    if (!kind || kind->dim != contents_.dim) return; // cells that are refused later, or are no cells of the body
    const auto element = element_with(block->type);
    const int num_facets = element ? element->num_facets() : static_cast<int>(kind->faces.size());
    const std::int64_t facet_of_cell = side - block->faces;
    if (facet_of_cell < 1 || facet_of_cell > num_facets)
      refuse(label + " names side " + std::to_string(side) + " of cell " + std::to_string(cell) + "; there are " +
             std::to_string(block->faces + 1) + " to " + std::to_string(block->faces + num_facets) +
             (block->faces > 0 ? " beside its faces" : ""));
    const std::int64_t *const of_cell = &block->nodes[static_cast<std::size_t>(cell - 1 - block->first) * block->width];
    const int facet = static_cast<int>(facet_of_cell) - 1;
    if (element)
      add_facet(cell, element->facet(), nodes_at(element->facets()[facet], of_cell, block->width), by_type);
    else
      add_face(cell, *kind, facet, of_cell, block->width, by_type);
  }

  /// Those of a cell's nodes that there are.
  static Integers nodes_at(const std::vector<int> &places, const std::int64_t *const of_cell, const int width)
  {
    Integers nodes;
    for (const int local : places)
      if (local < width) nodes.push_back(of_cell[local]);
    return nodes;
  }

  static void add_facet(const std::int64_t cell, const Element &facet, const Integers &nodes,
                        std::map<int, GmshElements> &by_type)
  {
    constexpr int quadrilateral_8 = 16;
    const int count = static_cast<int>(nodes.size());
    GmshElements &elements = by_type[count == facet.num_nodes() ? facet.gmsh_type() : quadrilateral_8];
    elements.tags.push_back(static_cast<std::size_t>(cell));
    append_in_gmsh_order(facet.gmsh_place(), nodes.data(), count, elements.nodes);
  }

  /// A face of a wedge or pyramid.
  static void add_face(const std::int64_t cell, const CellKind &kind, const int face, const std::int64_t *const of_cell,
                       const int width, std::map<int, GmshElements> &by_type)
  {
    std::vector<std::size_t> in_order;
    append_in_gmsh_order(places_by_gmsh(kind.linear), of_cell, width, in_order);
    const int ordinal = faces_in_order(kind)[face];
    const CellKind &facet = *cell_kind(kind.faces[ordinal].size() == 3 ? 2 : 3);
    std::vector<std::size_t> nodes;
    for (const int local : kind.nodes_of_face(ordinal))
      if (local < width) nodes.push_back(in_order[local]);
    const int count = static_cast<int>(nodes.size());
    const int type = count == facet.num_vertices                 ? facet.linear
                     : count == facet.num_nodes(facet.quadratic) ? facet.quadratic
                                                                 : facet.serendipity;
    GmshElements &elements = by_type[type];
    elements.tags.push_back(static_cast<std::size_t>(cell));
    elements.nodes.insert(elements.nodes.end(), nodes.begin(), nodes.end());
  }

  void take_node_sets()
  {
    constexpr int point = 15; // gmsh's type
    for (const std::int64_t id : ids(EX_INQ_NODE_SETS, EX_NODE_SET, "node sets")) {
      const std::string label = "node set " + std::to_string(id), name = name_of(EX_NODE_SET, id);
      std::int64_t size = 0, factors = 0;
      check(ex_get_set_param(file_, EX_NODE_SET, id, &size, &factors), label);
      Integers nodes(plausible(size, "nodes of " + label));
      if (nodes.empty()) continue; // as sets for numbers of rpc's own are
      check(ex_get_set(file_, EX_NODE_SET, id, nodes.data(), nullptr), label);
      GmshElements elements;
      elements.type = point;
      for (const std::int64_t node : nodes) {
        if (node < 1 || node > num_nodes_)
          refuse(label + " names node " + std::to_string(node) + "; there are 1 to " + std::to_string(num_nodes_));
        elements.tags.push_back(static_cast<std::size_t>(node));
        elements.nodes.push_back(static_cast<std::size_t>(node));
      }
      elements.group = add_group(0, id, name.empty() ? label : name);
      contents_.elements.push_back(std::move(elements));
    }
  }

  static std::string printable(std::string text)
  {
    for (char &c : text)
      if (c < ' ' || c > '~') c = '?';
    return text.substr(0, 40);
  }

  std::string where_;
  int file_ = -1, name_length_ = MAX_STR_LENGTH;
  double most_ = 0; ///< numbers that the file has room for
  std::int64_t num_nodes_ = 0;
  bool in_space_ = false; ///< nodes have three coordinates
  std::vector<ExodusBlock> blocks_;
  Integers block_ids_;
  GmshContents contents_;
};

} // namespace

GmshContents read_exodus_mesh(const std::string &where, const std::string &path)
{
  // HDF5, below NetCDF, breaks down on damaged files, and writes to the console.
  const std::optional<std::string> bytes = in_child_process([&] { return packed(ExodusMesh(where, path).contents()); });
  RPC_REQUIRE_CODE(bytes, ExitCode::bad_mesh,
                   where << "the Exodus library broke down on it, as it does on damaged files or when memory runs out");
  GmshContents contents = unpacked_contents(*bytes);
  contents.kind = {"node set", "side set", contents.dim == 2 ? "block" : "side set", "block"};
  contents.node_sets = true;
  return contents;
}

} // namespace rpc::mesh
