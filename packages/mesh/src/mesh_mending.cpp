// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_mending.hpp"

#include "cell_kinds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace rpc::mesh
{
namespace
{

/// Nodes in the middle of faces and cells.
class MiddleNodes
{
public:
  MiddleNodes(const std::string &where, GmshContents &contents) : where_(where), contents_(contents)
  {
    for (std::size_t n = 0; n < contents.node_tags.size(); ++n) {
      place_.emplace(contents.node_tags[n], n);
      last_ = std::max(last_, contents.node_tags[n]);
    }
  }

  /// That of a face, once for all cells around it. @param nodes  4 corners, then the middle nodes of 4 edges
  std::size_t of_face(const std::array<std::size_t, 8> &nodes)
  {
    std::array<std::size_t, 4> corners{nodes[0], nodes[1], nodes[2], nodes[3]};
    std::sort(corners.begin(), corners.end());
    const auto [at, fresh] = faces_.insert({corners, 0});
    if (fresh) at->second = add(nodes.data(), 4, 4, 0.5);
    return at->second;
  }
  std::size_t of_hexahedron(const std::size_t *const nodes) { return add(nodes, 8, 12, 0.25); }
  /// A face that has its middle node.
  void know(std::array<std::size_t, 4> corners, const std::size_t middle)
  {
    std::sort(corners.begin(), corners.end());
    faces_.insert({corners, middle});
  }

private:
  /// Where the serendipity map has the middle: -1/4 for corners, `weight` for middle nodes of edges.
  std::size_t add(const std::size_t *const nodes, const int num_corners, const int num_edges, const double weight)
  {
    double x[3] = {};
    for (int a = 0; a < num_corners + num_edges; ++a) {
      const auto place = place_.find(nodes[a]);
      RPC_REQUIRE_CODE(place != place_.end(), ExitCode::bad_mesh,
                       where_ << "cells use node " << nodes[a] << ", which the file lacks");
      for (int d = 0; d < 3; ++d) x[d] += (a < num_corners ? -0.25 : weight) * contents_.coords[3 * place->second + d];
    }
    contents_.coords.insert(contents_.coords.end(), x, x + 3);
    contents_.node_tags.push_back(++last_);
    return last_;
  }

  const std::string &where_;
  GmshContents &contents_;
  std::unordered_map<std::size_t, std::size_t> place_; // by tag, of the nodes in the file
  std::map<std::array<std::size_t, 4>, std::size_t> faces_;
  std::size_t last_ = 0;
};

/// Local nodes of the quadrilaterals of a kind of cells, of which a plane one is the only one itself: corners, middles of edges, middle.
std::vector<std::vector<int>> quadrilaterals_of(const CellKind &kind)
{
  if (kind.dim == 2) return {{0, 1, 2, 3, 4, 5, 6, 7, 8}};
  std::vector<std::vector<int>> all;
  for (int f = 0; f < static_cast<int>(kind.faces.size()); ++f)
    if (kind.faces[f].size() == 4) all.push_back(kind.nodes_of_face(f));
  return all;
}

bool is_incomplete(const GmshElements &elements)
{
  const CellKind *const kind = cell_kind(elements.type);
  return kind && elements.type == kind->serendipity;
}

/// Faces of the cells that have all nodes, which may lie beside others.
void know_faces(const GmshContents &contents, MiddleNodes &middles)
{
  for (const GmshElements &elements : contents.elements) {
    const CellKind *const kind = cell_kind(elements.type);
    if (!kind || kind->simplex() || elements.type != kind->quadratic) continue;
    const std::size_t width = kind->num_nodes(elements.type);
    const auto faces = quadrilaterals_of(*kind);
    for (std::size_t first = 0; first < elements.nodes.size(); first += width)
      for (const auto &face : faces) {
        const auto node = [&](const int a) { return elements.nodes[first + face[a]]; };
        middles.know({node(0), node(1), node(2), node(3)}, node(8));
      }
  }
}

void complete(GmshElements &elements, MiddleNodes &middles)
{
  const CellKind &kind = *cell_kind(elements.type);
  const auto faces = quadrilaterals_of(kind);
  const std::size_t width = kind.num_nodes(kind.serendipity);
  std::vector<std::size_t> all;
  for (std::size_t first = 0; first < elements.nodes.size(); first += width) {
    const std::size_t *const nodes = &elements.nodes[first];
    all.insert(all.end(), nodes, nodes + width);
    for (const auto &local : faces) {
      std::array<std::size_t, 8> face{};
      for (int a = 0; a < 8; ++a) face[a] = nodes[local[a]];
      all.push_back(middles.of_face(face));
    }
    if (kind.num_vertices == 8) all.push_back(middles.of_hexahedron(nodes));
  }
  elements.nodes = std::move(all);
  elements.type = kind.quadratic;
}

/// "3 serendipity cells, of 20 nodes, get 7 more where their map has the middles of faces and cells".
std::string note_on_complete(const CellKind &kind, const std::size_t cells)
{
  const int nodes = kind.num_nodes(kind.serendipity), more = kind.num_nodes(kind.quadratic) - nodes;
  return std::to_string(cells) + " serendipity cells, of " + std::to_string(nodes) + " nodes, get " +
         (more == 1 ? "another" : std::to_string(more) + " more") + " where their map has the middle" +
         (kind.num_vertices == 8   ? "s of faces and cells: they are Q2 cells of the same shape"
          : kind.num_vertices == 4 ? ": they are Q2 cells of the same shape"
          : more == 1              ? " of their base"
                                   : "s of faces");
}

/// A corner of the reference cell, and the corners beside it in each direction; -1 where the arm runs against the direction.
struct Corner {
  int node = 0;
  std::array<int, 3> neighbour{}, sign{};
};

std::vector<Corner> corners_of(const Element &element)
{
  const auto &lattice = element.lattice();
  std::vector<Corner> corners(element.shape == Shape::simplex ? 1 : element.num_vertices());
  for (std::size_t c = 0; c < corners.size(); ++c) {
    corners[c].node = static_cast<int>(c);
    for (int along = 0; along < element.dim; ++along) {
      std::vector<int> place = lattice[c];
      corners[c].sign[along] = place[along] == 0 ? 1 : -1;
      place[along] = place[along] == 0 ? element.order : 0;
      corners[c].neighbour[along] =
          static_cast<int>(std::find(lattice.begin(), lattice.end(), place) - lattice.begin());
    }
  }
  return corners;
}

/// Area or volume that the arms at a corner of a cell span, > 0 if they are in the order of the element.
double corner_measure(const TaggedMesh &draft, const int *const nodes, const Corner &corner)
{
  const int dim = draft.mesh.element.dim;
  const auto &x = draft.mesh.coords;
  double arm[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}};
  for (int along = 0; along < dim; ++along)
    for (int d = 0; d < dim; ++d)
      arm[along][d] = corner.sign[along] * (x[static_cast<std::size_t>(dim) * nodes[corner.neighbour[along]] + d] -
                                            x[static_cast<std::size_t>(dim) * nodes[corner.node] + d]);
  return arm[0][0] * (arm[1][1] * arm[2][2] - arm[1][2] * arm[2][1]) +
         arm[0][1] * (arm[1][2] * arm[2][0] - arm[1][0] * arm[2][2]) +
         arm[0][2] * (arm[1][0] * arm[2][1] - arm[1][1] * arm[2][0]);
}

/// Places of a cell's nodes in the mirrored cell: the first two directions change places.
std::vector<int> mirrored_places(const Element &element)
{
  const auto &lattice = element.lattice();
  std::vector<int> places;
  for (std::vector<int> at : lattice) {
    std::swap(at[0], at[1]);
    places.push_back(static_cast<int>(std::find(lattice.begin(), lattice.end(), at) - lattice.begin()));
  }
  return places;
}

} // namespace

