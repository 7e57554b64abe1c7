// SPDX-License-Identifier: BSD-3-Clause
#include "revolution_tables.hpp"

#include "beside_inverse.hpp"
#include "gauss.hpp"
#include "rpc/fem/basis.hpp"
#include "split_cell.hpp"

#include <algorithm>

namespace rpc::bound
{
namespace
{

/// (arrangement, part, point) of all parts.
struct Arranged {
  std::vector<Place> place;
  std::vector<double> weight, from_end;
};
/// n^2 points in each part, exact for degree 2 n - 2 and for what closes up likewise.
Arranged arranged_points(const SplitCell &c, const int n)
{
  const Gauss rule = gauss(n);
  Arranged all;
  for (int e = 0; e < RevolutionTables::arrangements; ++e)
    for (int s = 0; s < c.sides; ++s) {
      const Place corner[3] = {Place{}, c.vertex[c.facet[s][0]], c.vertex[c.facet[s][1]]};
      const Place &end = corner[e], a = difference_of(corner[(e + 1) % 3], end),
                  b = difference_of(corner[(e + 2) % 3], end);
      const double area = std::abs(a[0] * b[1] - a[1] * b[0]); // twice
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const double away = rule.point[i], across = rule.point[j];
          Place x = end;
          for (int d = 0; d < 2; ++d) x[d] += away * ((1 - across) * a[d] + across * b[d]);
          all.place.push_back(x);
          all.weight.push_back(rule.weight[i] * rule.weight[j] * away * area);
          if (e == 0 && s == 0) all.from_end.push_back(away);
        }
    }
  return all;
}

/// Of a monomial by X_d.
double slope_of(const SplitCell &c, const int m, const Place &x, const int d)
{
  const auto &power = c.power[m];
  if (power[d] == 0) return 0;
  return power[d] * std::pow(x[d], power[d] - 1) * std::pow(x[1 - d], power[1 - d]);
}

template <class View, class Fill>
View filled(const View &table, const Fill &fill)
{
  const auto host = Kokkos::create_mirror_view(table);
  fill(host);
  Kokkos::deep_copy(table, host);
  return table;
}

} // namespace

