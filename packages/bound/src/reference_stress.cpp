// SPDX-License-Identifier: BSD-3-Clause
#include "reference_stress.hpp"

#include "gauss.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/fem/basis.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rpc::bound
{
namespace
{

using Plane = std::array<double, 2>;

/// A dense matrix, row by row.
struct Dense {
  int rows = 0, cols = 0;
  std::vector<double> a;

  Dense(const int r, const int c) : rows(r), cols(c), a(static_cast<std::size_t>(r) * c, 0.) {}
  double &operator()(const int r, const int c) { return a[static_cast<std::size_t>(r) * cols + c]; }
  double operator()(const int r, const int c) const { return a[static_cast<std::size_t>(r) * cols + c]; }
};

Dense product(const Dense &x, const Dense &y)
{
  Dense z(x.rows, y.cols);
  for (int i = 0; i < x.rows; ++i)
    for (int k = 0; k < x.cols; ++k)
      for (int j = 0; x(i, k) != 0 && j < y.cols; ++j) z(i, j) += x(i, k) * y(k, j);
  return z;
}

Dense transposed(const Dense &x)
{
  Dense z(x.cols, x.rows);
  for (int i = 0; i < x.rows; ++i)
    for (int j = 0; j < x.cols; ++j) z(j, i) = x(i, j);
  return z;
}

/// A basis of what x maps to 0, in columns, and the inverse of x on the rest.
struct Kernel {
  Dense basis, inverse;
};

Kernel kernel_of(const Dense &x)
{
  const int m = x.rows, n = x.cols;
  const Dense by_columns = transposed(x); // as LAPACK wants it
  std::vector<double> a = by_columns.a, s(std::min(m, n)), u(static_cast<std::size_t>(m) * m),
                      vt(static_cast<std::size_t>(n) * n);
  std::vector<double> work(10 * (m + n) + 5 * std::max(m, n)), rwork(1);
  int info = 0;
  Teuchos::LAPACK<int, double>().GESVD('A', 'A', m, n, a.data(), m, s.data(), u.data(), m, vt.data(), n, work.data(),
                                       static_cast<int>(work.size()), rwork.data(), &info);
  RPC_REQUIRE_CODE(info == 0, ExitCode::internal_error, "bound: singular values do not converge, info " << info);
  int rank = 0;
  while (rank < static_cast<int>(s.size()) && s[rank] > 1e-10 * s[0]) ++rank;
  Kernel k{Dense(n, n - rank), Dense(n, m)};
  for (int i = 0; i < n; ++i)
    for (int j = rank; j < n; ++j) k.basis(i, j - rank) = vt[static_cast<std::size_t>(i) * n + j];
  for (int r = 0; r < rank; ++r)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < m; ++j)
        k.inverse(i, j) += vt[static_cast<std::size_t>(i) * n + r] * u[static_cast<std::size_t>(r) * m + j] / s[r];
  return k;
}

/// Solves x z = y for a symmetric positive definite x.
Dense solved_spd(Dense x, Dense y)
{
  const int n = x.rows;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k)
      for (int i = j; i < n; ++i) x(i, j) -= x(i, k) * x(j, k);
    const double pivot = std::sqrt(x(j, j));
    for (int i = j; i < n; ++i) x(i, j) /= pivot;
  }
  for (int c = 0; c < y.cols; ++c) {
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k) y(i, c) -= x(i, k) * y(k, c);
      y(i, c) /= x(i, i);
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) y(i, c) -= x(k, i) * y(k, c);
      y(i, c) /= x(i, i);
    }
  }
  return y;
}

/// The reference cell, split, with the stresses of some degree.
struct SplitCell {
  int sides, degree, monomials;
  std::vector<Plane> vertex; // relative to the centre
  std::vector<std::array<int, 2>> power;
  Plane centre{};

