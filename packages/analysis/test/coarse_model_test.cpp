// SPDX-License-Identifier: BSD-3-Clause
/// The model of a coarse mesh on problems so small that all combinations of states can be tried, and on rough gaps.
#include "rpc/analysis/coarse_model.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Teuchos_SerialDenseMatrix.hpp>
#include <Teuchos_SerialDenseSolver.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace coarse_model_test
{
namespace
{

using namespace rpc;
using analysis::CoarseModel;
using analysis::ModelPoint;
using analysis::ModelStates;
using contact::State;

constexpr double inf = std::numeric_limits<double>::infinity();
using Matrix = Teuchos::SerialDenseMatrix<int, double>;

/// x <- A^-1 b.
bool solve(Matrix &A, Matrix &b, Matrix &x)
{
  Teuchos::SerialDenseSolver<int, double> solver;
  solver.factorWithEquilibration(true);
  solver.setMatrix(Teuchos::rcpFromRef(A));
  solver.setVectors(Teuchos::rcpFromRef(x), Teuchos::rcpFromRef(b));
  return solver.solve() == 0;
}

/// The solution of v = start - C W p with the contact law at each point, by trying all states.
/// @param C  (points, points) [m/N]
std::optional<ModelStates> tried(const Matrix &C, const std::vector<ModelPoint> &points,
                                 const std::vector<double> &start)
{
  const int n = C.numRows();
  for (int combination = 0; combination < std::pow(3, n); ++combination) {
    ModelStates found{std::vector<State>(n), std::vector<double>(n)};
    Matrix A(n, n), p(n, 1), right(n, 1);
    for (int i = 0, rest = combination; i < n; ++i, rest /= 3) {
      found.state[i] = static_cast<State>(rest % 3);
      const contact::Foundation &law = points[i].law;
      if (found.state[i] != State::closed) {
        A(i, i) = 1;
        right(i, 0) = found.state[i] == State::open ? 0 : law.yield; // perfectly plastic
        continue;
      }
      for (int j = 0; j < n; ++j) A(i, j) = C(i, j) * points[j].weight;
      A(i, i) += law.compliance;
      right(i, 0) = start[i];
    }
    if (std::isinf(right.normInf()) || !solve(A, right, p)) continue;
    bool admissible = true;
    for (int i = 0; i < n; ++i) {
      double v = start[i];
      for (int j = 0; j < n; ++j) v -= C(i, j) * points[j].weight * p(j, 0);
      found.pressure[i] = p(i, 0);
      if (found.state[i] == State::open) admissible = admissible && v <= 0;
      if (found.state[i] == State::closed) admissible = admissible && p(i, 0) >= 0 && p(i, 0) <= points[i].law.yield;
      if (found.state[i] == State::yielding) admissible = admissible && v >= points[i].law.compliance * p(i, 0);
    }
    if (admissible) return found;
  }
  return std::nullopt;
}

/// A bar of springs k, held at one end, whose nodes are the points.
solver::SymmetricEntries bar(const int n, const double k)
{
  solver::SymmetricEntries K;
  for (int i = 0; i < n; ++i) {
    K.row.push_back(i);
    K.column.push_back(i);
    K.value.push_back(i + 1 < n ? 2 * k : k);
    if (i == 0) continue;
    K.row.push_back(i);
    K.column.push_back(i - 1);
    K.value.push_back(-k);
  }
  return K;
}
double bar_compliance(const int i, const int j, const double k)
{
  return (std::min(i, j) + 1) / k;
}

solver::SparseColumns nodes(const int n)
{
  solver::SparseColumns P;
  for (int i = 0; i < n; ++i) {
    P.row.push_back(i);
    P.value.push_back(1);
    P.begin.push_back(i + 1);
  }
  return P;
}

/// Points of a law with a yield stress, some with a compliance.
std::vector<ModelPoint> some_points(const int n, const double stiffness, std::mt19937 &random)
{
  std::uniform_real_distribution<double> number(0.5, 1.5);
  std::vector<ModelPoint> points;
  for (int i = 0; i < n; ++i)
    points.push_back({number(random), stiffness, {i % 3 == 0 ? inf : number(random), 0, i % 2 == 0 ? 0 : 0.1}});
  return points;
}

std::vector<double> some_penetrations(const int n, std::mt19937 &random)
{
  std::normal_distribution<double> number(0.5, 2);
  std::vector<double> v(n);
  for (double &x : v) x = number(random);
  return v;
}

TEST(CoarseModel, FindsTheStatesOfItsOwnProblem)
{
  constexpr int n = 5;
  constexpr double k = 2, stiffness = 4;
  std::mt19937 random(1);
  int states[3] = {0, 0, 0};
  for (int scene = 0; scene < 60; ++scene) {
    const auto points = some_points(n, stiffness, random);
    const auto v = some_penetrations(n, random);
    Matrix C(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) C(i, j) = bar_compliance(i, j, k);
      C(i, i) += 1 / (points[i].weight * stiffness);
    }
    CoarseModel model(n, bar(n, k), nodes(n), points);
    ASSERT_TRUE(model.is_cheap(inf));
    model.learn(v, std::vector<double>(n, 0.));
    const auto found = model.choose(), expected = tried(C, points, v);
    ASSERT_TRUE(found && expected);
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(found->state[i], expected->state[i]);
      EXPECT_NEAR(found->pressure[i], expected->pressure[i], 1e-12);
      ++states[static_cast<int>(found->state[i])];
    }
  }
  for (const int count : states) EXPECT_GT(count, 10);
}

