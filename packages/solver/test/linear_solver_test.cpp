// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/linear_solver.hpp"

#include "supported_grid.hpp"

#include <gtest/gtest.h>
#include <initializer_list>
#include <stdexcept>
#include <string>

// What a linear solver does after a solve that failed, and for further right sides.

namespace linear_solver_test
{
namespace
{

using namespace rpc;
using rpc::test::SupportedGrid;
using solver::LinearSolver;
using solver::LinearSolverOptions;
using solver::MeshLevels;
using solver::solver_path;

constexpr int large = 40, small = 20; // 3200 unknowns, for a hierarchy that outlives the states, and 800, for a factor

LinearSolverOptions options_for(const std::string &multigrid)
{
  LinearSolverOptions options;
  options.multigrid = multigrid;
  return options;
}

bool contains(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}

TEST(RoughSolve, LeavesAPartWhereTheBodyWantsMore)
{
  const SupportedGrid body(large);
  auto options = options_for("algebraic");
  options.rough_part = 1e-3;
  const auto solver = body.solver(options);
  const Vector b = body.grid.right_side();
  Vector x(b.getMap());
  EXPECT_TRUE(solver->solve(b, x, {1e-3, 1e-30}).converged); // by the residual: no error is so small
  EXPECT_LT(body.residual(x, b), 1.01e-6);
  EXPECT_TRUE(solver->solve(b, x, 1e-3).converged);
  EXPECT_GT(body.residual(x, b), 1.01e-6) << "not rough";
  EXPECT_LT(body.residual(x, b), 1.01e-3);
}

TEST(FailedSolve, OfMeshesIsTakenOverByTheAlgebraicHierarchyWhichSaysWhy)
{
  const SupportedGrid body(large);
  const auto solver =
      body.solver(options_for("mesh"), []() -> MeshLevels { throw std::runtime_error("no such mesh"); });
  const Vector b = body.grid.right_side();
  Vector x(b.getMap());
  for (int k = 0; k < 2; ++k) {
    const auto result = solver->solve(b, x, 1e-8);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LT(body.residual(x, b), 1.01e-8);
  }
  const auto &counts = solver->counts();
  EXPECT_EQ(counts.fallback, "the linear solver broke down: no such mesh");
  EXPECT_EQ(solver_path(counts), "meshes -> algebraic: the linear solver broke down: no such mesh");
  EXPECT_EQ(counts.preconditioner_setups, 1);
  EXPECT_EQ(counts.iterations.size(), 3U) << "the meshes are not tried again";
  EXPECT_EQ(counts.iterations[0], 0);
  EXPECT_EQ(counts.iterations[1], counts.iterations[2]);
}

/// Springs that pull make H indefinite, for which no multigrid on meshes can be made. Where the algebraic hierarchy breaks down as well, it
/// is not the hierarchy that is to blame: the meshes are used again for other states.
TEST(FailedSolve, OfBothHierarchiesIsBrokenAndTheMeshesComeBack)
{
  const SupportedGrid body(large);
  LinearSolverOptions options = options_for("mesh");
  options.muelu.set("smoother: type", "no such smoother");
  const auto solver = body.solver(options, [&] { return body.levels(); });
  const Vector b = body.grid.right_side();
  Vector x(b.getMap());
  body.hold(0, 20, 5);
  const auto before = solver->solve(b, x, 1e-8);
  EXPECT_TRUE(before.converged) << before.reason;
  const Vector expected(x, Teuchos::Copy);
  std::size_t solves = 1;
  for (const int attempts : {2, 1}) { // the second time it is known that neither will do
    body.hold(0, 20, -500);
    const int revision = body.H->revision();
    const auto result = solver->solve(b, x, 1e-8);
    EXPECT_TRUE(result.broken);
    EXPECT_FALSE(result.converged);
    EXPECT_FALSE(result.interrupted);
    EXPECT_TRUE(contains(result.reason, "broke down")) << result.reason;
    EXPECT_EQ(body.H->revision(), revision) << "H is not touched";
    EXPECT_EQ(solver->counts().fallback, "") << "meshes were not given up";
    solves += attempts;
    EXPECT_EQ(solver->counts().iterations.size(), solves);
    body.hold(0, 20, 5);
    const auto after = solver->solve(b, x, 1e-8);
    EXPECT_TRUE(after.converged) << after.reason;
    EXPECT_EQ(after.iterations, before.iterations) << "with multigrid on meshes, as before";
    EXPECT_EQ(solver->counts().iterations.size(), ++solves);
    Vector difference(expected, Teuchos::Copy);
    difference.update(-1., x, 1.);
    EXPECT_LT(difference.norm2(), 1e-7 * expected.norm2());
  }
  const std::string path = solver_path(solver->counts());
  EXPECT_EQ(path.rfind("meshes -> algebraic: the linear solver broke down: ", 0), 0U) << path;
  EXPECT_TRUE(contains(path, " -> meshes: the matrix is singular")) << path;
}

/// CG that may take few iterations fails with a hierarchy that followed the states and with one made anew for them. Then a sparse factor
/// takes over where the deck leaves that open, else a stronger smoother.
TEST(FailedSolve, ForgetsAHierarchyThatFollowedTheStatesBeforeItTakesAStrongerOne)
{
  const SupportedGrid body(80); // a new factor takes longer than to follow some nodes
  for (const char *const multigrid : {"algebraic", "auto"}) {
    LinearSolverOptions options = options_for(multigrid);
    options.max_iterations = 5;
    const bool open = options.multigrid == "auto";
    const auto solver = body.solver(options);
    const Vector b = body.grid.right_side();
    Vector x(b.getMap());
    body.hold(0, 1, 0);
    EXPECT_TRUE(solver->solve(b, x, 0.1).converged);
    EXPECT_EQ(solver->counts().preconditioner_setups, 1);
    body.hold(3, 9, 100);
    EXPECT_TRUE(solver->solve(b, x, 0.1).converged);
    EXPECT_EQ(solver->counts().preconditioner_setups, 1);
    EXPECT_EQ(solver->counts().local_corrections, 1);
    const auto result = solver->solve(b, x, 1e-10);
    EXPECT_EQ(result.converged, open) << result.reason;
    const auto &iterations = solver->counts().iterations;
    ASSERT_EQ(iterations.size(), 5U);
    EXPECT_EQ(iterations[2], 5) << "as it followed";
    EXPECT_EQ(iterations[3], 5) << "anew";
    const std::string path = solver_path(solver->counts());
    EXPECT_EQ(path.rfind(std::string("algebraic -> algebraic: anew -> ") +
                             (open ? "sparse factor" : "stronger algebraic") + ": the linear solver stopped at ",
                         0),
              0U)
        << path;
    if (!open) continue;
    EXPECT_LE(iterations[4], 2) << "a factor";
    EXPECT_LT(body.residual(x, b), 1.01e-10);
    EXPECT_EQ(solver->counts().preconditioner_setups, 3);
    for (const GO to : {11, 9, 12}) { // it follows the states
      body.hold(3, to, 100);
      EXPECT_TRUE(solver->solve(b, x, 1e-10).converged);
      EXPECT_LT(body.residual(x, b), 1.01e-10);
      EXPECT_LE(solver->counts().iterations.back(), 2);
    }
    EXPECT_EQ(solver->counts().preconditioner_setups, 3);
    EXPECT_EQ(solver->counts().local_corrections, 4);
    const auto &candidates = solver->counts().candidates;
    ASSERT_EQ(candidates.size(), 2U);
    EXPECT_EQ(candidates[0].name, "sparse factor");
    EXPECT_EQ(candidates[0].setups, 1);
    EXPECT_EQ(candidates[0].solves, 4);
    EXPECT_EQ(candidates[0].left, "");
    EXPECT_EQ(candidates[1].name, "algebraic");
    EXPECT_EQ(candidates[1].setups, 2);
    EXPECT_EQ(candidates[1].solves, 4);
    EXPECT_TRUE(contains(candidates[1].left, "the linear solver stopped at ")) << candidates[1].left;
  }
}

TEST(FailedSolve, LeavesTheDecksChoiceAlone)
{
  const SupportedGrid body(large);
  LinearSolverOptions options = options_for("algebraic");
  options.max_iterations = 2;
  options.muelu.set("coarse: max size", 50);
  const auto solver = body.solver(options);
  const Vector b = body.grid.right_side();
  Vector x(b.getMap());
  const auto result = solver->solve(b, x, 1e-10);
  EXPECT_FALSE(result.converged);
  EXPECT_FALSE(result.broken) << "x is as far as it came";
  EXPECT_TRUE(contains(result.reason, "after 2 iterations")) << result.reason;
  EXPECT_LT(body.residual(x, b), 1);
  EXPECT_EQ(solver->counts().iterations.size(), 1U);
  EXPECT_EQ(solver_path(solver->counts()), "algebraic");
}

/// Where the body lets expect many iterations, of all solves that contact will ask for, there is a factor from the first solve on.
TEST(LinearSolver, TakesASparseFactorBeforeTheFirstSolveWhereManyIterationsAreExpected)
{
  const SupportedGrid body(large);
  const Vector b = body.grid.right_side();
  Vector x(b.getMap());
  for (const bool many : {false, true}) {
    LinearSolverOptions options = options_for("auto");
    options.expected_iterations = many ? 400 : 29; // a fair number is 30
    const auto solver = body.solver(options, [&] {
      EXPECT_FALSE(many) << "no coarse meshes are made in vain";
      return body.levels();
    });
    const auto result = solver->solve(b, x, 1e-9);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LT(body.residual(x, b), 1.01e-9);
    EXPECT_EQ(solver_path(solver->counts()), many ? "sparse factor: about 400 CG iterations expected" : "meshes");
    EXPECT_LE(result.iterations, many ? 2 : 29);
    EXPECT_EQ(solver->counts().iterations.size(), 1U);
    EXPECT_EQ(solver->counts().preconditioner_setups, 1);
  }
  LinearSolverOptions limited = options_for("auto"); // a few iterations are expected, and fewer allowed
  limited.expected_iterations = 31;
  for (const int limit : {40, 30}) {
    limited.max_iterations = limit;
    const auto of_few = body.solver(limited, [&] { return body.levels(); });
    EXPECT_TRUE(of_few->solve(b, x, 1e-9).converged);
    EXPECT_EQ(solver_path(of_few->counts()), limit == 30 ? "sparse factor: about 31 CG iterations expected" : "meshes");
  }
  LinearSolverOptions options = options_for("mesh");
  options.expected_iterations = 400;
  const auto solver = body.solver(options, [&] { return body.levels(); });
  EXPECT_TRUE(solver->solve(b, x, 1e-9).converged);
  EXPECT_EQ(solver_path(solver->counts()), "meshes") << "the deck says so";
}

/// H stands still: a second right side costs its iterations, and nothing else.
TEST(LinearSolver, SolvesForFurtherRightSidesWithoutASetUp)
{
  struct Kind {
    const char *multigrid;
    int nodes;
    const char *path;
  };
  for (const Kind &kind : {Kind{"mesh", large, "meshes"},
                           {"algebraic", large, "algebraic"},
                           {"auto", small, "sparse factor: few unknowns"}}) {
    const SupportedGrid body(kind.nodes);
    const auto solver = body.solver(options_for(kind.multigrid), [&] { return body.levels(); });
    const Vector first = body.grid.right_side();
    Vector second(first.getMap()), zero(first.getMap()), x(first.getMap());
    second.randomize();
    body.hold(0, 5, 100);
    EXPECT_TRUE(solver->solve(first, x, 0.1).converged);
    body.hold(0, 7, 100);
    const auto alone = solver->solve(first, x, 1e-8);
    EXPECT_TRUE(alone.converged) << alone.reason;
    const auto before = solver->counts();
    for (const Vector *const b : std::initializer_list<const Vector *>{&second, &first}) {
      x.putScalar(3.);
      EXPECT_TRUE(solver->solve(*b, x, 1e-8).converged);
      EXPECT_LT(body.residual(x, *b), 1.01e-8) << kind.path;
    }
    const auto &after = solver->counts();
    EXPECT_EQ(after.iterations.back(), alone.iterations) << kind.path;
    EXPECT_EQ(after.iterations.size(), before.iterations.size() + 2);
    EXPECT_EQ(after.preconditioner_setups, before.preconditioner_setups) << kind.path;
    EXPECT_EQ(after.local_corrections, before.local_corrections) << kind.path;
    EXPECT_EQ(after.setup_seconds, before.setup_seconds) << kind.path;
    EXPECT_EQ(solver_path(after), kind.path);
    EXPECT_TRUE(solver->solve(zero, x, 1e-8).converged);
    EXPECT_EQ(x.norm2(), 0) << kind.path;
  }
}

/// Hierarchies and corrections are those of the symmetric part; GMRES brings in the rest.
TEST(LinearSolver, FollowsStatesWhereTheUpdateIsNotSymmetric)
{
  for (const char *multigrid : {"mesh", "algebraic"}) {
    const SupportedGrid body(large);
    const auto solver = body.solver(options_for(multigrid), [&] { return body.levels(); });
    const Vector b = body.grid.right_side();
    Vector x(b.getMap());
    for (const GO to : {10, 20, 30}) {
      body.hold(5, to, 20, 0.3);
      EXPECT_FALSE(body.H->is_symmetric());
      const auto result = solver->solve(b, x, 1e-9);
      EXPECT_TRUE(result.converged) << multigrid << ": " << result.reason;
      EXPECT_LE(result.iterations, 40) << multigrid << " " << to;
      EXPECT_LT(body.residual(x, b), 1.01e-9) << multigrid << " " << to;
    }
    body.hold(5, 30, 20);
    EXPECT_TRUE(body.H->is_symmetric());
    EXPECT_TRUE(solver->solve(b, x, 1e-9).converged);
    EXPECT_LT(body.residual(x, b), 1.01e-9) << multigrid;
    EXPECT_EQ(solver->counts().preconditioner_setups, 1) << multigrid;
    EXPECT_EQ(solver->counts().fallback, "") << multigrid;
  }
}

} // namespace
} // namespace linear_solver_test
