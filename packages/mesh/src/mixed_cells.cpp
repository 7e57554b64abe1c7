// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_cells.hpp"

#include "cell_kinds.hpp"
#include "gmsh_types.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace rpc::mesh
{
namespace
{

using Tags = std::vector<std::size_t>;
using Vector = std::array<double, 3>;

/// A cell in a list of elements, and its place there.
struct CellPlace {
  const GmshElements *elements = nullptr;
  std::size_t place = 0;
};

std::string label_of(const GmshContents &contents, const CellPlace &cell)
{
  return cell_kind(cell.elements->type)->noun + " " + std::to_string(cell.elements->tags[cell.place]) + " of \"" +
         contents.groups[cell.elements->group].name + "\"";
}

bool of_body(const GmshContents &contents, const GmshElements &elements)
{
  return contents.groups[elements.group].dim == contents.dim;
}

/// Coordinates of nodes by their tags.
class NodePlaces
{
public:
  NodePlaces(const std::string &where, const GmshContents &contents) : where_(where), coords_(contents.coords)
  {
    for (std::size_t n = 0; n < contents.node_tags.size(); ++n) places_.emplace_back(contents.node_tags[n], n);
    if (!std::is_sorted(places_.begin(), places_.end())) std::sort(places_.begin(), places_.end());
  }
  Vector at(const std::size_t tag) const
  {
    const auto place = std::lower_bound(places_.begin(), places_.end(), std::pair<std::size_t, std::size_t>{tag, 0});
    RPC_REQUIRE_CODE(place != places_.end() && place->first == tag, ExitCode::bad_mesh,
                     where_ << "cells use node " << tag << ", which the file lacks");
    const double *const x = &coords_[3 * place->second];
    return {x[0], x[1], x[2]};
  }

private:
  const std::string &where_;
  const std::vector<double> &coords_;
  std::vector<std::pair<std::size_t, std::size_t>> places_; // tag, index
};

Vector arm(const Vector &from, const Vector &to)
{
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

double squared(const Vector &a)
{
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

/// Twice a triangle's area, or six times a tetrahedron's volume, with its sign.
double measure(const std::vector<Vector> &x)
{
  const Vector a = arm(x[0], x[1]), b = arm(x[0], x[2]);
  const Vector normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  if (x.size() == 3) return normal[2];
  const Vector c = arm(x[0], x[3]);
  return normal[0] * c[0] + normal[1] * c[1] + normal[2] * c[2];
}

/// Local vertices of the simplices that a cell, or a quadrilateral of a side, is divided into.
using Parts = std::vector<std::vector<int>>;

/// The triangles on either side of a quadrilateral's diagonal at its vertex `from`.
Parts halves_at(const std::vector<int> &around, const std::size_t from)
{
  const auto vertex = [&](const std::size_t steps) { return around[(from + steps) % 4]; };
  return {{vertex(0), vertex(1), vertex(2)}, {vertex(0), vertex(2), vertex(3)}};
}

/// Those of a face, cut at its vertex with the smallest tag.
Parts triangles_of(const std::vector<int> &around, const std::size_t *const tags)
{
  if (around.size() == 3) return {around};
  const auto less = [&](const int a, const int b) { return tags[a] < tags[b]; };
  return halves_at(around, std::min_element(around.begin(), around.end(), less) - around.begin());
}

/// A cell in space is the union of what lies between its vertex with the smallest tag and the faces without that vertex.
Parts tetrahedra_of(const CellKind &kind, const std::size_t *const tags)
{
  const int apex = static_cast<int>(std::min_element(tags, tags + kind.num_vertices) - tags);
  Parts parts;
  for (const auto &face : kind.faces) {
    if (std::find(face.begin(), face.end(), apex) != face.end()) continue;
    for (const auto &triangle : triangles_of(face, tags))
      parts.push_back({triangle[0], triangle[2], triangle[1], apex});
  }
  return parts;
}

Parts triangles_by_length(const std::size_t *const tags, const NodePlaces &places)
{
  const auto diagonal = [&](const int a, const int b) { return squared(arm(places.at(tags[a]), places.at(tags[b]))); };
  const double one = diagonal(0, 2), other = diagonal(1, 3);
  constexpr double tie = 1e-9; // diagonals that differ by rounding are as long
  const std::vector<int> around{0, 1, 2, 3};
  if (one < (1 - tie) * other) return halves_at(around, 0);
  if (other < (1 - tie) * one) return halves_at(around, 1);
  return triangles_of(around, tags);
}

/// Nodes of a simplex in gmsh's order, by those of the cell.
Tags nodes_of(const CellKind &cell, const CellKind &simplex, const std::vector<int> &part,
              const std::size_t *const nodes, const bool quadratic)
{
  Tags all;
  for (const int vertex : part) all.push_back(nodes[vertex]);
  for (const auto &edge : quadratic ? simplex.edges : decltype(simplex.edges){})
    all.push_back(nodes[cell.middle(part[edge[0]], part[edge[1]])]);
  return all;
}

/// What is wrong with two cells at a quadrilateral face.
class FaceChecks
{
public:
  FaceChecks(const std::string &where, const GmshContents &contents) : where_(where), contents_(contents) {}

  void add(const CellPlace &cell, const CellKind &kind, const std::size_t *const tags)
  {
    for (const auto &face : kind.faces) {
      std::array<std::size_t, 4> around{};
      for (std::size_t v = 0; v < face.size(); ++v) around[v] = tags[face[v]];
      const auto end = around.begin() + static_cast<std::ptrdiff_t>(face.size());
      std::rotate(around.begin(), std::min_element(around.begin(), end), end);
      const std::size_t opposite = around[2];
      std::sort(around.begin(), end);
      if (face.size() == 3)
        triangles_.push_back({around[0], around[1], around[2]});
      else
        quadrilaterals_.push_back({around, opposite, cell});
    }
  }

  void check()
  {
    std::sort(triangles_.begin(), triangles_.end());
    std::sort(quadrilaterals_.begin(), quadrilaterals_.end(),
              [](const Face &a, const Face &b) { return a.sorted < b.sorted; });
    for (std::size_t f = 0; f < quadrilaterals_.size(); ++f) {
      const Face &face = quadrilaterals_[f];
      const bool met = f + 1 < quadrilaterals_.size() && quadrilaterals_[f + 1].sorted == face.sorted;
      RPC_REQUIRE_CODE(!met || quadrilaterals_[f + 1].opposite == face.opposite, ExitCode::bad_mesh,
                       where_ << label_of(contents_, face.cell) << " and "
                              << label_of(contents_, quadrilaterals_[f + 1].cell) << " go in different orders around "
                              << text_of(face));
      if (!met) check_triangles_at(face);
    }
  }

private:
  struct Face {
    std::array<std::size_t, 4> sorted; ///< tags of the vertices
    std::size_t opposite;              ///< the vertex across from the smallest
    CellPlace cell;
  };

  static std::string text_of(const Face &face)
  {
    const auto &v = face.sorted;
    return "the face with the nodes " + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " +
           std::to_string(v[2]) + " and " + std::to_string(v[3]);
  }

  /// Faces of tetrahedra on the other side that are halves along the other diagonal would leave a gap.
  void check_triangles_at(const Face &face)
  {
    const auto &v = face.sorted;
    for (const std::size_t other : {v[0], face.opposite}) {
      std::array<std::size_t, 3> half{};
      std::copy_if(v.begin(), v.end(), half.begin(), [&](const std::size_t vertex) { return vertex != other; });
      RPC_REQUIRE_CODE(!std::binary_search(triangles_.begin(), triangles_.end(), half), ExitCode::bad_mesh,
                       where_ << text_of(face) << " of " << label_of(contents_, face.cell)
                              << " meets triangles on its other side, one of the nodes " << half[0] << ", " << half[1]
                              << " and " << half[2]
                              << ", along the diagonal by which it is not cut; put pyramids between quadrilateral "
                                 "faces and tetrahedra, as meshers do for conforming meshes");
    }
  }

  const std::string &where_;
  const GmshContents &contents_;
  std::vector<std::array<std::size_t, 3>> triangles_; // sorted tags
  std::vector<Face> quadrilaterals_;
};

class Divider
{
public:
  Divider(const std::string &where, GmshContents &contents, const bool made)
      : where_(where), contents_(contents), made_(made)
  {
  }

  void divide()
  {
    {
      const NodePlaces places(where_, contents_);
      if (contents_.dim == 3) check_faces();
      for (GmshElements &elements : contents_.elements)
        if (of_body(contents_, elements)) divide_cells(elements, places);
    }
    if (contents_.dim == 3) {
      for (GmshElements &elements : contents_.elements)
        if (!of_body(contents_, elements)) divide_facets(elements.type, elements.nodes, &elements.tags);
      for (GmshBoundary &boundary : contents_.boundary) divide_facets(boundary.type, boundary.nodes, nullptr);
    }
    add_notes();
  }

private:
  void check_faces() const
  {
    FaceChecks checks(where_, contents_);
    for (const GmshElements &elements : contents_.elements) {
      if (!of_body(contents_, elements)) continue;
      const CellKind &kind = *cell_kind(elements.type);
      const std::size_t width = kind.num_nodes(elements.type);
      for (std::size_t c = 0; c < elements.tags.size(); ++c) {
        const std::size_t *const own = &elements.nodes[width * c];
        for (int v = 1; v < kind.num_vertices; ++v)
          RPC_REQUIRE_CODE(
              std::find(own, own + v, own[v]) == own + v, ExitCode::bad_mesh,
              where_ << label_of(contents_, {&elements, c}) << " has node " << own[v]
                     << " twice; write a cell whose nodes fall together as a wedge, pyramid or tetrahedron");
        checks.add({&elements, c}, kind, own);
      }
    }
    checks.check();
  }

  void divide_cells(GmshElements &elements, const NodePlaces &places)
  {
    const CellKind &kind = *cell_kind(elements.type);
    if (kind.simplex()) return;
    const bool quadratic = elements.type == kind.quadratic;
    const CellKind &simplex = *cell_kind(contents_.dim == 2 ? 2 : 4);
    const std::size_t width = kind.num_nodes(elements.type);
    Tags tags, nodes;
    for (std::size_t c = 0; c < elements.tags.size(); ++c) {
      const std::size_t *const own = &elements.nodes[width * c];
      const Parts parts = contents_.dim == 2 ? triangles_by_length(own, places) : tetrahedra_of(kind, own);
      check_signs({&elements, c}, parts, own, places);
      for (const auto &part : parts) {
        tags.push_back(elements.tags[c]);
        const Tags of_part = nodes_of(kind, simplex, part, own, quadratic);
        nodes.insert(nodes.end(), of_part.begin(), of_part.end());
      }
      num_simplices_ += parts.size();
    }
    divided_[kind.plural] += elements.tags.size();
    first_.emplace(kind.plural, kind.noun);
    elements.type = quadratic ? simplex.quadratic : simplex.linear;
    elements.tags = std::move(tags);
    elements.nodes = std::move(nodes);
  }

  /// Cells that are mirrored as a whole are turned later.
  void check_signs(const CellPlace &cell, const Parts &parts, const std::size_t *const own,
                   const NodePlaces &places) const
  {
    bool positive = false, negative = false;
    for (const auto &part : parts) {
      std::vector<Vector> x;
      for (const int vertex : part) x.push_back(places.at(own[vertex]));
      const double value = measure(x);
      positive = positive || value > 0;
      negative = negative || value < 0;
    }
    RPC_REQUIRE_CODE(
        !positive || !negative, ExitCode::bad_mesh,
        where_ << label_of(contents_, cell) << ", with node " << own[0] << ", is bent so far that some of the "
               << (contents_.dim == 2 ? "triangles" : "tetrahedra")
               << " that it is divided into are turned over, or its nodes are not in the order of its kind; make "
                  "smaller or better shaped cells there, or a mesh of tetrahedra alone");
  }

  /// Quadrilaterals of sides, or of the geometry's surfaces.
  /// @param[in,out] own_tags  null: they have none
  static void divide_facets(int &type, Tags &own_nodes, Tags *const own_tags)
  {
    const CellKind *const kind = cell_kind(type);
    if (!kind || kind->dim != 2 || kind->simplex() || type == kind->serendipity) return;
    const bool quadratic = type == kind->quadratic;
    const CellKind &triangle = *cell_kind(2);
    const std::size_t width = kind->num_nodes(type);
    Tags tags, nodes;
    for (std::size_t f = 0; f < own_nodes.size() / width; ++f) {
      const std::size_t *const own = &own_nodes[width * f];
      for (const auto &part : triangles_of({0, 1, 2, 3}, own)) {
        if (own_tags) tags.push_back((*own_tags)[f]);
        const Tags of_part = nodes_of(*kind, triangle, part, own, quadratic);
        nodes.insert(nodes.end(), of_part.begin(), of_part.end());
      }
    }
    type = quadratic ? triangle.quadratic : triangle.linear;
    own_nodes = std::move(nodes);
    if (own_tags) *own_tags = std::move(tags);
  }

  void add_notes()
  {
    std::string text;
    std::size_t listed = 0;
    for (const auto &[plural, count] : divided_) {
      const bool last = ++listed == divided_.size();
      text += listed == 1 ? "" : last ? " and " : ", ";
      text += std::to_string(count) + " " + (count == 1 ? first_.at(plural) : plural);
    }
    const bool one = divided_.size() == 1 && divided_.begin()->second == 1;
    contents_.notes.push_back(
        text + (one ? " is" : " are") + " divided into " + std::to_string(num_simplices_) +
        (contents_.dim == 2 ? " triangles" : " tetrahedra") + " along diagonals: all cells of a mesh are of one kind" +
        (made_ && contents_.dim == 2 ? "; Mesh.SubdivisionAlgorithm = 1; in the .geo makes quadrilaterals alone" : ""));
  }

  const std::string &where_;
  GmshContents &contents_;
  bool made_;
  std::map<std::string, std::size_t> divided_; // cells by what they are called
  std::map<std::string, std::string> first_;   // what one of them is called
  std::size_t num_simplices_ = 0;
};

} // namespace

void divide_mixed_cells(const std::string &where, GmshContents &contents, const bool made)
{
  std::set<int> types;
  for (const GmshElements &elements : contents.elements)
    if (of_body(contents, elements)) types.insert(elements.type);
  bool needed = types.size() > 1;
  std::set<bool> quadratic;
  for (const int type : types) {
    const CellKind *const kind = cell_kind(type);
    if (!kind || kind->dim != contents.dim || type == kind->serendipity) return; // refused later
    needed = needed || kind->num_vertices == 5 || kind->num_vertices == 6;
    quadratic.insert(type == kind->quadratic);
  }
  if (needed && quadratic.size() == 1) Divider(where, contents, made).divide();
}

} // namespace rpc::mesh
