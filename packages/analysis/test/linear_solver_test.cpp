// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/linear_solver.hpp"

#include "clamped_block.hpp"
#include "rpc/core/parallel.hpp"

#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace linear_solver_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using solver::LinearSolver;
using solver::LinearSolverOptions;
using solver::MeshLevels;

/// Cells 312:1 of a beam: K has the condition number 3e13. Rounding leaves a residual on the patch of the local correction, and CG
/// breaks down with an x that is as good as can be.
TEST(LinearSolver, GoesOnFromTheResidualWhereRoundingEndsCG)
{
  if (Tpetra::getDefaultComm()->getSize() > 1) GTEST_SKIP() << "the factor of the whole matrix is that of one rank";
  const Block block({2, 2}, {16, 24}, false, {1, 0.0048});
  LinearSolverOptions options;
  options.multigrid = "algebraic";
  options.muelu.set("coarse: max size", 100000); // a factor
  options.reuse = "none";
  LinearSolver solver(options, block.H, analysis::body_of(block.d));
  const Vector b = block.vector(11);
  Vector x(b.getMap()), residual(b.getMap());
  for (int k = 0; k < 2; ++k) {
    block.close([k](const double place) { return std::fmod(place + 0.03 * k, 0.25) < 0.05; });
    for (const double tolerance : {5e-3, 1e-6}) {
      const auto result = solver.solve(b, x, tolerance);
      EXPECT_FALSE(result.broken) << result.reason;
      block.H->apply(x, residual);
      residual.update(1., b, -1.);
      EXPECT_LT(std::sqrt(solver.inverse_energy(residual) / solver.inverse_energy(b)), 1e-4);
    }
  }
}

/// Few unknowns are factored for each choice of states, unless the deck says otherwise.
TEST(LinearSolver, FactorsFewUnknowns)
{
  const Block block({2, 1}, {20, 10});
  const Vector b = block.vector(12);
  Vector x(b.getMap());
  int setups = 0;
  const auto iterations = [&](const std::function<void(LinearSolverOptions &)> &set) {
    LinearSolverOptions options;
    set(options);
    LinearSolver solver(options, block.H, analysis::body_of(block.d));
    int most = 0;
    for (const double end : {0., 0.7, 1.3}) {
      block.close([end](const double at) { return at < end; });
      const auto result = solver.solve(b, x, 1e-6);
      EXPECT_TRUE(result.converged) << result.reason;
      most = std::max(most, result.iterations);
    }
    setups = solver.counts().preconditioner_setups;
    return most;
  };
  EXPECT_EQ(iterations([](LinearSolverOptions &) {}), 1);
  EXPECT_EQ(setups, 3);
  const auto small_levels = [](LinearSolverOptions &options) { options.muelu.set("coarse: max size", 20); };
  EXPECT_GT(iterations(small_levels), 1);
  EXPECT_EQ(setups, 1) << "a patch follows the states";
}

/// Where nothing holds the body there is no factor; that is a result, not an exception.
TEST(LinearSolver, TellsWhereFewUnknownsHaveNoFactor)
{
  const Block block({2, 1}, {20, 10});
  const auto K = fem::assemble_stiffness(block.d, block.model.materials); // nothing is prescribed
  K->resumeFill();
  K->scale(-1.);
  K->fillComplete();
  const auto H = test::updated(K, block.points);
  LinearSolver solver({}, H, analysis::body_of(block.d));
  const Vector b = block.vector(13);
  Vector x(b.getMap());
  EXPECT_FALSE(solver.solve(b, x, 1e-6).converged);
}

