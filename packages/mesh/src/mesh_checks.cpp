// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_checks.hpp"

#include "rpc/core/error.hpp"
#include "rpc/mesh/quadrature.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

namespace rpc::mesh
{
namespace
{

using Point = std::array<double, 3>; // z is 0 in the plane

Point point_of(const TaggedMesh &draft, const int node)
{
  const std::size_t dim = draft.mesh.element.dim;
  const double *const x = &draft.mesh.coords[dim * node];
  return {x[0], x[1], dim == 3 ? x[2] : 0};
}

double distance(const Point &a, const Point &b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

const int *nodes_of(const TaggedMesh &draft, const int cell)
{
  return &draft.mesh.cells[static_cast<std::size_t>(cell) * draft.mesh.element.num_nodes()];
}

std::string label_of_node(const TaggedMesh &draft, const int node)
{
  const Point x = point_of(draft, node);
  std::ostringstream text;
  text << "node " << draft.node_tag[node] << " at (" << x[0] << ", " << x[1];
  if (draft.mesh.element.dim == 3)
    text << ", " << x[2];
  else if (draft.z[node] != 0)
    text << ", " << draft.z[node];
  text << ")";
  return text.str();
}

std::string label_of_cell(const TaggedMesh &draft, const int cell)
{
  return "cell " + std::to_string(draft.cell_tag[cell]) + " of \"" + draft.mesh.blocks[draft.mesh.block[cell]] + "\"";
}

/// "the edge between ..." or "the face with ...", by its vertices.
std::string label_of_entity(const TaggedMesh &draft, const Entities &entities, const int entity)
{
  const int count = entities.num_vertices;
  std::string text = count == 2 ? "the edge between " : "the face with ";
  for (int v = 0; v < count; ++v) {
    if (v > 0) text += v + 1 < count ? ", " : " and ";
    text += label_of_node(draft, entities.vertices[static_cast<std::size_t>(count) * entity + v]);
  }
  return text;
}

/// Lower and upper corner of the box around nodes.
std::array<Point, 2> bounds(const TaggedMesh &draft, const int *const nodes, const int count)
{
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::array<Point, 2> box{{{inf, inf, inf}, {-inf, -inf, -inf}}};
  for (int n = 0; n < count; ++n) {
    const Point x = point_of(draft, nodes ? nodes[n] : n);
    for (int d = 0; d < 3; ++d) {
      box[0][d] = std::min(box[0][d], x[d]);
      box[1][d] = std::max(box[1][d], x[d]);
    }
  }
  return box;
}

/// Nodes are sorted into cubes as wide as the tolerance: only those in adjacent ones can be too close.
void check_distinct(const TaggedMesh &draft, const std::array<Point, 2> &box)
{
  const double tolerance = 1e-12 * distance(box[0], box[1]);
  using Place = std::array<std::int64_t, 3>; // z, x, y: in the plane the first is 0
  std::vector<std::pair<Place, int>> cubes;  // place, node
  cubes.reserve(draft.mesh.num_nodes());
  for (int n = 0; n < draft.mesh.num_nodes(); ++n) {
    const Point x = point_of(draft, n);
    const auto along = [&](const int d) { return static_cast<std::int64_t>((x[d] - box[0][d]) / tolerance); };
    cubes.push_back({{along(2), along(0), along(1)}, n});
  }
  std::sort(cubes.begin(), cubes.end());
  const auto compare = [&](const int node, const int near) {
    RPC_REQUIRE_CODE(
        near == node || distance(point_of(draft, node), point_of(draft, near)) > tolerance, ExitCode::bad_mesh,
        draft.where << label_of_node(draft, std::min(node, near)) << " and node "
                    << draft.node_tag[std::max(node, near)]
                    << " are at one place; join the parts (in gmsh BooleanFragments, or Coherence Mesh;, in "
                       "Cubit imprint and merge, in Salome Merge Nodes)");
  };
  const auto search = [&](const std::int64_t dz, const std::int64_t dx) {
    auto first = cubes.begin(); // of the column beside a node's own: both run upwards
    for (const auto &[place, node] : cubes) {
      const Place low{place[0] + dz, place[1] + dx, place[2] - 1}, high{low[0], low[1], place[2] + 1};
      while (first != cubes.end() && first->first < low) ++first;
      for (auto near = first; near != cubes.end() && near->first <= high; ++near) compare(node, near->second);
    }
  };
  search(0, 0); // the other half of the columns around a node find it
  search(0, 1);
  if (draft.mesh.element.dim == 3)
    for (const std::int64_t dx : {-1, 0, 1}) search(1, dx);
}

template <int Dim, int Nodes>
using Gradients = std::array<std::array<double, Dim>, Nodes>; // of the shape functions, at one point

/// The gradients at the nodes, and with order 2 at the quadrature points of the stiffness. Those of tensor products are
/// by coordinates of [0, 1]^dim, in which the Jacobian determinant of a parallelepiped is its volume.
template <int Dim, int Nodes>
std::vector<Gradients<Dim, Nodes>> gradients_where_checked(const ShapeFunctions<Dim, Nodes> &functions)
{
  using Functions = ShapeFunctions<Dim, Nodes>;
  const Element element = StaticElement<Dim, Nodes>::element();
  std::vector<Gradients<Dim, Nodes>> result;
  const auto add = [&](const double(&X)[Dim]) {
    double N[Nodes], dN[Nodes][Dim];
    functions.evaluate(X, N, dN);
    Gradients<Dim, Nodes> gradients;
    for (int a = 0; a < Nodes; ++a)
      for (int d = 0; d < Dim; ++d) gradients[a][d] = (Functions::simplex ? 1 : 2) * dN[a][d];
    result.push_back(gradients);
  };
  for (int a = 0; a < Nodes; ++a) {
    double X[Dim];
    functions.node(a, X);
    add(X);
  }
  if (element.order == 1) return result;
  for (const auto &point : quadrature(Dim, element.shape, stiffness_degree(element)).point) {
    double X[Dim];
    std::copy_n(point.begin(), Dim, X);
    add(X);
  }
  return result;
}

/// Determinant of the Jacobian.
template <int Dim, int Nodes>
double jacobian(const double (&x)[Nodes][Dim], const Gradients<Dim, Nodes> &gradient)
{
  double J[Dim][Dim] = {};
  for (int a = 0; a < Nodes; ++a)
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) J[i][j] += x[a][i] * gradient[a][j];
  if constexpr (Dim == 2)
    return J[0][0] * J[1][1] - J[0][1] * J[1][0];
  else
    return J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) + J[0][1] * (J[1][2] * J[2][0] - J[1][0] * J[2][2]) +
           J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
}

/// Area or volume between the facets of a cell's vertices, > 0 if they are in the order of the element: quadrilateral
/// faces are two triangles.
double signed_measure(const TaggedMesh &draft, const int *const nodes)
{
  const Element &element = draft.mesh.element;
  const Point origin = point_of(draft, nodes[0]);
  const auto arm = [&](const int node) {
    const Point x = point_of(draft, nodes[node]);
    return Point{x[0] - origin[0], x[1] - origin[1], x[2] - origin[2]};
  };
  double sum = 0;
  for (const auto &facet : element.facets()) {
    const Point a = arm(facet[0]);
    if (element.dim == 2) {
      const Point b = arm(facet[1]);
      sum += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    for (int v = 1; element.dim == 3 && v + 1 < element.facet().num_vertices(); ++v) {
      const Point b = arm(facet[v]), c = arm(facet[v + 1]);
      sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
              a[2] * (b[0] * c[1] - b[1] * c[0])) /
             6;
    }
  }
  return sum;
}

/// @param least  measure of a cell that is not degenerate
[[noreturn]] void refuse_cell(const TaggedMesh &draft, const int cell, const double least)
{
  const Element &element = draft.mesh.element;
  const bool plane = element.dim == 2;
  const double measure = signed_measure(draft, nodes_of(draft, cell));
  std::ostringstream text;
  text << draft.where << label_of_cell(draft, cell) << ", with " << label_of_node(draft, nodes_of(draft, cell)[0])
       << ", is ";
  if (std::abs(measure) <= least)
    text << "degenerate: its " << (plane ? "area" : "volume") << " is " << measure;
  else if (measure < 0 && plane)
    text << "inverted: its vertices run clockwise; reverse the curve loop of its surface";
  else if (measure < 0)
    text << "inverted: its volume is " << measure << "; its nodes must be in gmsh's order";
  else if (element.order == 2)
    throw BentCell(ExitCode::bad_mesh,
                   text.str() + "inverted: its curved edges bend too far; make smaller cells there");
  else
    text << "inverted: an angle between its edges" << (plane ? "" : " or faces") << " is 180 degrees or more";
  throw Error(ExitCode::bad_mesh, text.str());
}

/// How a cell's list of a facet's vertices runs.
struct Course {
  bool upward = false; ///< from the lowest number to the lower one of those beside it; cells on either side disagree
  int opposite = -1;   ///< the vertex across from the lowest; -1 if there is none
};

Course course_of(const TaggedMesh &draft, const Entities &facets, const int facet, const int k)
{
  const std::vector<int> &local = draft.mesh.element.facets()[facets.ordinal(facet, k)];
  const int *const nodes = nodes_of(draft, facets.cell(facet, k));
  const int count = facets.num_vertices;
  if (count == 3) { // upward: an even permutation of the ascending order
    const int a = nodes[local[0]], b = nodes[local[1]], c = nodes[local[2]];
    return {((a < b) == (b < c)) == (a < c), -1};
  }
  int lowest = 0;
  for (int v = 1; v < count; ++v)
    if (nodes[local[v]] < nodes[local[lowest]]) lowest = v;
  const auto node = [&](const int steps) { return nodes[local[(lowest + steps) % count]]; };
  if (count == 2) return {lowest == 0, -1};
  return {node(1) < node(count - 1), count == 4 ? node(2) : -1};
}

/// All cells around an edge or face have one middle node there.
/// @param local  nodes of each entity of a cell, the middle one last
void check_middle_nodes(const TaggedMesh &draft, const Entities &entities, const Element::Table &local)
{
  for (int e = 0; e < entities.size(); ++e)
    for (int k = 1; k < entities.num_cells_at(e); ++k) {
      const auto middle = [&](const int at) {
        return nodes_of(draft, entities.cell(e, at))[local[entities.ordinal(e, at)].back()];
      };
      RPC_REQUIRE_CODE(middle(k) == middle(k - 1), ExitCode::bad_mesh,
                       draft.where << label_of_cell(draft, entities.cell(e, k - 1)) << " and "
                                   << label_of_cell(draft, entities.cell(e, k)) << " have different middle nodes on "
                                   << label_of_entity(draft, entities, e));
    }
}

} // namespace

