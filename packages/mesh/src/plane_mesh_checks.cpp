#include "plane_mesh_checks.hpp"

#include "rpc/core/error.hpp"
#include "rpc/mesh/quadrature.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>

namespace rpc::mesh
{
namespace
{

using Point = std::array<double, 2>;
using Gradients = std::vector<Point>; // of the shape functions, at one point of the reference cell

Point point_of(const TaggedMesh &draft, const int node)
{
  return {draft.mesh.coords[2 * node], draft.mesh.coords[2 * node + 1]};
}

std::string label_of_node(const TaggedMesh &draft, const int node)
{
  const Point x = point_of(draft, node);
  std::ostringstream text;
  text << "node " << draft.node_tag[node] << " at (" << x[0] << ", " << x[1];
  if (draft.z[node] != 0) text << ", " << draft.z[node];
  text << ")";
  return text.str();
}

std::string label_of_cell(const TaggedMesh &draft, const int cell)
{
  return "cell " + std::to_string(draft.cell_tag[cell]) + " of \"" + draft.mesh.blocks[draft.mesh.block[cell]] + "\"";
}

/// Lower and upper corner of the box around nodes.
std::array<Point, 2> bounds(const TaggedMesh &draft, const int *const nodes, const int count)
{
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::array<Point, 2> box{{{inf, inf}, {-inf, -inf}}};
  for (int n = 0; n < count; ++n) {
    const Point x = point_of(draft, nodes ? nodes[n] : n);
    for (int d = 0; d < 2; ++d) {
      box[0][d] = std::min(box[0][d], x[d]);
      box[1][d] = std::max(box[1][d], x[d]);
    }
  }
  return box;
}

double diameter(const std::array<Point, 2> &box)
{
  return std::hypot(box[1][0] - box[0][0], box[1][1] - box[0][1]);
}

/// Nodes are sorted into squares as wide as the tolerance: only those in adjacent ones can be too close.
void check_distinct(const TaggedMesh &draft, const std::array<Point, 2> &box)
{
  const double tolerance = 1e-12 * diameter(box);
  using Square = std::tuple<std::int64_t, std::int64_t, int>; // column, row, node
  std::vector<Square> squares;
  for (int n = 0; n < draft.mesh.num_nodes(); ++n) {
    const Point x = point_of(draft, n);
    squares.push_back({static_cast<std::int64_t>((x[0] - box[0][0]) / tolerance),
                       static_cast<std::int64_t>((x[1] - box[0][1]) / tolerance), n});
  }
  std::sort(squares.begin(), squares.end());
  for (const auto &[column, row, node] : squares)
    for (const std::int64_t beside : {column, column + 1}) { // the left neighbour's search finds this one
      auto other = std::lower_bound(squares.begin(), squares.end(), Square{beside, row - 1, 0});
      for (; other != squares.end() && *other <= Square{beside, row + 1, std::numeric_limits<int>::max()}; ++other) {
        const int near = std::get<2>(*other);
        const Point x = point_of(draft, node), y = point_of(draft, near);
        RPC_REQUIRE_CODE(near == node || std::hypot(x[0] - y[0], x[1] - y[1]) > tolerance, ExitCode::bad_mesh,
                         draft.where << label_of_node(draft, std::min(node, near)) << " and node "
                                     << draft.node_tag[std::max(node, near)]
                                     << " are at one place; join the parts (BooleanFragments, or Coherence Mesh;)");
      }
    }
}

/// The gradients at the nodes, and with order 2 at the quadrature points of the stiffness. Those of quadrilaterals are
/// by coordinates of [0, 1]^2, in which the Jacobian determinant of a parallelogram is its area.
std::vector<Gradients> gradients_where_checked(const Element &element)
{
  std::vector<Gradients> result;
  with_shape_functions(element, [&](const auto &functions) {
    using Functions = std::decay_t<decltype(functions)>;
    if constexpr (Functions::dim == 2) {
      constexpr int nodes = Functions::nodes;
      const double scale = Functions::simplex ? 1 : 2;
      const auto add = [&](const double(&X)[2]) {
        double N[nodes], dN[nodes][2];
        functions.evaluate(X, N, dN);
        Gradients gradients;
        for (const auto &slope : dN) gradients.push_back({scale * slope[0], scale * slope[1]});
        result.push_back(gradients);
      };
      for (int a = 0; a < nodes; ++a) {
        double X[2];
        functions.node(a, X);
        add(X);
      }
      if (element.order == 1) return;
      for (const auto &point : quadrature(2, element.shape, stiffness_degree(element)).point) {
        const double X[2] = {point[0], point[1]};
        add(X);
      }
    }
  });
  return result;
}

double jacobian(const TaggedMesh &draft, const int *const nodes, const Gradients &gradient)
{
  double J[2][2] = {};
  for (std::size_t a = 0; a < gradient.size(); ++a) {
    const Point x = point_of(draft, nodes[a]);
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) J[i][j] += x[i] * gradient[a][j];
  }
  return J[0][0] * J[1][1] - J[0][1] * J[1][0];
}

/// Of the polygon of the vertices, > 0 if they run counterclockwise.
double signed_area(const TaggedMesh &draft, const int *const nodes, const int num_vertices)
{
  const Point origin = point_of(draft, nodes[0]);
  double area = 0;
  for (int v = 1; v + 1 < num_vertices; ++v) {
    const Point a = point_of(draft, nodes[v]), b = point_of(draft, nodes[v + 1]);
    area += ((a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0])) / 2;
  }
  return area;
}