void complete_serendipity(const std::string &where, GmshContents &contents)
{
  std::map<int, std::size_t> cells; // by gmsh's type
  for (const auto &elements : contents.elements)
    if (is_incomplete(elements) && contents.groups[elements.group].dim == contents.dim)
      cells[elements.type] += elements.tags.size();
  if (cells.empty()) return;
  MiddleNodes middles(where, contents);
  contents.last_node = *std::max_element(contents.node_tags.begin(), contents.node_tags.end());
  know_faces(contents, middles);
  for (auto &elements : contents.elements)
    if (is_incomplete(elements)) complete(elements, middles);
  for (const auto &[type, count] : cells) contents.notes.push_back(note_on_complete(*cell_kind(type), count));
}

void turn_mirrored_cells(TaggedMesh &draft)
{
  const Element &element = draft.mesh.element;
  const auto places = mirrored_places(element);
  const auto corners = corners_of(element);
  std::size_t count = 0, first = 0, last = 0;
  std::vector<int> turned(places.size());
  for (int c = 0; c < draft.mesh.num_cells(); ++c) {
    const auto nodes = draft.mesh.cells.begin() + static_cast<std::ptrdiff_t>(c) * element.num_nodes();
    // Cells that are turned over at some corners only are bent or entangled.
    if (!std::all_of(corners.begin(), corners.end(),
                     [&](const Corner &corner) { return corner_measure(draft, &*nodes, corner) < 0; }))
      continue;
    if (count == 0) first = draft.cell_tag[c];
    if (count == 0 || draft.cell_tag[c] != last) ++count; // parts of one cell of the file follow each other
    last = draft.cell_tag[c];
    for (std::size_t a = 0; a < places.size(); ++a) turned[a] = nodes[places[a]];
    std::copy(turned.begin(), turned.end(), nodes);
  }
  if (count == 0) return;
  draft.mesh.notes.push_back("the nodes of " + std::to_string(count) + (count == 1 ? " cell" : " cells") + ", " +
                             (count == 1 ? "" : "the first of them ") + "cell " + std::to_string(first) +
                             ", run the wrong way round: " + (count == 1 ? "it is" : "they are") + " turned");
}

} // namespace rpc::mesh