TEST(LinearSolver, TakesMeshesUnlessMueLuIsGiven)
{
  const Block block({2, 1}, {167, 135});
  const Vector b = block.vector(9);
  Vector x(b.getMap());
  const auto makes_levels = [&](const std::function<void(LinearSolverOptions &)> &set) {
    bool made = false;
    LinearSolverOptions options;
    set(options);
    LinearSolver solver(options, block.H, analysis::body_of(block.d), [&] {
      made = true;
      return block.levels();
    });
    EXPECT_TRUE(solver.solve(b, x, 1e-6).converged);
    return made;
  };
  EXPECT_TRUE(makes_levels([](LinearSolverOptions &) {}));
  EXPECT_FALSE(makes_levels([](LinearSolverOptions &options) { options.multigrid = "algebraic"; }));
  EXPECT_FALSE(makes_levels([](LinearSolverOptions &options) { options.muelu.set("max levels", 3); }));
  EXPECT_TRUE(makes_levels([](LinearSolverOptions &options) {
    options.muelu.set("max levels", 3);
    options.multigrid = "mesh";
  }));
}

/// All points of a plate get springs of so small a part of their own stiffness.
void support_slightly(const Block &plate, const double part)
{
  const auto own = to_host(own_stiffness(plate.H->base(), plate.points)), weight = to_host(plate.points.weight);
  HostView<double *> added("added", plate.points.size());
  for (LO i = 0; i < plate.points.size(); ++i) added(i) = part * own(i) * weight(i);
  plate.H->set(plate.points, along_directions(plate.points, added));
}

/// All points change, too many for terms of rank one. What is 1e-8 of a node's stiffness costs CG a few iterations; 1e-6 holds the plate
/// against bending, and asks for a new factor.                                                                   (4.12)
TEST(LinearSolver, LeavesSlightChangesOfContactToCGWhileThatIsCheaperThanAFactor)
{
  const Block plate({3, 1}, {48, 48, 1}, true, {1, 1, 0.01});
  LinearSolverOptions options;
  options.expected_iterations = 400;
  LinearSolver solver(options, plate.H, analysis::body_of(plate.d));
  const Vector b = plate.vector(15);
  Vector x(b.getMap());
  struct Case {
    double part;
    int setups; // since the start
  };
  for (const auto &[part, setups] : {Case{0, 1}, {1e-12, 1}, {1e-10, 1}, {1e-8, 1}, {1e-6, 2}, {1, 3}}) {
    SCOPED_TRACE(part);
    support_slightly(plate, part);
    const auto result = solver.solve(b, x, 1e-8);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LT(plate.residual(x, b), 1.01e-8);
    EXPECT_EQ(solver.counts().preconditioner_setups, setups);
    EXPECT_LE(result.iterations, 6);
  }
  for (const int iterations : solver.counts().iterations)
    EXPECT_LE(iterations, 10) << "one that is given up is so soon";
  EXPECT_EQ(solver.counts().iterations.size(), 7U) << "one is given up";
}

/// The same on meshes, whose coarsest one is factored: a change is followed once solves have cost as much time as that, and until then no
/// more than in one solve; the next changes are put off again.
TEST(LinearSolver, FollowsSlightChangesOfContactOnTheCoarsestMeshOnceTheyCostIterations)
{
  const Block plate({3, 1}, {48, 48, 2}, true, {1, 1, 0.01});
  const auto solver = plate.solver();
  const Vector b = plate.vector(15);
  Vector x(b.getMap());
  const auto iterations = [&](const double part) {
    support_slightly(plate, part);
    const auto result = solver->solve(b, x, 1e-8);
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_LT(plate.residual(x, b), 1.01e-8);
    return result.iterations;
  };
  const int usual = iterations(0);
  EXPECT_LE(iterations(1e-10), usual + 4) << "nearly nothing has changed";
  EXPECT_GT(iterations(1e-3), usual + 8) << "else this tells nothing of what follows";
  int solves = 1; // by the predicted times, which are those of all ranks together
  while (iterations(1e-3 * (1 + 0.1 * solves)) > usual + 2) ASSERT_LE(++solves, 3) << "it is never followed";
  EXPECT_LE(iterations(1e-3 * (1 + 0.11 * solves)), usual + 2) << "little has changed since";
  EXPECT_LE(iterations(1), usual + 2) << "more than slight";
  EXPECT_EQ(solver->counts().preconditioner_setups, 1);
}