[[noreturn]] void refuse_cell(const TaggedMesh &draft, const int cell, const double area, const double size)
{
  const Element &element = draft.mesh.element;
  std::ostringstream text;
  text << draft.where << label_of_cell(draft, cell) << ", with "
       << label_of_node(draft, draft.mesh.cells[static_cast<std::size_t>(cell) * element.num_nodes()]) << ", is ";
  if (std::abs(area) <= size)
    text << "degenerate: its area is " << area;
  else if (area < 0)
    text << "inverted: its vertices run clockwise; reverse the curve loop of its surface";
  else if (element.order == 2)
    text << "inverted: its curved edges bend too far; make smaller cells there, or set Mesh.HighOrderOptimize = 1";
  else
    text << "inverted: an angle between its edges is 180 degrees or more";
  throw Error(ExitCode::bad_mesh, text.str());
}

} // namespace

void check_nodes(const TaggedMesh &draft)
{
  for (int n = 0; n < draft.mesh.num_nodes(); ++n) {
    const Point x = point_of(draft, n);
    RPC_REQUIRE_CODE(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(draft.z[n]), ExitCode::bad_mesh,
                     draft.where << label_of_node(draft, n) << ": coordinates must be finite");
  }
  const std::array<Point, 2> box = bounds(draft, nullptr, draft.mesh.num_nodes());
  const double size = diameter(box);
  RPC_REQUIRE_CODE(size >= least_size && size <= greatest_size, ExitCode::bad_mesh,
                   draft.where << "the body's size must be " << least_size << " to " << greatest_size << " [m], got "
                               << size);
  for (int n = 0; n < draft.mesh.num_nodes(); ++n)
    RPC_REQUIRE_CODE(std::abs(draft.z[n]) <= 1e-10 * size, ExitCode::bad_mesh,
                     draft.where << label_of_node(draft, n) << " is off the plane; z must be 0");
  check_distinct(draft, box);
}

void check_cells(const TaggedMesh &draft)
{
  const Element &element = draft.mesh.element;
  const int num_nodes = element.num_nodes();
  const std::vector<Gradients> where = gradients_where_checked(element);
  for (int c = 0; c < draft.mesh.num_cells(); ++c) {
    const int *const nodes = &draft.mesh.cells[static_cast<std::size_t>(c) * num_nodes];
    for (int a = 0; a < num_nodes; ++a)
      RPC_REQUIRE_CODE(std::find(nodes, nodes + a, nodes[a]) == nodes + a, ExitCode::bad_mesh,
                       draft.where << label_of_cell(draft, c) << " has " << label_of_node(draft, nodes[a]) << " twice");
    const double size = 1e-14 * std::pow(diameter(bounds(draft, nodes, num_nodes)), 2);
    const bool good = std::all_of(where.begin(), where.end(),
                                  [&](const Gradients &gradient) { return jacobian(draft, nodes, gradient) > size; });
    if (!good) refuse_cell(draft, c, signed_area(draft, nodes, element.num_vertices()), size);
  }
}

int middle_node(const MeshData &mesh, const int cell, const int ordinal)
{
  const auto &facet = mesh.element.facets()[ordinal];
  return facet.size() > 2 ? mesh.cells[static_cast<std::size_t>(cell) * mesh.element.num_nodes() + facet[2]] : -1;
}

void check_facets(const TaggedMesh &draft, const Entities &facets)
{
  const Element &element = draft.mesh.element;
  const auto first_node = [&](const int cell, const int ordinal) {
    return draft.mesh.cells[static_cast<std::size_t>(cell) * element.num_nodes() + element.facets()[ordinal][0]];
  };
  for (int f = 0; f < facets.size(); ++f)
    for (int k = 1; k < facets.num_cells_at(f); ++k) {
      const int cell = facets.cell(f, k), before = facets.cell(f, k - 1);
      const int ordinal = facets.ordinal(f, k), ordinal_before = facets.ordinal(f, k - 1);
      const auto label = [&](const char *const both) {
        return draft.where + label_of_cell(draft, before) + " and " + label_of_cell(draft, cell) + both +
               label_of_node(draft, facets.vertices[2 * f]) + " and " +
               label_of_node(draft, facets.vertices[2 * f + 1]);
      };
      // Of two neighbours, both counterclockwise, one runs along their edge and the other against it.
      RPC_REQUIRE_CODE(first_node(cell, ordinal) != first_node(before, ordinal_before), ExitCode::bad_mesh,
                       label(" overlap: they lie on the same side of the edge between "));
      RPC_REQUIRE_CODE(middle_node(draft.mesh, cell, ordinal) == middle_node(draft.mesh, before, ordinal_before),
                       ExitCode::bad_mesh, label(" have different middle nodes on the edge between "));
    }
}

} // namespace rpc::mesh