/// From a body of another compliance it learns with each solve: its choices end at the states there, though those by the coarse mesh alone
/// are others.
TEST(CoarseModel, LearnsFromSolvesOnTheFineMesh)
{
  constexpr int n = 6;
  constexpr double k = 1, stiffness = 50;
  std::mt19937 random(2);
  int first_is_wrong = 0;
  for (int scene = 0; scene < 30; ++scene) {
    auto points = some_points(n, stiffness, random);
    for (ModelPoint &point : points) point.law.compliance = 0.05; // each state's problem has a solution
    const auto start = some_penetrations(n, random);
    Matrix C(n, n); // more than the model has
    std::normal_distribution<double> number;
    std::vector<double> more(n);
    for (double &x : more) x = number(random);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) C(i, j) = bar_compliance(i, j, k) + more[i] * more[j];
      C(i, i) += 0.2;
    }
    const auto expected = tried(C, points, start);
    ASSERT_TRUE(expected);
    CoarseModel model(n, bar(n, k), nodes(n), points);
    model.learn(start, std::vector<double>(n, 0.));
    int choices = 0;
    bool same = false;
    for (; choices < n + 3 && !same; ++choices) {
      const auto chosen = model.choose();
      ASSERT_TRUE(chosen);
      same = chosen->state == expected->state;
      first_is_wrong += choices == 0 && !same;
      Matrix A(n, n), p(n, 1), right(n, 1); // the fine mesh's minimum for these states
      for (int i = 0; i < n; ++i) {
        if (chosen->state[i] == State::closed) {
          for (int j = 0; j < n; ++j) A(i, j) = C(i, j) * points[j].weight;
          A(i, i) += points[i].law.compliance;
          right(i, 0) = start[i];
        } else {
          A(i, i) = 1;
          right(i, 0) = chosen->state[i] == State::open ? 0 : points[i].law.yield;
        }
      }
      ASSERT_TRUE(solve(A, right, p));
      std::vector<double> v = start, pressure(n);
      for (int i = 0; i < n; ++i) {
        pressure[i] = p(i, 0);
        for (int j = 0; j < n; ++j) v[i] -= C(i, j) * points[j].weight * p(j, 0);
      }
      model.learn(v, pressure);
    }
    EXPECT_TRUE(same) << "scene " << scene;
    EXPECT_LE(model.num_learnt(), choices);
  }
  EXPECT_GE(first_is_wrong, 5);
}