int find_node(const TaggedMesh &draft, const std::size_t tag)
{
  if (!draft.node_of_tag.empty()) return tag < draft.node_of_tag.size() ? draft.node_of_tag[tag] : -1;
  const auto it = std::lower_bound(draft.node_tag.begin(), draft.node_tag.end(), tag);
  return it == draft.node_tag.end() || *it != tag ? -1 : static_cast<int>(it - draft.node_tag.begin());
}

void check_nodes(const TaggedMesh &draft)
{
  for (int n = 0; n < draft.mesh.num_nodes(); ++n) {
    const Point x = point_of(draft, n);
    RPC_REQUIRE_CODE(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]) &&
                         (draft.z.empty() || std::isfinite(draft.z[n])),
                     ExitCode::bad_mesh, draft.where << label_of_node(draft, n) << ": coordinates must be finite");
  }
  const std::array<Point, 2> box = bounds(draft, nullptr, draft.mesh.num_nodes());
  const double size = distance(box[0], box[1]);
  RPC_REQUIRE_CODE(size >= least_size && size <= greatest_size, ExitCode::bad_mesh,
                   draft.where << "the body's size must be " << least_size << " to " << greatest_size << " [m], got "
                               << size);
  for (std::size_t n = 0; n < draft.z.size(); ++n)
    RPC_REQUIRE_CODE(
        std::abs(draft.z[n]) <= 1e-10 * size, ExitCode::bad_mesh,
        draft.where << label_of_node(draft, static_cast<int>(n))
                    << " is off the plane; z must be 0, or in a mesh the same everywhere. Triangles and "
                       "quadrilaterals in space are a shell or a skin: a body there has tetrahedra or hexahedra");
  check_distinct(draft, box);
}

