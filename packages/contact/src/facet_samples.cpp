// SPDX-License-Identifier: BSD-3-Clause
#include "facet_samples.hpp"

#include "rpc/fem/facet_area.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::contact
{

EvaluateShape shape_of(const mesh::Element &facet)
{
  EvaluateShape evaluate;
  mesh::with_shape_functions(facet, [&](const auto &shape) {
    using Shape = std::decay_t<decltype(shape)>;
    if constexpr (Shape::dim <= FacetShape::most_dim && Shape::nodes <= FacetShape::most_nodes)
      evaluate = [shape](const double *const at, FacetShape &to) {
        double X[Shape::dim], N[Shape::nodes], dN[Shape::nodes][Shape::dim];
        std::copy_n(at, Shape::dim, X);
        shape.evaluate(X, N, dN);
        for (int a = 0; a < Shape::nodes; ++a) {
          to.value[a] = N[a];
          for (int g = 0; g < Shape::dim; ++g) to.slope[g][a] = dN[a][g];
        }
      };
  });
  return evaluate;
}

int parts_with_halves(const mesh::Element &facet, const int parts)
{
  // Faces have the square of so many points.
  const int least = 4 * facet.order, step = facet.dim == 1 ? least : least / 2;
  return std::max((parts + step - 1) / step * step, least);
}

Lattice lattice_of(const mesh::Element &facet, const int parts)
{
  const EvaluateShape evaluate = shape_of(facet);
  const bool triangle = facet.dim == 2 && facet.shape == mesh::Shape::simplex;
  Lattice lattice;
  std::vector<std::array<int, 2>> steps; // from the first corner
  const int rows = facet.dim == 2 ? parts : 0;
  double all = 0;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= (triangle ? parts - j : parts); ++i) {
      double X[2] = {double(i) / parts, double(j) / parts};
      for (double &x : X) x = triangle ? x : 2 * x - 1;
      evaluate(X, lattice.points.emplace_back());
      steps.push_back({i, j});
      // Of the triangles or quadrilaterals around it, 6 or 4 inside.
      const int edges = triangle ? (i == 0) + (j == 0) + (i + j == parts) : 0;
      double &share = lattice.points.back().share;
      if (triangle)
        share = edges == 0 ? 6 : edges == 1 ? 3 : 1;
      else
        share = (i % parts == 0 ? 1 : 2) * (rows == 0 || j % rows == 0 ? 1 : 2);
      all += share;
    }
  for (FacetShape &point : lattice.points) point.share /= all;
  if (parts != parts_with_halves(facet, parts)) return lattice;
  const auto index = [&](const int i, const int j) { return j * (parts + 1) + i - (triangle ? j * (j - 1) / 2 : 0); };
  for (std::size_t n = 0; n < steps.size(); ++n)
    for (int a = 0; a < FacetShape::most_nodes; ++a)
      if (lattice.points[n].value[a] > 1 - 1e-9) lattice.node[a] = static_cast<int>(n);
  // A half begins at a corner of its own. The middle one of a triangle is turned around.
  const int middle = parts / 2;
  for (int half = 0; half < (facet.dim == 2 ? 4 : 2); ++half) {
    const int i = half % 2 * middle, j = half / 2 * middle;
    const bool turned = triangle && half == 3;
    Lattice::Nodes &nodes = lattice.of_half.emplace_back();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const auto [right, up] = steps[lattice.node[a]];
      nodes[a] = turned ? index(i - right / 2, j - up / 2) : index(i + right / 2, j + up / 2);
    }
  }
  for (const auto &[i, j] : steps) {
    const int right = std::min(i / middle, 1), up = std::min(j / middle, 1);
    const bool turned = triangle && right + up == 0 && i + j > middle;
    const int half = turned ? 3 : std::min(right + 2 * up, triangle ? 2 : 3);
    lattice.half.push_back(half);
    lattice.alike.push_back(turned ? index(2 * (middle - i), 2 * (middle - j))
                                   : index(2 * (i - half % 2 * middle), 2 * (j - half / 2 * middle)));
  }
  return lattice;
}