RevolutionTables revolution_tables(const mesh::Element &element)
{
  const SplitCell c(element, element.order);
  const Columns columns = columns_of(c, kernel_of(jumps_in(c)).basis, 0);
  RevolutionTables t;
  const int nt = columns.of_tractions.cols;
  t.inner = columns.inner.cols;
  t.columns = nt + t.inner;
  RPC_REQUIRE_CODE(t.columns <= RevolutionTables::most_columns && t.inner <= RevolutionTables::most_inner,
                   ExitCode::internal_error, "bound: " << t.columns << " stresses of a cell of revolution");
  Dense all(c.coefficients(), t.columns);
  for (int i = 0; i < all.rows; ++i)
    for (int j = 0; j < all.cols; ++j) all(i, j) = j < nt ? columns.of_tractions(i, j) : columns.inner(i, j - nt);
  const Dense divergence = product(divergence_in(c), all);
  t.divergences = divergence.rows / (2 * c.sides);
  t.stress = filled(DeviceView<double **>("rpc::bound::stress", all.rows, all.cols), [&](const auto &table) {
    for (int i = 0; i < all.rows; ++i)
      for (int j = 0; j < all.cols; ++j) table(i, j) = all(i, j);
  });
  t.divergence = filled(DeviceView<double ***>("rpc::bound::divergence", c.sides * t.divergences, 2, t.columns),
                        [&](const auto &table) {
                          for (int s = 0; s < c.sides; ++s)
                            for (int i = 0; i < 2; ++i)
                              for (int m = 0; m < t.divergences; ++m)
                                for (int j = 0; j < t.columns; ++j)
                                  table(s * t.divergences + m, i, j) = divergence((s * 2 + i) * t.divergences + m, j);
                        });
  t.at_middle = filled(DeviceView<double ***>("rpc::bound::at_middle", c.sides, 3, t.columns), [&](const auto &table) {
    for (int s = 0; s < c.sides; ++s)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < t.columns; ++j)
          for (int m = 0; m < c.monomials; ++m)
            table(s, i, j) += c.monomial(m, c.on_facet(s, {0.5, 0.5, 0})) * all(c.at(s, i, m), j);
  });
  const bool simplex = element.shape == mesh::Shape::simplex;
  const int degree = std::max(2, simplex ? element.order : 2 * element.order); // of 2 pi r C eps(u) and of body forces
  const int n = degree + BesideInverse::touching + 2;                          // squared, times a polynomial near 1/r
  const Arranged points = arranged_points(c, n);
  t.points = n * n;
  mesh::QuadratureRule rule;
  for (const Place &x : points.place) {
    rule.point.push_back({x[0] + c.centre[0], x[1] + c.centre[1], 0});
    rule.weight.push_back(1);
  }
  const fem::BasisTable basis = fem::tabulate(element, rule);
  const auto shape = to_host(basis.value);
  const auto gradient = to_host(basis.gradient);
  const int nodes = element.num_nodes();
  const auto each = [&](const auto &fill) {
    for (int e = 0, at = 0; e < RevolutionTables::arrangements; ++e)
      for (int s = 0; s < c.sides; ++s)
        for (int q = 0; q < t.points; ++q, ++at) fill(e, s, q, at);
  };
  t.place = DeviceView<double ****>("rpc::bound::place", RevolutionTables::arrangements, c.sides, t.points, 2);
  filled(t.place, [&](const auto &table) {
    each([&](int e, int s, int q, int at) {
      for (int d = 0; d < 2; ++d) table(e, s, q, d) = points.place[at][d];
    });
  });
  t.weight = DeviceView<double ***>("rpc::bound::weight", RevolutionTables::arrangements, c.sides, t.points);
  filled(t.weight,
         [&](const auto &table) { each([&](int e, int s, int q, int at) { table(e, s, q) = points.weight[at]; }); });
  t.from_end = filled(DeviceView<double *>("rpc::bound::from_end", t.points), [&](const auto &table) {
    for (int q = 0; q < t.points; ++q) table(q) = points.from_end[q];
  });
  t.value =
      DeviceView<double ****>("rpc::bound::value", RevolutionTables::arrangements, c.sides, t.points, c.monomials);
  filled(t.value, [&](const auto &table) {
    each([&](int e, int s, int q, int at) {
      for (int m = 0; m < c.monomials; ++m) table(e, s, q, m) = c.monomial(m, points.place[at]);
    });
  });
  t.slope =
      DeviceView<double *****>("rpc::bound::slope", RevolutionTables::arrangements, c.sides, t.points, c.monomials, 2);
  filled(t.slope, [&](const auto &table) {
    each([&](int e, int s, int q, int at) {
      for (int m = 0; m < c.monomials; ++m)
        for (int d = 0; d < 2; ++d) table(e, s, q, m, d) = slope_of(c, m, points.place[at], d);
    });
  });
  t.shape = DeviceView<double ****>("rpc::bound::shape", RevolutionTables::arrangements, c.sides, t.points, nodes);
  filled(t.shape, [&](const auto &table) {
    each([&](int e, int s, int q, int at) {
      for (int a = 0; a < nodes; ++a) table(e, s, q, a) = shape(at, a);
    });
  });
  t.gradient =
      DeviceView<double *****>("rpc::bound::gradient", RevolutionTables::arrangements, c.sides, t.points, nodes, 2);
  filled(t.gradient, [&](const auto &table) {
    each([&](int e, int s, int q, int at) {
      for (int a = 0; a < nodes; ++a)
        for (int d = 0; d < 2; ++d) table(e, s, q, a, d) = gradient(at, a, d);
    });
  });
  return t;
}

} // namespace rpc::bound