void check_cells(const TaggedMesh &draft)
{
  with_static_extents(draft.mesh.element, [&](const auto static_dim, const auto static_nodes) {
    constexpr int dim = static_dim, num_nodes = static_nodes;
    const auto where = gradients_where_checked(ShapeFunctions<dim, num_nodes>());
    for (int c = 0; c < draft.mesh.num_cells(); ++c) {
      const int *const nodes = nodes_of(draft, c);
      double x[num_nodes][dim];
      for (int a = 0; a < num_nodes; ++a) {
        RPC_REQUIRE_CODE(std::find(nodes, nodes + a, nodes[a]) == nodes + a, ExitCode::bad_mesh,
                         draft.where << label_of_cell(draft, c) << " has " << label_of_node(draft, nodes[a])
                                     << " twice");
        std::copy_n(&draft.mesh.coords[static_cast<std::size_t>(dim) * nodes[a]], dim, x[a]);
      }
      const std::array<Point, 2> box = bounds(draft, nodes, num_nodes);
      const double least = 1e-14 * std::pow(distance(box[0], box[1]), dim);
      const bool good = std::all_of(where.begin(), where.end(), [&](const auto &gradient) {
        return jacobian<dim, num_nodes>(x, gradient) > least;
      });
      if (!good) refuse_cell(draft, c, least);
    }
  });
}