bool FacetRows::bears_nothing(const LO f) const
{
  for (int a = 0; a < nodes; ++a)
    if (column(f, a, bearing) > 0) return false;
  return true;
}

bool FacetRows::is_partly_open(const LO f) const
{
  for (int a = 0; a < nodes; ++a)
    if (column(f, a, bearing) == 0) return !bears_nothing(f);
  return false;
}

double FacetRows::interpolated(const LO f, const FacetShape &shape, const Column which) const
{
  double sum = 0;
  for (int a = 0; a < nodes; ++a) sum += shape.value[a] * column(f, a, which);
  return sum;
}

double FacetRows::most_allowed(const LO f) const
{
  double most = 0;
  for (int a = 0; a < nodes; ++a) most = std::max(most, column(f, a, allowed));
  return most;
}

namespace
{

/// (overlap nodes; FacetRows::Column) of one side.
RCP<const MultiVector> at_overlap_nodes(const fem::Discretization &d, const ContactNodes &points,
                                        const ContactResult &result, const int side)
{
  const auto owned = rcp(new MultiVector(d.mesh->owned_nodes, FacetRows::num_columns));
  const ContactNodes c = points;
  const auto v = result.penetration, p = result.pressure;
  {
    const auto to = owned->getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "rpc::contact::bearing_points",
        Kokkos::RangePolicy<ExecutionSpace, LO>(points.first(side), points.first(side + 1)), KOKKOS_LAMBDA(const LO i) {
          // A held point that is clear of the foundation bears nothing; of one that touches, the pressure is the support's affair.
          const bool touches = c.fixed(i) && !(c.free_gap(i) > 0);
          const bool weighs = c.weight(i) > 0, pressed = weighs && (p(i) > 0 || touches);
          double deep = c.dent(i);
          if (pressed && v(i) > deep) deep = v(i);
          to(c.node(i), int(FacetRows::allowed)) = weighs && deep > 0 ? deep : 0;
          to(c.node(i), int(FacetRows::bearing)) = !weighs ? -1 : pressed ? 1 : 0;
          to(c.node(i), int(FacetRows::penetration)) = v(i) - c.dent(i);
          to(c.node(i), int(FacetRows::dent)) = c.dent(i);
          to(c.node(i), int(FacetRows::pressure)) = p(i);
        });
    Kokkos::fence();
  }
  return fem::nodes_on_overlap(d, owned);
}

} // namespace

FacetRows facet_rows(const fem::Discretization &d, const mesh::Side &facets, const ContactNodes &points,
                     const ContactResult &result, const int side, const Vector &u)
{
  FacetRows rows;
  rows.dim = d.dim();
  rows.nodes = static_cast<int>(facets.facets.extent(1));
  const int dim = rows.dim, nodes = rows.nodes, width = rows.width();
  const LO num_facets = static_cast<LO>(facets.facets.extent(0));
  const DeviceView<double **> row("rpc::contact::facet_rows", num_facets, nodes * width);
  const DeviceView<double *> area("rpc::contact::facet_area", num_facets);
  const auto on_overlap = fem::on_overlap(d, u);
  const auto x = device_read(*on_overlap);
  const auto columns = at_overlap_nodes(d, points, result, side);
  const auto column = columns->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto coords = d.mesh->coords;
  const auto node_of = facets.facets, place_of = facets.places();
  const auto measure = fem::facet_measure(d, facets);
  const int quadrature = num_facets > 0 ? static_cast<int>(measure.extent(0)) / num_facets : 0;
  Kokkos::parallel_for(
      "rpc::contact::facet_rows", device_range(num_facets), KOKKOS_LAMBDA(const LO f) {
        area(f) = fem::facet_area(measure, quadrature, f);
        for (int a = 0; a < nodes; ++a) {
          const LO node = node_of(f, a);
          for (int k = 0; k < dim; ++k) {
            row(f, a * width + k) = coords(place_of(f, a), k);
            row(f, a * width + dim + k) = x(rpc::dof(dim, node, k));
          }
          for (int k = 0; k < FacetRows::num_columns; ++k) row(f, a * width + 2 * dim + k) = column(node, k);
        }
      });
  rows.row = HostView<double **>("rpc::contact::facet_rows", num_facets, nodes * width);
  Kokkos::deep_copy(rows.row, to_host(row)); // whatever the layout on the device is
  rows.area = to_host(area);
  rows.size = to_host(fem::facet_size(d, facets));
  rows.cell = to_host(facets.cell);
  return rows;
}

