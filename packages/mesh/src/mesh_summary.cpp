// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/mesh_summary.hpp"

#include "mesh_checks.hpp"
#include "rpc/mesh/quadrature.hpp"
#include "rpc/mesh/shape_functions.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::mesh
{
namespace
{

using Vec3 = std::array<double, 3>;

Vec3 cross_of(const Vec3 &a, const Vec3 &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double norm_of(const Vec3 &a)
{
  return std::hypot(a[0], a[1], a[2]);
}

double triple(const Vec3 &a, const Vec3 &b, const Vec3 &c)
{
  const Vec3 n = cross_of(a, b);
  return n[0] * c[0] + n[1] * c[1] + n[2] * c[2];
}

constexpr const char *kinds_of_shape[2][4] = {{"line", "circle", "cylinder", "curved"},
                                              {"plane", "sphere", "cylinder", "curved"}};

/// Sums over cells or facets of one kind.
class Sums
{
public:
  Sums(const MeshData &mesh, const Element &element) : mesh_(mesh), element_(element)
  {
    constexpr double inf = std::numeric_limits<double>::infinity();
    part.lower = {inf, inf, inf};
    part.upper = {-inf, -inf, -inf};
    const int degree = element.order == 1 ? 2 : 5; // of curved facets the root of a polynomial is integrated
    rule_ = quadrature(element.dim, element.shape, degree);
  }

  void add(const int *const nodes)
  {
    with_shape_functions(element_, [&](const auto &functions) { add_by(functions, nodes); });
    ++part.count;
    for (int a = 0; a < element_.num_nodes(); ++a)
      for (int d = 0; d < mesh_.element.dim; ++d) {
        part.lower[d] = std::min(part.lower[d], coordinate(nodes[a], d));
        part.upper[d] = std::max(part.upper[d], coordinate(nodes[a], d));
      }
  }

  PartSummary result()
  {
    for (int d = 0; d < 3; ++d) {
      part.centroid[d] = part.measure > 0 ? part.centroid[d] / part.measure : 0;
      part.normal[d] = part.measure > 0 ? part.normal[d] / part.measure : 0;
    }
    return part;
  }

  PartSummary part;

private:
  double coordinate(const int node, const int d) const
  {
    return mesh_.coords[static_cast<std::size_t>(mesh_.element.dim) * node + d];
  }

  template <int Dim, int Nodes>
  void add_by(const ShapeFunctions<Dim, Nodes> &functions, const int *const nodes)
  {
    for (int q = 0; q < rule_.num_points(); ++q) {
      double X[Dim], N[Nodes], dN[Nodes][Dim];
      std::copy_n(rule_.point[q].begin(), Dim, X);
      functions.evaluate(X, N, dN);
      Vec3 x{}, tangent[3] = {};
      if (Dim < 3) tangent[2] = {0, 0, 1};
      if (Dim < 2) tangent[1] = {0, 0, 1};
      for (int a = 0; a < Nodes; ++a)
        for (int d = 0; d < mesh_.element.dim; ++d) {
          x[d] += N[a] * coordinate(nodes[a], d);
          for (int g = 0; g < Dim; ++g) tangent[g][d] += dN[a][g] * coordinate(nodes[a], d);
        }
      const Vec3 n = cross_of(tangent[0], tangent[1]);
      const double density =
          Dim == mesh_.element.dim ? std::abs(triple(tangent[0], tangent[1], tangent[2])) : norm_of(n);
      const double weight = rule_.weight[q];
      part.measure += weight * density;
      for (int d = 0; d < 3; ++d) {
        part.centroid[d] += weight * density * x[d];
        if (Dim < mesh_.element.dim) part.normal[d] += weight * n[d];
      }
    }
  }

  const MeshData &mesh_;
  Element element_;
  QuadratureRule rule_;
};

const int *nodes_of_cell(const MeshData &mesh, const int cell)
{
  return &mesh.cells[static_cast<std::size_t>(cell) * mesh.element.num_nodes()];
}

PartSummary summary_of_facets(const MeshData &mesh, const std::string &name, const std::vector<int> &cell,
                              const std::vector<int> &ordinal)
{
  Sums sums(mesh, mesh.element.facet());
  for (std::size_t f = 0; f < cell.size(); ++f) sums.add(nodes_of_facet(mesh, cell[f], ordinal[f]).data());
  PartSummary part = sums.result();
  part.name = name;
  return part;
}

/// The arms at a vertex of the reference cell, to the vertices beside it.
std::vector<std::vector<int>> arms_of(const Element &element)
{
  std::vector<std::vector<int>> arms(element.num_vertices());
  for (const auto &edge : element.edges()) {
    arms[edge[0]].push_back(edge[1]);
    arms[edge[1]].push_back(edge[0]);
  }
  return arms;
}

void measure_cells(const MeshData &mesh, MeshSummary &summary)
{
  const int dim = mesh.element.dim;
  const auto arms = arms_of(mesh.element);
  const bool simplex = mesh.element.shape == Shape::simplex;
  const double regular = !simplex ? 1 : dim == 2 ? std::sqrt(3.) / 2 : 1 / std::sqrt(2.);
  double edges = 0, quality = 0;
  std::size_t num_edges = 0;
  summary.least_edge = summary.least_quality = std::numeric_limits<double>::infinity();
  for (int c = 0; c < mesh.num_cells(); ++c) {
    const int *const nodes = nodes_of_cell(mesh, c);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < arms.size(); ++v) {
      Vec3 arm[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}};
      double lengths = 1;
      for (int k = 0; k < dim; ++k) {
        for (int d = 0; d < dim; ++d)
          arm[k][d] = mesh.coords[static_cast<std::size_t>(dim) * nodes[arms[v][k]] + d] -
                      mesh.coords[static_cast<std::size_t>(dim) * nodes[v] + d];
        const double length = norm_of(arm[k]);
        lengths *= length;
        edges += length;
        ++num_edges;
        summary.least_edge = std::min(summary.least_edge, length);
        summary.greatest_edge = std::max(summary.greatest_edge, length);
      }
      least = std::min(least, std::abs(triple(arm[0], arm[1], arm[2])) / lengths / regular);
    }
    quality += least;
    summary.least_quality = std::min(summary.least_quality, least);
  }
  summary.mean_edge = edges / static_cast<double>(num_edges);
  summary.mean_quality = quality / mesh.num_cells();
}

} // namespace