  SplitCell(const mesh::Element &element, const int k) : sides(element.num_vertices()), degree(k)
  {
    for (int v = 0; v < sides; ++v) {
      Plane x;
      for (int d = 0; d < 2; ++d) {
        const double on_lattice = element.lattice()[v][d];
        x[d] = element.shape == mesh::Shape::simplex ? on_lattice / element.order : 2 * on_lattice / element.order - 1;
        centre[d] += x[d] / sides;
      }
      vertex.push_back(x);
      RPC_REQUIRE_CODE(element.facets()[v][0] == v && element.facets()[v][1] == (v + 1) % sides,
                       ExitCode::internal_error,
                       "bound: side " << v << " of " << element.name() << " does not follow its vertex");
    }
    for (Plane &x : vertex)
      for (int d = 0; d < 2; ++d) x[d] -= centre[d];
    for (int n = 0; n <= k; ++n)
      for (int j = 0; j <= n; ++j) power.push_back({n - j, j});
    monomials = static_cast<int>(power.size());
  }
  int coefficients() const { return 3 * sides * monomials; }
  int at(const int triangle, const int component, const int m) const
  {
    return (triangle * 3 + component) * monomials + m;
  }
  double monomial(const int m, const Plane &x) const
  {
    return std::pow(x[0], power[m][0]) * std::pow(x[1], power[m][1]);
  }
  Plane along(const int side, const double x) const
  {
    const Plane &a = vertex[side], &b = vertex[(side + 1) % sides];
    return {a[0] + x * (b[0] - a[0]), a[1] + x * (b[1] - a[1])};
  }
  /// row(s) += factor * (component of s n) at a point of a triangle.
  void add_traction(Dense &rows, const int row, const int triangle, const int component, const Plane &x, const Plane &n,
                    const double factor) const
  {
    const int first = component == 0 ? 0 : 2, second = component == 0 ? 2 : 1;
    for (int m = 0; m < monomials; ++m) {
      rows(row, at(triangle, first, m)) += factor * n[0] * monomial(m, x);
      rows(row, at(triangle, second, m)) += factor * n[1] * monomial(m, x);
    }
  }
};

/// Jumps of tractions across the inner lines, and the polynomials of the divergence.
Dense conditions(const SplitCell &c)
{
  const int k = c.degree, of_divergence = k * (k + 1) / 2;
  Dense rows(c.sides * (2 * (k + 1) + 2 * of_divergence), c.coefficients());
  int row = 0;
  for (int v = 0; v < c.sides; ++v) {
    const Plane n = {c.vertex[v][1], -c.vertex[v][0]};
    for (int p = 0; p <= k; ++p)
      for (int component = 0; component < 2; ++component, ++row) {
        const double part = k > 0 ? static_cast<double>(p) / k : 0.5;
        const Plane x = {part * c.vertex[v][0], part * c.vertex[v][1]};
        c.add_traction(rows, row, v, component, x, n, 1);
        c.add_traction(rows, row, (v + c.sides - 1) % c.sides, component, x, n, -1);
      }
  }
  for (int triangle = 0; triangle < c.sides; ++triangle)
    for (int component = 0; component < 2; ++component) {
      for (int m = 0; m < c.monomials; ++m) {
        const auto [a, b] = c.power[m];
        const auto row_of = [&](const std::array<int, 2> &power) {
          const auto found = std::find(c.power.begin(), c.power.end(), power);
          return row + static_cast<int>(found - c.power.begin());
        };
        if (a > 0) rows(row_of({a - 1, b}), c.at(triangle, component == 0 ? 0 : 2, m)) += a;
        if (b > 0) rows(row_of({a, b - 1}), c.at(triangle, component == 0 ? 2 : 1, m)) += b;
      }
      row += of_divergence;
    }
  return rows;
}

/// Legendre coefficients of the tractions, by unit of the parameter along each side.
Dense tractions_of(const SplitCell &c)
{
  Dense rows(2 * (c.degree + 1) * c.sides, c.coefficients());
  const Gauss rule = gauss(c.degree + 1);
  int row = 0;
  for (int s = 0; s < c.sides; ++s) {
    const Plane &a = c.vertex[s], &b = c.vertex[(s + 1) % c.sides], n = {b[1] - a[1], a[0] - b[0]};
    for (int j = 0; j <= c.degree; ++j)
      for (int component = 0; component < 2; ++component, ++row)
        for (std::size_t q = 0; q < rule.point.size(); ++q)
          c.add_traction(rows, row, s, component, c.along(s, rule.point[q]), n,
                         (2 * j + 1) * rule.weight[q] * legendre(j, rule.point[q]));
  }
  return rows;
}