std::vector<int> inverted_cells(const Element &element, const std::vector<double> &coords,
                                const std::vector<int> &cells, const std::vector<int> &which)
{
  std::vector<int> bad;
  with_static_extents(element, [&](const auto static_dim, const auto static_nodes) {
    constexpr int dim = static_dim, num_nodes = static_nodes;
    const auto where = gradients_where_checked(ShapeFunctions<dim, num_nodes>());
    for (const int c : which) {
      double x[num_nodes][dim], size = 0;
      for (int a = 0; a < num_nodes; ++a) {
        std::copy_n(&coords[std::size_t(dim) * cells[std::size_t(num_nodes) * c + a]], dim, x[a]);
        for (int d = 0; d < dim; ++d) size = std::max(size, std::abs(x[a][d] - x[0][d]));
      }
      const double least = 1e-14 * std::pow(size, dim);
      if (!std::all_of(where.begin(), where.end(),
                       [&](const auto &gradient) { return jacobian<dim, num_nodes>(x, gradient) > least; }))
        bad.push_back(c);
    }
  });
  return bad;
}

std::vector<int> nodes_of_facet(const MeshData &mesh, const int cell, const int ordinal)
{
  std::vector<int> nodes;
  for (const int local : mesh.element.facets()[ordinal])
    nodes.push_back(mesh.cells[static_cast<std::size_t>(cell) * mesh.element.num_nodes() + local]);
  return nodes;
}

void check_facets(const TaggedMesh &draft, const Entities &facets)
{
  const Element &element = draft.mesh.element;
  for (int f = 0; f < facets.size(); ++f)
    for (int k = 1; k < facets.num_cells_at(f); ++k)
      for (int before = 0; before < k; ++before) {
        const auto label = [&](const char *const both) {
          return draft.where + label_of_cell(draft, facets.cell(f, before)) + " and " +
                 label_of_cell(draft, facets.cell(f, k)) + both + label_of_entity(draft, facets, f);
        };
        const Course one = course_of(draft, facets, f, before), other = course_of(draft, facets, f, k);
        RPC_REQUIRE_CODE(one.opposite == other.opposite, ExitCode::bad_mesh, label(" go in different orders around "));
        RPC_REQUIRE_CODE(one.upward != other.upward, ExitCode::bad_mesh,
                         label(" overlap: they lie on the same side of ") << draft.overlap_remedy);
      }
  if (element.order == 1) return;
  if (element.dim == 2) return check_middle_nodes(draft, facets, element.facets()); // its edges
  check_middle_nodes(draft, edges_of(element, draft.mesh.cells), element.edges());
  if (element.shape == Shape::tensor) check_middle_nodes(draft, facets, element.facets());
}

} // namespace rpc::mesh
