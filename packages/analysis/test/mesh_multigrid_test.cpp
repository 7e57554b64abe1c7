// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/mesh_multigrid.hpp"

#include "clamped_block.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

namespace mesh_multigrid_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using solver::LinearSolver;
using solver::LinearSolverOptions;
using solver::MeshLevels;
using solver::MeshMultigrid;

std::string text_of(const mesh::Element &element)
{
  return element.name() + " in " + std::to_string(element.dim) + "D";
}
std::vector<int> some_cells(const mesh::Element &element)
{
  const bool one = element.order == 1;
  if (element.dim == 2) return one ? std::vector<int>{67, 35, 0} : std::vector<int>{35, 17, 0};
  return one ? std::vector<int>{23, 11, 13} : std::vector<int>{11, 5, 7};
}

/// The solver for the coarsest level that these meshes lead to.
std::unique_ptr<solver::CoarsestSolver> directly(const solver::MeshLevel &level)
{
  return solver::direct_solver(level.stiffness, level.body.dim);
}

TEST(MeshMultigrid, IsSymmetricAndPositive)
{
  for (const mesh::Element &element : mesh::all_elements())
    for (const double nu : {0.3, 0.499}) {
      const Block block(element, some_cells(element), true, {2, 1, 1}, nu);
      block.close_half();
      const MeshLevels levels = block.levels();
      ASSERT_TRUE(levels.down_to_few) << text_of(element);
      const MeshMultigrid B(block.H, levels, directly);
      const Vector x = block.vector(1), y = block.vector(2);
      Vector Bx(x.getMap()), By(x.getMap());
      B.apply(x, Bx);
      B.apply(y, By);
      EXPECT_NEAR(Bx.dot(y), By.dot(x), 1e-10 * std::sqrt(Bx.dot(x) * By.dot(y))) << text_of(element);
      EXPECT_GT(Bx.dot(x), 0) << text_of(element);
      EXPECT_GT(By.dot(y), 0) << text_of(element);
    }
}

/// Iterations to 1e-8 with an unordered right side, nothing and every other stretch of the contact side closed.
TEST(MeshMultigrid, NeedsFewIterations)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const int most = element.dim == 2 ? (element == mesh::Element{2, 1} ? 12 : 15) : (element.order == 1 ? 14 : 20);
    const Block block(element, some_cells(element));
    const auto solver = block.solver();
    const Vector b = block.vector(3);
    Vector x(b.getMap()), Hx(b.getMap());
    for (const bool closed : {false, true}) {
      if (closed) block.close_half();
      const auto result = solver->solve(b, x, 1e-8);
      EXPECT_TRUE(result.converged) << result.reason;
      EXPECT_LE(result.iterations, most) << text_of(element) << (closed ? ", closed" : "");
      block.H->apply(x, Hx);
      EXPECT_LT(relative_difference(Hx, b), 1.1e-8) << text_of(element);
    }
    EXPECT_EQ(solver->counts().preconditioner_setups, 1) << text_of(element);
    EXPECT_EQ(solver->counts().local_corrections, 1) << text_of(element);
    EXPECT_EQ(solver->counts().fallback, "") << text_of(element);
  }
}

/// A hierarchy that has followed the states is that which is made for them.
TEST(MeshMultigrid, FollowsTheStatesExactly)
{
  for (const mesh::Element &element : mesh::all_elements())
    for (const double nu : {0.3, 0.499}) {
      const Block block(element, some_cells(element), true, {2, 1, 1}, nu);
      block.close_half();
      MeshMultigrid B(block.H, block.levels(), directly);
      for (int k = 0; k < 3; ++k) {
        block.close([k](const double x) { return std::fmod(x + 0.1 * k, 0.5) < 0.2; });
        B.update();
      }
      const MeshMultigrid anew(block.H, block.levels(), directly);
      const Vector x = block.vector(4);
      Vector Bx(x.getMap()), expected(x.getMap());
      B.apply(x, Bx);
      anew.apply(x, expected);
      EXPECT_LT(relative_difference(Bx, expected), 1e-10) << text_of(element);
    }
}

TEST(MeshMultigrid, IterationsDoNotGrowWithTheMesh)
{
  std::vector<int> iterations;
  for (const int n : {16, 32, 64, 128}) {
    const Block block({2, 1}, {2 * n, n});
    block.close_half();
    const Vector b = block.vector(5);
    Vector x(b.getMap());
    iterations.push_back(block.solver()->solve(b, x, 1e-8).iterations);
  }
  EXPECT_LE(iterations.back(), iterations[1] + 2);
  EXPECT_LE(iterations.back(), 12);
}

/// Stretched cells: only the direction in which they are short is halved, until they are square.
TEST(MeshMultigrid, TakesStretchedCells)
{
  for (const double length : {1., 10., 100.}) {
    const Block block({2, 1}, {40, 40}, true, {length, 1, 1});
    block.close_half();
    const Vector b = block.vector(6);
    Vector x(b.getMap());
    const auto result = block.solver()->solve(b, x, 1e-8);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LE(result.iterations, 25) << length;
  }
}

