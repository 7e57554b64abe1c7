// SPDX-License-Identifier: BSD-3-Clause
#include "size_plan.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <optional>
#include <random>

namespace size_plan_test
{
namespace
{

using namespace rpc::adapt;

/// (0, 1) x (0, 1) in n x n squares, each cut in two for triangles; no errors yet.
EstimatedMesh square(const int n, const int order, const int vertices)
{
  EstimatedMesh mesh;
  mesh.order = order;
  mesh.vertices = vertices;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.coords.insert(mesh.coords.end(), {double(i) / n, double(j) / n});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      if (vertices == 4)
        mesh.cells.insert(mesh.cells.end(), {a, b, c, d});
      else
        mesh.cells.insert(mesh.cells.end(), {a, b, c, a, c, d});
    }
  mesh.squared.assign(mesh.cells.size() / vertices, 0);
  return mesh;
}

/// Errors of a solution like |x|^lambda, at the corner.
void set_singular_errors(EstimatedMesh &mesh, const double lambda, const double h)
{
  for (int cell = 0; cell < mesh.num_cells(); ++cell) {
    double x[2] = {};
    for (int a = 0; a < mesh.vertices; ++a)
      for (int i = 0; i < 2; ++i) x[i] += mesh.coords[2 * mesh.cells[mesh.vertices * cell + a] + i] / mesh.vertices;
    const double r = std::hypot(x[0], x[1]);
    mesh.squared[cell] = h * h * std::pow(std::pow(h, mesh.order) * std::pow(r, lambda - 1 - mesh.order), 2);
  }
}

double size_at(const SizePlan &plan, const double x, const double y)
{
  for (std::size_t n = 0; n < plan.field.size.size(); ++n)
    if (std::hypot(plan.field.coords[2 * n] - x, plan.field.coords[2 * n + 1] - y) < 1e-12) return plan.field.size[n];
  ADD_FAILURE() << "no vertex at " << x << ", " << y;
  return 0;
}

double sum(const std::vector<double> &v)
{
  return std::accumulate(v.begin(), v.end(), 0.);
}

constexpr double rounding = 1.006; // half a step of 1/64 octave

TEST(SizePlan, EqualErrorsShrinkAllCellsAlikeAsTheOrderTells)
{
  for (const int vertices : {3, 4})
    for (const int order : {1, 2}) {
      auto mesh = square(6, order, vertices);
      std::fill(mesh.squared.begin(), mesh.squared.end(), 2.);
      const SizePlan plan = plan_sizes(mesh, {sum(mesh.squared) / std::pow(4, 2 * order), 1e9});
      const double h = 1. / 6 * (vertices == 3 ? std::sqrt(2 / std::sqrt(3.)) : 1); // of a cell of the same area
      for (const double size : plan.field.size) {
        EXPECT_LT(size / (h / 4), rounding);
        EXPECT_GT(size / (h / 4), 1 / rounding);
      }
      EXPECT_NEAR(plan.cells / mesh.num_cells(), 16, 0.2); // sizes are rounded
    }
}

TEST(SizePlan, CellsThatHardlyErrGrowWhileOthersShrink)
{
  auto mesh = square(12, 2, 3);
  for (int cell = 0; cell < mesh.num_cells(); ++cell) mesh.squared[cell] = cell < mesh.num_cells() / 2 ? 1 : 1e-2;
  const SizePlan plan = plan_sizes(mesh, {sum(mesh.squared) / 16, 1e9});
  EXPECT_LT(size_at(plan, 0.5, 0), 0.7 / 12);
  EXPECT_NEAR(size_at(plan, 0.5, 1) / size_at(plan, 0.5, 0), std::pow(1e2, 1. / 6), 0.05);
}

TEST(SizePlan, KeepsToTheNumberOfCells)
{
  auto mesh = square(8, 2, 3);
  std::fill(mesh.squared.begin(), mesh.squared.end(), 1.);
  EXPECT_NEAR(plan_sizes(mesh, {1e-12, 500}).cells, 500, 10);
  EXPECT_GT(plan_sizes(mesh, {1e-12, 1e9}).cells, 5000);
}

TEST(SizePlan, SizesThatSeeContactGrowUntilTheMeshHasTheCellsThatAreAllowed)
{
  auto mesh = square(8, 2, 3);
  std::fill(mesh.squared.begin(), mesh.squared.end(), 1.);
  mesh.unseen_squared.assign(mesh.squared.size(), 0);
  mesh.unseen_squared[60] = 1000;
  mesh.seen_from.assign(mesh.squared.size(), 1e-3);
  const double freely = plan_sizes(mesh, {sum(mesh.squared), 120}).cells;
  for (const double allowed : {40., 80., 120.}) {
    const SizePlan plan = plan_sizes(mesh, {sum(mesh.squared), allowed, 2.5, allowed});
    EXPECT_LE(plan.cells, allowed);
    EXPECT_GT(plan.cells, allowed / 2);
    EXPECT_GT(freely, 2 * allowed);
  }
  EXPECT_EQ(plan_sizes(mesh, {sum(mesh.squared), 120, 2.5, 2 * freely}).cells, freely);
}

TEST(SizePlan, SizesGrowByNoMoreThanHalfTheDistance)
{
  auto mesh = square(10, 1, 3);
  std::fill(mesh.squared.begin(), mesh.squared.end(), 1e-6);
  mesh.squared[105] = 1;
  const SizePlan plan = plan_sizes(mesh, {0.01, 1e9});
  const double least = *std::min_element(plan.field.size.begin(), plan.field.size.end());
  EXPECT_LT(least, 0.03);
  const auto &x = plan.field.coords;
  for (std::size_t n = 0; n < plan.field.size.size(); ++n)
    for (std::size_t m = 0; m < plan.field.size.size(); ++m) {
      // Along edges at most, which is up to sqrt(2) times as far.
      const double r = std::hypot(x[2 * n] - x[2 * m], x[2 * n + 1] - x[2 * m + 1]);
      EXPECT_LT(plan.field.size[n], rounding * rounding * (plan.field.size[m] + 0.5 * std::sqrt(2.) * r + 1e-12));
    }
}

TEST(SizePlan, DoesNotDependOnTheOrigin)
{
  for (const int vertices : {3, 4}) {
    auto mesh = square(8, 2, vertices);
    for (int cell = 0; cell < mesh.num_cells(); ++cell) mesh.squared[cell] = 1 + cell % 5;
    const SizeRequest request{sum(mesh.squared) / 50, 1e9};
    const SizePlan here = plan_sizes(mesh, request);
    for (double &x : mesh.coords) x += 1 << 24; // its eighths are exact there
    const SizePlan there = plan_sizes(mesh, request);
    ASSERT_EQ(here.field.size.size(), there.field.size.size());
    for (std::size_t n = 0; n < here.field.size.size(); ++n) {
      EXPECT_LT(here.field.size[n] / there.field.size[n], 1.02); // sizes are rounded to 64 steps an octave
      EXPECT_GT(here.field.size[n] / there.field.size[n], 0.98);
    }
  }
}

TEST(SizePlan, NoErrorLetsCellsGrow)
{
  const auto mesh = square(4, 1, 4);
  for (const double size : plan_sizes(mesh, {1, 1e9}).field.size) EXPECT_NEAR(size, 2.5 / 4, 0.01);
}

TEST(LocalExponents, TellASingularCornerFromSmoothBoundary)
{
  for (const int order : {1, 2})
    for (const double lambda : {0.5, 0.7}) {
      auto mesh = square(12, order, 3);
      set_singular_errors(mesh, lambda, 1. / 12);
      const auto exponent = local_exponents(mesh);
      EXPECT_NEAR(exponent[0], lambda, 0.3);
      EXPECT_GT(exponent[12], order);     // a corner where nothing happens
      EXPECT_GT(exponent[6 * 13], order); // the middle of a side
    }
}

TEST(SizePlan, SizesFallTowardsASingularCorner)
{
  auto mesh = square(12, 2, 3);
  const double h = 1. / 12, lambda = 0.7;
  set_singular_errors(mesh, lambda, h);
  const SizePlan plan = plan_sizes(mesh, {sum(mesh.squared) / 1000, 1e9});
  EXPECT_LT(size_at(plan, 0, 0), h / 25); // the error of the corner cell falls like h^0.7 only
  EXPECT_GT(size_at(plan, 0, 0), h / 10000);
  EXPECT_GT(size_at(plan, 1, 1), h);
  // Like r^(1 - lambda / 3) along the first edge, where points halve the way again and again.
  EXPECT_NEAR(std::log2(size_at(plan, h / 2, 0) / size_at(plan, h / 4, 0)), 1 - lambda / 3, 0.15);
}

TEST(SizePlan, DoesNotDependOnTheLastDigitsNorOnCellsThatHardlyErr)
{
  for (const int order : {1, 2}) {
    auto mesh = square(24, order, 3);
    set_singular_errors(mesh, 0.7, 1. / 24);
    const SizeRequest request{sum(mesh.squared) / 100, 1e9};
    std::mt19937 random(1);
    std::uniform_real_distribution<double> digits(-1e-9, 1e-9), octaves(-3, 3);
    std::optional<SizePlan> first;
    for (int k = 0; k < 10; ++k) {
      auto noisy = mesh;
      for (int cell = 0; cell < mesh.num_cells(); ++cell) {
        double x = 0;
        for (int a = 0; a < 3; ++a) x += mesh.coords[2 * mesh.cells[3 * cell + a]] / 3;
        // Half of the body is not strained: its errors are rounding.
        noisy.squared[cell] *= x > 0.5 ? 1e-20 * std::exp2(octaves(random)) : 1 + digits(random);
      }
      SizePlan plan = plan_sizes(noisy, request);
      if (!first)
        first = std::move(plan);
      else
        EXPECT_EQ(plan.field.size, first->field.size) << "order " << order;
    }
  }
}

TEST(LocalExponents, AreNotThoseOfNegligibleErrors)
{
  auto mesh = square(12, 2, 3);
  set_singular_errors(mesh, 0.6, 1. / 12);
  const double whole = sum(mesh.squared);
  EXPECT_NEAR(local_exponents(mesh, 1e-6 * whole)[0], local_exponents(mesh)[0], 0.02);
  EXPECT_GT(local_exponents(mesh, 1e6 * whole)[0], 2.9);
}

/// (0, 1)^3 in n^3 cubes, each cut in six for tetrahedra; no errors yet.
EstimatedMesh cube(const int n, const int order, const int vertices)
{
  EstimatedMesh mesh;
  mesh.dim = 3;
  mesh.order = order;
  mesh.vertices = vertices;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.coords.insert(mesh.coords.end(), {double(i) / n, double(j) / n, double(k) / n});
  const int step[3] = {1, n + 1, (n + 1) * (n + 1)};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = i + step[1] * j + step[2] * k;
        if (vertices == 8) {
          for (const int base : {a, a + step[2]})
            mesh.cells.insert(mesh.cells.end(), {base, base + 1, base + 1 + step[1], base + step[1]});
          continue;
        }
        int way[3] = {0, 1, 2};
        do {
          int node = a;
          mesh.cells.push_back(node);
          for (const int d : way) mesh.cells.push_back(node += step[d]);
        } while (std::next_permutation(way, way + 3));
      }
  mesh.squared.assign(mesh.cells.size() / vertices, 0);
  return mesh;
}