/// Points of each triangle, exact for polynomials up to degree 2 n - 2.
struct TrianglePoints {
  std::vector<Plane> point; // (sides * points)
  std::vector<double> weight;
};
TrianglePoints triangle_points(const SplitCell &c, const int n)
{
  TrianglePoints p;
  const Gauss rule = gauss(n);
  for (int s = 0; s < c.sides; ++s) {
    const Plane &a = c.vertex[s], &b = c.vertex[(s + 1) % c.sides];
    const double twice_area = a[0] * b[1] - a[1] * b[0];
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double r = rule.point[i], t = rule.point[j];
        p.point.push_back({r * (a[0] + t * (b[0] - a[0])), r * (a[1] + t * (b[1] - a[1]))});
        p.weight.push_back(rule.weight[i] * rule.weight[j] * r * twice_area);
      }
  }
  return p;
}

/// int s_c t_d over the cell, as a matrix between coefficients.
Dense mass(const SplitCell &c, const int component, const int other)
{
  Dense m(c.coefficients(), c.coefficients());
  const int n = c.degree + 2;
  const TrianglePoints p = triangle_points(c, n);
  for (int s = 0; s < c.sides; ++s)
    for (int q = s * n * n; q < (s + 1) * n * n; ++q)
      for (int i = 0; i < c.monomials; ++i)
        for (int j = 0; j < c.monomials; ++j)
          m(c.at(s, component, i), c.at(s, other, j)) +=
              p.weight[q] * c.monomial(i, p.point[q]) * c.monomial(j, p.point[q]);
  return m;
}

/// Products of the columns of stresses, by components: (6, columns, columns).
DeviceView<double ***> energies(const SplitCell &c, const Dense &stress)
{
  constexpr int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  DeviceView<double ***> table("rpc::bound::energies", 6, stress.cols, stress.cols);
  const auto host = Kokkos::create_mirror_view(table);
  for (int p = 0; p < 6; ++p) {
    const Dense e = product(transposed(stress), product(mass(c, pair[p][0], pair[p][1]), stress));
    for (int i = 0; i < stress.cols; ++i)
      for (int j = 0; j < stress.cols; ++j) host(p, i, j) = p < 3 ? e(i, j) : e(i, j) + e(j, i);
  }
  Kokkos::deep_copy(table, host);
  return table;
}

/// Stresses of the tractions and inner ones, in columns.
struct Columns {
  Dense of_tractions, inner;
};
Columns columns_of(const SplitCell &c)
{
  const Dense admissible = kernel_of(conditions(c)).basis;
  const Kernel k = kernel_of(product(tractions_of(c), admissible));
  const int rank = admissible.cols - k.basis.cols, wanted = 2 * (c.degree + 1) * c.sides - 3;
  RPC_REQUIRE_CODE(rank == wanted, ExitCode::internal_error,
                   "bound: stresses of degree " << c.degree << " have " << rank << " independent tractions instead of "
                                                << wanted);
  return {product(admissible, k.inverse), product(admissible, k.basis)};
}

DeviceView<double **> table_of(const Dense &x, const std::string &label)
{
  DeviceView<double **> table(label, x.rows, x.cols);
  const auto host = Kokkos::create_mirror_view(table);
  for (int i = 0; i < x.rows; ++i)
    for (int j = 0; j < x.cols; ++j) host(i, j) = x(i, j);
  Kokkos::deep_copy(table, host);
  return table;
}

/// Gradients of the shape functions at points relative to the centre: (sides, points, nodes, 2).
DeviceView<double ****> gradients(const mesh::Element &element, const SplitCell &c, const std::vector<Plane> &points)
{
  const int nodes = element.num_nodes(), per_side = static_cast<int>(points.size()) / c.sides;
  DeviceView<double ****> table("rpc::bound::gradients", c.sides, per_side, nodes, 2);
  const auto host = Kokkos::create_mirror_view(table);
  mesh::QuadratureRule rule;
  for (const Plane &x : points) {
    rule.point.push_back({x[0] + c.centre[0], x[1] + c.centre[1], 0});
    rule.weight.push_back(1);
  }
  const fem::BasisTable basis = fem::tabulate(element, rule);
  const auto gradient = to_host(basis.gradient);
  for (int q = 0; q < static_cast<int>(points.size()); ++q)
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < 2; ++d) host(q / per_side, q % per_side, a, d) = gradient(q, a, d);
  Kokkos::deep_copy(table, host);
  return table;
}

} // namespace