/// Of order 2 without coarser boxes: MueLu's hierarchy follows the mesh of order 1.
TEST(MeshMultigrid, EndsAlgebraicallyWhereThereIsNoCoarserMesh)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    if (element.order == 1) continue;
    const Block block(element, some_cells(element), false);
    const MeshLevels levels = block.levels();
    ASSERT_EQ(levels.level.size(), 1U) << text_of(element);
    const auto solver = block.solver();
    const Vector b = block.vector(7);
    Vector x(b.getMap());
    for (const bool closed : {false, true}) {
      if (closed) block.close_half();
      const auto result = solver->solve(b, x, 1e-8);
      EXPECT_TRUE(result.converged) << result.reason;
      EXPECT_LE(result.iterations, element.dim == 2 ? 15 : 20) << text_of(element) << (closed ? ", closed" : "");
    }
    EXPECT_EQ(solver->counts().preconditioner_setups, 1) << text_of(element);
  }
}

/// A solver for the coarsest mesh that counts how often it is made to follow the states.
class Counting : public solver::CoarsestSolver
{
public:
  Counting(std::unique_ptr<CoarsestSolver> solver, int &updates) : solver_(std::move(solver)), updates_(updates) {}
  Update update(const double slight) override
  {
    ++updates_;
    return solver_->update(slight);
  }
  double most_change() const override { return 0.1; }
  void apply(const Vector &b, Vector &x) const override { solver_->apply(b, x); }

private:
  std::unique_ptr<CoarsestSolver> solver_;
  int &updates_;
};

/// Small changes add up until the coarsest solver follows.
TEST(MeshMultigrid, RenewsWhatIsDearWhereMuchHasChanged)
{
  const Block block({2, 1}, {67, 35});
  const auto close_up_to = [&](const double x) { block.close([x](const double at) { return at < x; }); };
  close_up_to(1);
  int updates = 0;
  MeshMultigrid B(block.H, block.levels(),
                  [&](const solver::MeshLevel &level) { return std::make_unique<Counting>(directly(level), updates); });
  B.update();
  EXPECT_EQ(updates, 0); // nothing has changed
  close_up_to(1.06);
  B.update();
  EXPECT_EQ(updates, 0);
  close_up_to(1.2); // a sixth more than it was made for
  B.update();
  EXPECT_EQ(updates, 1);
  close_up_to(1.14);
  B.update();
  EXPECT_EQ(updates, 1);
  close_up_to(0);
  B.update();
  EXPECT_EQ(updates, 2);
}

/// The same, always brought up to date, that says each time that it has left out slight changes.
class Rough : public Counting
{
public:
  using Counting::Counting;
  Update update(const double slight) override
  {
    Counting::update(slight);
    return slight > 0 ? Update::rough : Update::exact;
  }
  double most_change() const override { return 0; }
};

/// States that come back are followed as well: what the coarsest solver was brought to counts, not what it was exact for.
TEST(MeshMultigrid, FollowsStatesThatComeBackAfterARoughUpdate)
{
  const Block block({2, 1}, {67, 35});
  const auto close_up_to = [&](const double x) { block.close([x](const double at) { return at < x; }); };
  close_up_to(1);
  int updates = 0;
  MeshMultigrid B(block.H, block.levels(),
                  [&](const solver::MeshLevel &level) { return std::make_unique<Rough>(directly(level), updates); });
  EXPECT_TRUE(B.update(false));
  EXPECT_EQ(updates, 0);
  close_up_to(1.2);
  EXPECT_FALSE(B.update(false));
  EXPECT_EQ(updates, 1);
  EXPECT_FALSE(B.update(false)) << "nothing has changed, but it is not exact yet";
  EXPECT_EQ(updates, 1);
  close_up_to(1);
  EXPECT_FALSE(B.update(false));
  EXPECT_EQ(updates, 2);
  EXPECT_TRUE(B.update(true));
  EXPECT_EQ(updates, 3);
}

/// Coarse matrices that are not positive definite: the algebraic hierarchy takes over, and the counts say why.
TEST(MeshMultigrid, GivesWayToTheAlgebraicOneWhereItFails)
{
  const Block block({2, 1}, {67, 35});
  LinearSolverOptions options;
  options.multigrid = "mesh";
  LinearSolver solver(options, block.H, analysis::body_of(block.d), [&] {
    MeshLevels levels = block.levels();
    CrsMatrix &coarsest = *levels.level.back().stiffness;
    coarsest.resumeFill();
    coarsest.scale(-1.);
    coarsest.fillComplete();
    return levels;
  });
  const Vector b = block.vector(8);
  Vector x(b.getMap()), Hx(b.getMap());
  const auto result = solver.solve(b, x, 1e-8);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_NE(solver.counts().fallback.find("not positive definite"), std::string::npos) << solver.counts().fallback;
  block.H->apply(x, Hx);
  EXPECT_LT(relative_difference(Hx, b), 1.1e-8);
}

/// A mesh of few unknowns that could be solved directly has a coarser one all the same; where none can be had, none is used.
TEST(MeshMultigrid, TakesSmallMeshes)
{
  const Block block({2, 1}, {12, 6});
  const Vector b = block.vector(10);
  Vector x(b.getMap());
  const auto solver = block.solver();
  EXPECT_TRUE(solver->solve(b, x, 1e-8).converged);
  EXPECT_EQ(solver->counts().fallback, "");
  LinearSolverOptions options;
  options.multigrid = "mesh";
  LinearSolver without(options, block.H, analysis::body_of(block.d), [] { return MeshLevels(); });
  EXPECT_TRUE(without.solve(b, x, 1e-8).converged);
  EXPECT_NE(without.counts().fallback, "");
}

} // namespace
} // namespace mesh_multigrid_test