MeshSummary summary_of(const MeshData &mesh)
{
  MeshSummary summary;
  summary.element = mesh.element;
  summary.num_nodes = mesh.num_nodes();
  summary.num_cells = mesh.num_cells();
  std::vector<Sums> blocks(mesh.blocks.size(), Sums(mesh, mesh.element));
  Sums body(mesh, mesh.element);
  for (int c = 0; c < mesh.num_cells(); ++c) {
    blocks[mesh.block[c]].add(nodes_of_cell(mesh, c));
    body.add(nodes_of_cell(mesh, c));
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    summary.blocks.push_back(blocks[b].result());
    summary.blocks.back().name = mesh.blocks[b];
  }
  summary.body = body.result();
  for (const SideData &side : mesh.sides)
    summary.sides.push_back(summary_of_facets(mesh, side.name, side.cell, side.ordinal));
  for (const BoundaryPart &part : mesh.geometry) {
    const char *const kind = kinds_of_shape[mesh.element.dim == 3][static_cast<int>(part.shape.kind)];
    summary.surfaces.push_back(summary_of_facets(mesh, kind, part.cell, part.ordinal));
    summary.surfaces.back().tag = part.shape.tag;
  }
  const Entities facets = facets_of(mesh.element, mesh.cells);
  std::vector<int> cell, ordinal;
  for (int f = 0; f < facets.size(); ++f)
    if (facets.num_cells_at(f) == 1) {
      cell.push_back(facets.cell(f, 0));
      ordinal.push_back(facets.ordinal(f, 0));
    }
  summary.boundary = summary_of_facets(mesh, "", cell, ordinal);
  measure_cells(mesh, summary);
  return summary;
}

} // namespace rpc::mesh