ReferenceStress reference_stress(const mesh::Element &element)
{
  const SplitCell c(element, element.order);
  const Columns columns = columns_of(c);
  ReferenceStress r;
  r.sides = c.sides;
  r.degree = c.degree;
  r.monomials = c.monomials;
  r.tractions = columns.of_tractions.cols;
  r.inner = columns.inner.cols;
  RPC_REQUIRE_CODE(r.tractions <= ReferenceStress::most_tractions && r.columns() <= ReferenceStress::most_columns,
                   ExitCode::internal_error, "bound: " << r.columns() << " stresses of a cell");
  Dense all(c.coefficients(), r.columns());
  for (int i = 0; i < all.rows; ++i)
    for (int j = 0; j < all.cols; ++j)
      all(i, j) = j < r.tractions ? columns.of_tractions(i, j) : columns.inner(i, j - r.tractions);
  r.stress = table_of(all, "rpc::bound::stress");
  r.energy = energies(c, all);
  const bool q2 = element.order == 2 && element.shape == mesh::Shape::tensor;
  const int n = q2 ? 4 : c.degree + 1; // squares of stresses, of Q2 with gradients of degree 3
  const TrianglePoints points = triangle_points(c, n);
  r.value = DeviceView<double ***>("rpc::bound::value", c.sides, n * n, c.monomials);
  r.weight = DeviceView<double **>("rpc::bound::weight", c.sides, n * n);
  r.moment = DeviceView<double ***>("rpc::bound::moment", 3, 2, r.columns());
  const auto value = Kokkos::create_mirror_view(r.value);
  const auto weight = Kokkos::create_mirror_view(r.weight);
  const auto moment = Kokkos::create_mirror_view(r.moment);
  for (int s = 0; s < c.sides; ++s)
    for (int q = 0; q < n * n; ++q) {
      const Plane &x = points.point[s * n * n + q];
      weight(s, q) = points.weight[s * n * n + q];
      for (int m = 0; m < c.monomials; ++m) value(s, q, m) = c.monomial(m, x);
      for (int component = 0; component < 3; ++component)
        for (int l = 0; l < 2; ++l)
          for (int j = 0; j < r.columns(); ++j)
            for (int m = 0; m < c.monomials; ++m)
              moment(component, l, j) += weight(s, q) * x[l] * value(s, q, m) * all(c.at(s, component, m), j);
    }
  Kokkos::deep_copy(r.value, value);
  Kokkos::deep_copy(r.weight, weight);
  Kokkos::deep_copy(r.moment, moment);
  r.gradient = gradients(element, c, points.point);
  const Gauss rule = gauss(3);
  std::vector<Plane> on_sides;
  for (int s = 0; s < c.sides; ++s)
    for (const double x : rule.point) on_sides.push_back(c.along(s, x));
  r.side_gradient = gradients(element, c, on_sides);
  r.side_point = device_values(rule.point, "rpc::bound::side_point");
  r.side_weight = device_values(rule.weight, "rpc::bound::side_weight");
  return r;
}

LiftedLoads lifted_loads(const mesh::Element &element)
{
  const int k = element.order, degree = ReferenceStress::degree_of_loads;
  const SplitCell c(element, degree);
  const Columns columns = columns_of(c);
  Dense weight(c.coefficients(), c.coefficients()); // of |s|^2: the least stress in the reference cell
  for (int component = 0; component < 3; ++component) {
    const Dense m = mass(c, component, component);
    for (std::size_t i = 0; i < m.a.size(); ++i) weight.a[i] += (component == 2 ? 2 : 1) * m.a[i];
  }
  const Dense by_weight = product(transposed(columns.inner), weight);
  const Dense correction =
      product(columns.inner, solved_spd(product(by_weight, columns.inner), product(by_weight, columns.of_tractions)));
  LiftedLoads lifted;
  lifted.columns = c.sides * (degree - k) * 2;
  Dense stress(c.coefficients(), lifted.columns);
  for (int s = 0; s < c.sides; ++s)
    for (int j = k + 1; j <= degree; ++j)
      for (int component = 0; component < 2; ++component) {
        const int from = (s * (degree + 1) + j) * 2 + component, to = (s * (degree - k) + j - k - 1) * 2 + component;
        for (int i = 0; i < stress.rows; ++i) stress(i, to) = columns.of_tractions(i, from) - correction(i, from);
      }
  lifted.energy = energies(c, stress);
  return lifted;
}

} // namespace rpc::bound
