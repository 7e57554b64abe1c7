// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_mending.hpp"

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

// gmsh's numbers of element types.
constexpr int quadrilateral_8 = 16, quadrilateral_9 = 10, hexahedron_20 = 17, hexahedron_27 = 12;

/// Corners of a hexahedron's faces and the middle nodes of their edges, in gmsh's order.
constexpr int faces_of_hexahedron[6][8] = {{0, 3, 2, 1, 9, 13, 11, 8},   {0, 1, 5, 4, 8, 12, 16, 10},
                                           {0, 4, 7, 3, 10, 17, 15, 9},  {1, 2, 6, 5, 11, 14, 18, 12},
                                           {2, 3, 7, 6, 13, 15, 19, 14}, {4, 5, 6, 7, 16, 18, 19, 17}};

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

  std::size_t count() const { return count_; }

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
    ++count_;
    return last_;
  }

  const std::string &where_;
  GmshContents &contents_;
  std::unordered_map<std::size_t, std::size_t> place_; // by tag, of the nodes in the file
  std::map<std::array<std::size_t, 4>, std::size_t> faces_;
  std::size_t last_ = 0, count_ = 0;
};

std::vector<std::size_t> completed_quadrilateral(const std::size_t *const nodes, MiddleNodes &middles)
{
  std::array<std::size_t, 8> face{};
  std::copy_n(nodes, 8, face.begin());
  std::vector<std::size_t> all(nodes, nodes + 8);
  all.push_back(middles.of_face(face));
  return all;
}

std::vector<std::size_t> completed_hexahedron(const std::size_t *const nodes, MiddleNodes &middles)
{
  std::vector<std::size_t> all(nodes, nodes + 20);
  for (const auto &local : faces_of_hexahedron) {
    std::array<std::size_t, 8> face{};
    for (int a = 0; a < 8; ++a) face[a] = nodes[local[a]];
    all.push_back(middles.of_face(face));
  }
  all.push_back(middles.of_hexahedron(nodes));
  return all;
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
  const auto is_incomplete = [](const GmshElements &elements) {
    return elements.type == quadrilateral_8 || elements.type == hexahedron_20;
  };
  std::size_t cells = 0;
  for (const auto &elements : contents.elements)
    if (is_incomplete(elements) && contents.groups[elements.group].dim == contents.dim) cells += elements.tags.size();
  if (cells == 0) return;
  MiddleNodes middles(where, contents);
  contents.last_node = *std::max_element(contents.node_tags.begin(), contents.node_tags.end());
  for (auto &elements : contents.elements) {
    if (!is_incomplete(elements)) continue;
    const bool face = elements.type == quadrilateral_8;
    std::vector<std::size_t> nodes;
    const std::size_t width = face ? 8 : 20;
    for (std::size_t first = 0; first + width <= elements.nodes.size(); first += width) {
      const std::vector<std::size_t> all = face ? completed_quadrilateral(&elements.nodes[first], middles)
                                                : completed_hexahedron(&elements.nodes[first], middles);
      nodes.insert(nodes.end(), all.begin(), all.end());
    }
    elements.nodes = std::move(nodes);
    elements.type = face ? quadrilateral_9 : hexahedron_27;
  }
  contents.notes.push_back(std::to_string(cells) + " serendipity cells, of " +
                           (contents.dim == 2 ? "8 nodes, get a ninth" : "20 nodes, get 7 more") +
                           " where their map has the middle" + (contents.dim == 2 ? "" : "s of faces and cells") +
                           ": they are Q2 cells of the same shape");
}

void turn_mirrored_cells(TaggedMesh &draft)
{
  const Element &element = draft.mesh.element;
  const auto places = mirrored_places(element);
  const auto corners = corners_of(element);
  std::size_t count = 0, first = 0;
  std::vector<int> turned(places.size());
  for (int c = 0; c < draft.mesh.num_cells(); ++c) {
    const auto nodes = draft.mesh.cells.begin() + static_cast<std::ptrdiff_t>(c) * element.num_nodes();
    // Cells that are turned over at some corners only are bent or entangled.
    if (!std::all_of(corners.begin(), corners.end(),
                     [&](const Corner &corner) { return corner_measure(draft, &*nodes, corner) < 0; }))
      continue;
    if (count++ == 0) first = draft.cell_tag[c];
    for (std::size_t a = 0; a < places.size(); ++a) turned[a] = nodes[places[a]];
    std::copy(turned.begin(), turned.end(), nodes);
  }
  if (count == 0) return;
  draft.mesh.notes.push_back("the nodes of " + std::to_string(count) + (count == 1 ? " cell" : " cells") + ", " +
                             (count == 1 ? "" : "the first of them ") + "cell " + std::to_string(first) +
                             ", run the wrong way round: " + (count == 1 ? "it is" : "they are") + " turned");
}

} // namespace rpc::mesh