/// Errors of a solution like r^lambda, where r is the distance from the edge x = y = 0.
void set_edge_errors(EstimatedMesh &mesh, const double lambda, const double h)
{
  for (int cell = 0; cell < mesh.num_cells(); ++cell) {
    double x[3] = {};
    for (int a = 0; a < mesh.vertices; ++a)
      for (int i = 0; i < 3; ++i) x[i] += mesh.at(mesh.vertices_of(cell)[a])[i] / mesh.vertices;
    const double r = std::hypot(x[0], x[1]);
    mesh.squared[cell] = h * h * h * std::pow(std::pow(h, mesh.order) * std::pow(r, lambda - 1 - mesh.order), 2);
  }
}

double size_at(const SizePlan &plan, const double x, const double y, const double z)
{
  for (std::size_t n = 0; n < plan.field.size.size(); ++n)
    if (std::hypot(plan.field.coords[3 * n] - x, plan.field.coords[3 * n + 1] - y, plan.field.coords[3 * n + 2] - z) <
        1e-12)
      return plan.field.size[n];
  ADD_FAILURE() << "no vertex at " << x << ", " << y << ", " << z;
  return 0;
}

TEST(SizePlanInSpace, EqualErrorsShrinkAllCellsAlikeAsTheOrderTells)
{
  for (const int vertices : {4, 8})
    for (const int order : {1, 2}) {
      auto mesh = cube(3, order, vertices);
      std::fill(mesh.squared.begin(), mesh.squared.end(), 2.);
      const SizePlan plan = plan_sizes(mesh, {sum(mesh.squared) / std::pow(4, 2 * order), 1e9});
      const double h = std::cbrt(5. / 6) / 3; // a cube is as large as six tetrahedra, five of which fill h^3
      for (const double size : plan.field.size) {
        EXPECT_LT(size / (h / 4), rounding);
        EXPECT_GT(size / (h / 4), 1 / rounding);
      }
      EXPECT_NEAR(plan.cells / (27 * 6), 64, 64 * 0.02); // sizes are rounded
      EXPECT_EQ(plan.field.dim, 3);
      EXPECT_EQ(plan.field.simplices.size(), std::size_t(4 * 27 * 6));
    }
}

