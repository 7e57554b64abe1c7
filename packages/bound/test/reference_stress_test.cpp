// SPDX-License-Identifier: BSD-3-Clause
#include "reference_stress.hpp"

#include "gauss.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

// Stresses of the split reference cells, by hand algebra on their coefficients.

namespace reference_stress_test
{
namespace
{

using namespace rpc;
using namespace rpc::bound;
using Plane = std::array<double, 2>;

mesh::Element element(const int order, const mesh::Shape shape)
{
  mesh::Element e;
  e.dim = 2;
  e.order = order;
  e.shape = shape;
  return e;
}

const std::vector<mesh::Element> elements = {element(1, mesh::Shape::simplex), element(2, mesh::Shape::simplex),
                                             element(1, mesh::Shape::tensor), element(2, mesh::Shape::tensor)};

/// Vertices relative to the centre, counterclockwise.
std::vector<Plane> vertices(const mesh::Element &e)
{
  if (e.shape == mesh::Shape::simplex) return {{-1. / 3, -1. / 3}, {2. / 3, -1. / 3}, {-1. / 3, 2. / 3}};
  return {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
}

/// A column of the table as a field, with monomials 1; X, Y; X^2, XY, Y^2.
struct Field {
  const ReferenceStress r;
  std::vector<double> coefficient;

  Field(const ReferenceStress &reference, const std::vector<double> &of_columns)
      : r(reference), coefficient(reference.coefficients(), 0.)
  {
    const auto stress = to_host(r.stress);
    for (int i = 0; i < r.coefficients(); ++i)
      for (int j = 0; j < r.columns(); ++j) coefficient[i] += stress(i, j) * of_columns[j];
  }
  double at(const int triangle, const int component, const Plane &x) const
  {
    const double m[6] = {1, x[0], x[1], x[0] * x[0], x[0] * x[1], x[1] * x[1]};
    double sum = 0;
    for (int k = 0; k < r.monomials; ++k) sum += coefficient[(triangle * 3 + component) * r.monomials + k] * m[k];
    return sum;
  }
  Plane traction(const int triangle, const Plane &x, const Plane &n) const
  {
    const double shear = at(triangle, 2, x);
    return {at(triangle, 0, x) * n[0] + shear * n[1], shear * n[0] + at(triangle, 1, x) * n[1]};
  }
  /// By central differences, exact for polynomials of degree 2.
  Plane divergence(const int triangle, const Plane &x) const
  {
    const double h = 0.25;
    const auto slope = [&](const int component, const int d) {
      Plane more = x, less = x;
      more[d] += h;
      less[d] -= h;
      return (at(triangle, component, more) - at(triangle, component, less)) / (2 * h);
    };
    return {slope(0, 0) + slope(2, 1), slope(2, 0) + slope(1, 1)};
  }
};

TEST(ReferenceStress, HasAsManyInnerStressesAsPolynomialsOfAiryLeave)
{
  // Triangles: piecewise polynomials with continuous slopes of degree 3, 4 on the split have 12, 21 coefficients, less 3 that are linear.
  EXPECT_EQ(reference_stress(elements[0]).inner, 12 - 3 - 9);
  EXPECT_EQ(reference_stress(elements[1]).inner, 21 - 3 - 15);
  EXPECT_EQ(reference_stress(elements[2]).inner, 16 - 3 - 13);
}

TEST(ReferenceStress, HasNoDivergenceAndContinuousTractions)
{
  for (const auto &e : elements) {
    SCOPED_TRACE(e.name());
    const ReferenceStress r = reference_stress(e);
    const auto v = vertices(e);
    for (int j = 0; j < r.columns(); ++j) {
      std::vector<double> column(r.columns(), 0.);
      column[j] = 1;
      const Field s(r, column);
      for (int t = 0; t < r.sides; ++t) {
        for (const Plane &x : {Plane{0.1, 0.2}, Plane{-0.3, 0.4}, Plane{0, -0.2}})
          for (const double component : s.divergence(t, x)) EXPECT_NEAR(component, 0, 1e-11);
        const Plane n = {v[t][1], -v[t][0]};
        for (const double y : {0., 0.3, 0.8, 1.}) {
          const Plane x = {y * v[t][0], y * v[t][1]};
          const Plane one = s.traction(t, x, n), other = s.traction((t + r.sides - 1) % r.sides, x, n);
          for (int i = 0; i < 2; ++i) EXPECT_NEAR(one[i], other[i], 1e-11);
        }
      }
    }
  }
}

TEST(ReferenceStress, HasTheTractionsThatItIsMadeOfWhereTheyAreInBalance)
{
  for (const auto &e : elements) {
    SCOPED_TRACE(e.name());
    const ReferenceStress r = reference_stress(e);
    const auto v = vertices(e);
    // Tractions of a field of Airy's function X^3/6 + X Y^2 + Y^4/12 without its last term for order 1: in balance, linear or quadratic.
    const double last = r.degree == 2 ? 1 : 0;
    const auto sigma = [&](const Plane &x) {
      return std::array<double, 3>{2 * x[0] + last * x[1] * x[1], x[0], -2 * x[1]};
    };
    std::vector<double> column(r.columns(), 0.);
    const Gauss rule = gauss(4);
    const auto traction = [&](const int s, const double y) {
      const Plane a = v[s], b = v[(s + 1) % r.sides], n = {b[1] - a[1], a[0] - b[0]};
      const auto t = sigma({a[0] + y * (b[0] - a[0]), a[1] + y * (b[1] - a[1])});
      return Plane{t[0] * n[0] + t[2] * n[1], t[2] * n[0] + t[1] * n[1]};
    };
    for (int s = 0; s < r.sides; ++s)
      for (int j = 0; j <= r.degree; ++j)
        for (int i = 0; i < 2; ++i)
          for (int q = 0; q < 4; ++q)
            column[(s * (r.degree + 1) + j) * 2 + i] +=
                (2 * j + 1) * rule.weight[q] * legendre(j, rule.point[q]) * traction(s, rule.point[q])[i];
    const Field field(r, column);
    for (int s = 0; s < r.sides; ++s)
      for (const double y : {0., 0.25, 0.7, 1.}) {
        const Plane a = v[s], b = v[(s + 1) % r.sides], n = {b[1] - a[1], a[0] - b[0]};
        const Plane there = field.traction(s, {a[0] + y * (b[0] - a[0]), a[1] + y * (b[1] - a[1])}, n);
        for (int i = 0; i < 2; ++i) EXPECT_NEAR(there[i], traction(s, y)[i], 1e-11);
      }
    for (int inner = r.tractions; inner < r.columns(); ++inner) {
      std::vector<double> one(r.columns(), 0.);
      one[inner] = 1;
      const Field none(r, one);
      for (int s = 0; s < r.sides; ++s) {
        const Plane a = v[s], b = v[(s + 1) % r.sides], n = {b[1] - a[1], a[0] - b[0]};
        for (const double component : none.traction(s, {(a[0] + 3 * b[0]) / 4, (a[1] + 3 * b[1]) / 4}, n))
          EXPECT_NEAR(component, 0, 1e-11);
      }
    }
  }
}

TEST(ReferenceStress, IntegratesProductsOfItsStresses)
{
  for (const auto &e : elements) {
    SCOPED_TRACE(e.name());
    const ReferenceStress r = reference_stress(e);
    const auto energy = to_host(r.energy);
    const auto value = to_host(r.value);
    const auto weight = to_host(r.weight);
    const auto stress = to_host(r.stress);
    double area = 0;
    for (std::size_t q = 0; q < weight.extent(1); ++q)
      for (int s = 0; s < r.sides; ++s) area += weight(s, q);
    EXPECT_NEAR(area, e.shape == mesh::Shape::simplex ? 0.5 : 4, 1e-13);
    const auto at = [&](const int s, const int q, const int component, const int j) {
      double sum = 0;
      for (int m = 0; m < r.monomials; ++m) sum += stress((s * 3 + component) * r.monomials + m, j) * value(s, q, m);
      return sum;
    };
    for (const int j : {0, 3, r.tractions - 1}) {
      double xx = 0, xx_xy = 0;
      for (int s = 0; s < r.sides; ++s)
        for (std::size_t q = 0; q < weight.extent(1); ++q) {
          xx += weight(s, q) * at(s, q, 0, j) * at(s, q, 0, j);
          xx_xy += 2 * weight(s, q) * at(s, q, 0, j) * at(s, q, 2, j);
        }
      EXPECT_NEAR(energy(0, j, j), xx, 1e-12 * std::max(1., xx));
      EXPECT_NEAR(energy(4, j, j), xx_xy, 1e-12 * std::max(1., xx));
    }
  }
}

/// Of a tetrahedron: component c of the stress of a column in a part, by monomials 1; X, Y, Z; X^2, XY, XZ, Y^2, YZ, Z^2.
struct FieldInSpace {
  const ReferenceStress r;
  std::vector<double> coefficient;

  FieldInSpace(const ReferenceStress &reference, const int column) : r(reference)
  {
    const auto stress = to_host(r.stress);
    for (int i = 0; i < r.coefficients(); ++i) coefficient.push_back(stress(i, column));
  }
  double at(const int part, const int component, const std::array<double, 3> &x) const
  {
    const double m[10] = {1,           x[0],        x[1],        x[2],        x[0] * x[0],
                          x[0] * x[1], x[0] * x[2], x[1] * x[1], x[1] * x[2], x[2] * x[2]};
    double sum = 0;
    for (int k = 0; k < r.monomials; ++k) sum += coefficient[(part * 6 + component) * r.monomials + k] * m[k];
    return sum;
  }
  std::array<double, 3> row(const int part, const int i, const std::array<double, 3> &x) const
  {
    constexpr int component[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    return {at(part, component[i][0], x), at(part, component[i][1], x), at(part, component[i][2], x)};
  }
};

TEST(ReferenceStress, InSpaceHasNoDivergenceAndContinuousTractions)
{
  const std::array<double, 3> vertex[4] = {
      {-0.25, -0.25, -0.25}, {0.75, -0.25, -0.25}, {-0.25, 0.75, -0.25}, {-0.25, -0.25, 0.75}};
  for (const int order : {1, 2}) {
    mesh::Element tetrahedron = element(order, mesh::Shape::simplex);
    tetrahedron.dim = 3;
    const ReferenceStress r = reference_stress(tetrahedron);
    EXPECT_EQ(r.tractions, order == 1 ? 36 : 72);
    EXPECT_EQ(r.inner, order == 1 ? 0 : 18);
    for (int column = 0; column < r.columns(); ++column) {
      const FieldInSpace s(r, column);
      const double h = 0.25; // central differences are exact for degree 2
      for (int part = 0; part < 4; ++part)
        for (int i = 0; i < 3; ++i) {
          double divergence = 0;
          for (int d = 0; d < 3; ++d) {
            std::array<double, 3> more{0.1, 0.2, -0.1}, less = more;
            more[d] += h;
            less[d] -= h;
            divergence += (s.row(part, i, more)[d] - s.row(part, i, less)[d]) / (2 * h);
          }
          EXPECT_NEAR(divergence, 0, 1e-11);
        }
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b) { // parts a and b meet in what the other two vertices make with the centre
          int others[2], k = 0;
          for (int v = 0; v < 4; ++v)
            if (v != a && v != b) others[k++] = v;
          const auto &e = vertex[others[0]], &f = vertex[others[1]];
          for (const auto &[y, z] : {std::pair<double, double>{0.2, 0.3}, {0.9, 0.05}, {0, 1}, {0.1, 0.6}})
            for (int i = 0; i < 3; ++i) {
              const std::array<double, 3> x{y * e[0] + z * f[0], y * e[1] + z * f[1], y * e[2] + z * f[2]};
              double jump = 0;
              for (int d = 0; d < 3; ++d) {
                const int p = (d + 1) % 3, q = (d + 2) % 3;
                jump += (s.row(a, i, x)[d] - s.row(b, i, x)[d]) * (e[p] * f[q] - e[q] * f[p]);
              }
              EXPECT_NEAR(jump, 0, 1e-11);
            }
        }
    }
  }
}

TEST(Gauss, IsExactAndLegendreOrthogonal)
{
  for (int n = 1; n <= 8; ++n) {
    const Gauss rule = gauss(n);
    for (int degree = 0; degree < 2 * n; ++degree) {
      double sum = 0;
      for (int q = 0; q < n; ++q) sum += rule.weight[q] * std::pow(rule.point[q], degree);
      EXPECT_NEAR(sum, 1. / (degree + 1), 1e-14) << n << " points, degree " << degree;
    }
  }
  const Gauss rule = gauss(8);
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 4; ++j) {
      double sum = 0;
      for (int q = 0; q < 8; ++q) sum += rule.weight[q] * legendre(i, rule.point[q]) * legendre(j, rule.point[q]);
      EXPECT_NEAR(sum, i == j ? 1. / (2 * i + 1) : 0, 1e-14);
    }
}

} // namespace
} // namespace reference_stress_test