Point place_at(const FacetRows &rows, const LO f, const FacetShape &shape)
{
  Point x{};
  for (int a = 0; a < rows.nodes; ++a)
    for (int k = 0; k < rows.dim; ++k) x[k] += shape.value[a] * rows.place(f, a)[k];
  return x;
}

Point displacement_at(const FacetRows &rows, const LO f, const FacetShape &shape)
{
  Point u{};
  for (int a = 0; a < rows.nodes; ++a)
    for (int k = 0; k < rows.dim; ++k) u[k] += shape.value[a] * rows.displacement(f, a)[k];
  return u;
}

FacetNodes facet_nodes(const FacetRows &rows, const LO f)
{
  FacetNodes nodes{rows.nodes, rows.dim};
  const double most_allowed = rows.most_allowed(f);
  for (int a = 0; a < rows.nodes; ++a) {
    for (int k = 0; k < rows.dim; ++k) {
      nodes.value[k][a] = rows.place(f, a)[k];
      nodes.value[FacetNodes::displacement + k][a] = rows.displacement(f, a)[k];
    }
    const bool weightless = rows.column(f, a, FacetRows::bearing) < 0;
    nodes.value[FacetNodes::allowed][a] = weightless ? most_allowed : rows.column(f, a, FacetRows::allowed);
    nodes.value[FacetNodes::dent][a] = rows.column(f, a, FacetRows::dent);
  }
  return nodes;
}

FacetSample sample_at(const FacetNodes &nodes, const FacetShape &shape, const ContactOptions &options)
{
  const auto point = [&](const int of, const double *const weight) {
    return Point{nodes.sum(of, weight), nodes.sum(of + 1, weight), nodes.dim == 3 ? nodes.sum(of + 2, weight) : 0};
  };
  FacetSample sample;
  sample.place = point(0, shape.value);
  sample.allowed = nodes.sum(FacetNodes::allowed, shape.value);
  sample.dent = nodes.sum(FacetNodes::dent, shape.value);
  sample.allowed = std::max(sample.allowed, 0.);
  if (options.normal == Normal::fixed) {
    sample.normal = options.direction;
  } else if (options.normal == Normal::foundation) {
    const auto into = direction_into(options.obstacle, sample.place);
    sample.has_normal = into.has_value();
    if (into) sample.normal = *into;
  } else {
    const Point tangent = point(0, shape.slope[0]);
    const Point nu = nodes.dim == 2 ? Point{tangent[1], -tangent[0], 0} : cross(tangent, point(0, shape.slope[1]));
    sample.normal = scaled(1 / length(nu), nu);
  }
  sample.along = inner(point(FacetNodes::displacement, shape.value), sample.normal);
  return sample;
}

double penetration_at(const FacetSample &sample, const ContactOptions &options)
{
  constexpr double outside = -std::numeric_limits<double>::infinity();
  if (!sample.has_normal) return outside;
  double gap = 0;
  if (options.obstacle.exists()) {
    const auto distance = distance_along(options.obstacle, sample.place, sample.normal);
    if (!distance) return outside;
    gap = *distance;
  } else {
    gap = options.gap(sample.place);
  }
  const double v = sample.along - gap;
  return std::isfinite(v) ? v : outside;
}

double excess_at(const FacetSample &sample, const ContactOptions &options)
{
  return penetration_at(sample, options) - sample.allowed;
}

} // namespace rpc::contact