TEST(CoarseModel, ThatIsTooStiffByMuchIsMadeSofter)
{
  constexpr int n = 4;
  constexpr double k = 2, factor = 100;
  std::vector<ModelPoint> points(n, {1., 1e12, {inf}});
  CoarseModel model(n, bar(n, factor * k), nodes(n), points);
  const std::vector<double> p{1, 0, 2, 0};
  std::vector<double> v(n, 0.), rest(n, 0.);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) v[i] -= bar_compliance(i, j, k) * p[j];
  model.learn(rest, rest);
  model.learn(v, p);
  EXPECT_NEAR(model.scale(), factor / 4, 1e-6);
  EXPECT_EQ(model.num_learnt(), 1);
  model.learn(rest, rest);
  EXPECT_EQ(model.num_learnt(), 1) << "the way back teaches nothing new";
}

/// Stiffness of a beam clamped at both ends: squared second differences.
solver::SymmetricEntries beam(const int n, const double k)
{
  solver::SymmetricEntries K;
  for (int i = 0; i < n; ++i)
    for (int j = std::max(0, i - 2); j <= i; ++j) {
      K.row.push_back(i);
      K.column.push_back(j);
      K.value.push_back(k * (i == j ? 6 : i - j == 1 ? -4 : 1));
    }
  return K;
}

/// A beam on gaps that are noise from point to point: the states found are those of the solution.
TEST(CoarseModel, FindsTheStatesOnRoughGaps)
{
  constexpr int n = 100;
  constexpr double stiffness = 1e3;
  const solver::SymmetricEntries K = beam(n, 100);
  for (const double yield : {10., inf}) {
    SCOPED_TRACE(yield);
    const std::vector<ModelPoint> points(n, {1., stiffness, {yield}});
    std::mt19937 random(7);
    std::uniform_real_distribution<double> gap(-0.3, 1.7);
    std::vector<double> v(n), d(n);
    for (double &penetration : v) penetration = gap(random);
    CoarseModel model(n, K, nodes(n), points);
    ASSERT_TRUE(model.is_cheap(inf));
    model.learn(v, std::vector<double>(n, 0.));
    const auto found = model.choose();
    ASSERT_TRUE(found);
    for (int i = 0; i < n; ++i) d[i] = -found->pressure[i];
    const auto factor = solver::SparseFactor::analyse(rcp(new Teuchos::SerialComm<int>), n, K, 1);
    ASSERT_TRUE(factor && factor->make(K.value));
    factor->solve(d.data());
    int touching = 0;
    for (int i = 0; i < n; ++i) {
      SCOPED_TRACE(i);
      touching += found->state[i] != State::open;
      EXPECT_EQ(contact::state(v[i] + d[i], 0, stiffness, points[i].law), found->state[i]);
      EXPECT_NEAR(contact::pressure(v[i] + d[i], 0, stiffness, points[i].law), found->pressure[i], 1e-6);
    }
    EXPECT_GE(touching, 2);
  }
}

TEST(CoarseModel, NeedsTheUnknownsOfAPointInOneCell)
{
  constexpr int n = 3;
  solver::SparseColumns ends; // of one point
  ends.begin = {0, 2};
  ends.row = {0, 2};
  ends.value = {0.5, 0.5};
  EXPECT_FALSE(CoarseModel(n, bar(n, 1), ends, {{1, 1, {inf}}}).is_cheap(inf));
}

TEST(CoarseModel, IsNotCheapBesideSolvesThatTakeLess)
{
  constexpr int n = 3;
  EXPECT_FALSE(CoarseModel(n, bar(n, 1), nodes(n), {{1, 1, {inf}}, {1, 1, {inf}}, {1, 1, {inf}}}).is_cheap(0));
}

} // namespace
} // namespace coarse_model_test