/// x by a dense factor of the whole matrix, which is made column by column.
Vector solved_densely(const Operator &H, const Vector &b)
{
  const Map &map = *b.getMap();
  const int n = static_cast<int>(map.getGlobalNumElements());
  const LO own = num_local(map);
  std::vector<double> matrix(static_cast<std::size_t>(n) * n), x(n);
  Vector unit(b.getMap()), column(b.getMap());
  const auto place = [&](const LO i) { return static_cast<std::size_t>(map.getGlobalElement(i)); };
  const auto copy = [&](const Vector &from, double *const to) {
    const auto values = from.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO i = 0; i < own; ++i) to[place(i)] = values(i, 0);
  };
  for (int j = 0; j < n; ++j) {
    const LO here = map.getLocalElement(j);
    unit.putScalar(0);
    if (here >= 0) unit.replaceLocalValue(here, 1.);
    H.apply(unit, column);
    copy(column, matrix.data() + static_cast<std::size_t>(n) * j);
  }
  copy(b, x.data());
  matrix = summed(*map.getComm(), matrix);
  x = summed(*map.getComm(), x);
  std::vector<int> pivots(n);
  int info = 0;
  Teuchos::LAPACK<int, double>().GESV(n, 1, matrix.data(), n, pivots.data(), x.data(), n, &info);
  EXPECT_EQ(info, 0);
  Vector solution(b.getMap());
  for (LO i = 0; i < own; ++i) solution.replaceLocalValue(i, x[place(i)]);
  return solution;
}

/// Friction's tangent at closed nodes, with the coefficient of friction 0.3: the tangential force follows the normal one,
/// s w m m^T + 0.3 s w t m^T. Preconditioners take its symmetric part.
TEST(LinearSolver, SolvesByGmresWhereContactIsNotSymmetric)
{
  const Block block({2, 1}, {16, 9});
  const auto own = to_host(own_stiffness(block.H->base(), block.points)), weight = to_host(block.points.weight);
  const auto direction = to_host(block.points.direction);
  const DeviceView<double ***> update("update", block.points.size(), 2, 2);
  const auto host_update = Kokkos::create_mirror_view(update);
  constexpr double stiffness = 1, friction = 0.3;
  for (LO i = 0; i < block.points.size(); ++i) {
    const double m[2] = {direction(i, 0), direction(i, 1)}, t[2] = {m[1], -m[0]};
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l)
        host_update(i, k, l) = stiffness * own(i) * weight(i) * (m[k] + friction * t[k]) * m[l];
  }
  EXPECT_TRUE(block.H->is_symmetric());
  Kokkos::deep_copy(update, host_update);
  block.H->set(block.points, update);
  EXPECT_FALSE(block.H->is_symmetric());
  const Vector b = block.vector(14);
  const Vector expected = solved_densely(*block.H, b);
  Vector x(b.getMap());
  struct Kind {
    const char *multigrid, *path;
    int most;
  };
  for (const Kind &kind :
       {Kind{"mesh", "meshes", 20}, {"algebraic", "algebraic", 20}, {"auto", "sparse factor: few unknowns", 15}}) {
    LinearSolverOptions options;
    options.multigrid = kind.multigrid;
    LinearSolver solver(options, block.H, analysis::body_of(block.d),
                        kind.path == std::string("meshes") ? solver::MakeMeshLevels([&] { return block.levels(); })
                                                           : solver::MakeMeshLevels());
    const auto result = solver.solve(b, x, 1e-9);
    EXPECT_TRUE(result.converged) << kind.path << ": " << result.reason;
    EXPECT_GT(result.iterations, 2) << kind.path;
    EXPECT_LE(result.iterations, kind.most) << kind.path;
    EXPECT_LT(relative_difference(x, expected), 1e-6) << kind.path;
    EXPECT_EQ(solver_path(solver.counts()), kind.path);
  }
}

} // namespace
} // namespace linear_solver_test