TEST(SizePlanInSpace, KeepsToTheNumberOfCells)
{
  for (const int vertices : {4, 8}) {
    auto mesh = cube(4, 2, vertices);
    std::fill(mesh.squared.begin(), mesh.squared.end(), 1.);
    const double cells = plan_sizes(mesh, {1e-12, 5000}).cells;
    EXPECT_LE(cells, 5000);
    EXPECT_GT(cells, 4000);
    EXPECT_GT(plan_sizes(mesh, {1e-12, 1e9}).cells, 100000);
  }
}

TEST(SizePlanInSpace, ErrorsThatHardlyMatterLetCellsGrow)
{
  auto mesh = cube(6, 2, 4);
  for (int cell = 0; cell < mesh.num_cells(); ++cell) mesh.squared[cell] = cell < mesh.num_cells() / 2 ? 1 : 1e-2;
  const SizePlan plan = plan_sizes(mesh, {sum(mesh.squared) / 16, 1e9});
  EXPECT_NEAR(size_at(plan, 0.5, 0.5, 1) / size_at(plan, 0.5, 0.5, 0), std::pow(1e2, 1. / 7), 0.05); // (10.5)
}

TEST(SizePlanInSpace, SizesFallTowardsASingularEdgeAllAlongIt)
{
  for (const int vertices : {4, 8}) {
    auto mesh = cube(8, 2, vertices);
    const double h = 1. / 8, lambda = 0.6;
    set_edge_errors(mesh, lambda, h);
    const auto exponent = local_exponents(mesh);
    for (int k = 2; k < 7; ++k) { // away from the ends
      EXPECT_NEAR(exponent[81 * k], lambda, 0.45) << "edge, at " << k;
      EXPECT_GT(exponent[81 * k + 80], 2) << "the edge opposite";
    }
    const SizePlan plan = plan_sizes(mesh, {sum(mesh.squared) / 100, 1e9});
    double least = 1, most = 0;
    for (int k = 0; k <= 8; ++k) {
      least = std::min(least, size_at(plan, 0, 0, k * h));
      most = std::max(most, size_at(plan, 0, 0, k * h));
    }
    EXPECT_GT(least, h / 10);
    EXPECT_LT(most, h / 2);
    EXPECT_LT(most, 3 * least);
    EXPECT_GT(size_at(plan, 1, 1, 0.5), 2 * most);
  }
}

TEST(SizePlanInSpace, DoesNotDependOnTheOriginNorOnLastDigits)
{
  auto mesh = cube(5, 2, 8);
  set_edge_errors(mesh, 0.7, 0.2);
  const SizeRequest request{sum(mesh.squared) / 50, 1e9};
  const SizePlan here = plan_sizes(mesh, request);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> digits(-1e-9, 1e-9);
  for (double &squared : mesh.squared) squared *= 1 + digits(random);
  EXPECT_EQ(plan_sizes(mesh, request).field.size, here.field.size);
  for (double &x : mesh.coords) x += 1 << 20;
  const SizePlan there = plan_sizes(mesh, request);
  ASSERT_EQ(here.field.size.size(), there.field.size.size());
  for (std::size_t n = 0; n < here.field.size.size(); ++n)
    EXPECT_NEAR(here.field.size[n] / there.field.size[n], 1, 0.02); // sizes are rounded to 64 steps an octave
}

} // namespace
} // namespace size_plan_test
