// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/gathered_solver.hpp"
#include "multigrid/guarded_solver.hpp"

#include "expect_error.hpp"
#include "grid.hpp"
#include "rpc/core/muelu.hpp"

#include <MueLu_Level.hpp>
#include <MueLu_NoFactory.hpp>
#include <gtest/gtest.h>
#include <stdexcept>

namespace gathered_solver_test
{
namespace
{

using namespace rpc;
using rpc::test::Grid;
using solver::GatheredSolver;

/// Set up for a matrix, as MueLu does it on its coarsest level.
void set_up(GatheredSolver &solver, const RCP<CrsMatrix> &A)
{
  MueLu::Level level;
  level.Set("A", muelu::to_xpetra(A));
  solver.SetFactory("A", MueLu::NoFactory::getRCP());
  level.Request(solver);
  solver.Setup(level);
}

MultiVector applied(const GatheredSolver &solver, const MultiVector &b, const double start)
{
  const auto right = rcp(new MultiVector(b, Teuchos::Copy)), left = rcp(new MultiVector(b.getMap(), b.getNumVectors()));
  left->putScalar(start);
  const RCP<XpetraVectors> from = muelu::to_xpetra(right), to = muelu::to_xpetra(left);
  solver.Apply(*to, *from, false);
  return MultiVector(*left, Teuchos::Copy);
}

TEST(GatheredSolver, SolvesForEachVectorWhateverItStartsFrom)
{
  const Grid grid(9);
  GatheredSolver solver;
  set_up(solver, grid.A);
  MultiVector b(grid.map, 3);
  const Vector first = grid.right_side();
  for (const int column : {0, 2}) b.getVectorNonConst(column)->update(1. + column, first, 0.);
  b.getVectorNonConst(1)->putScalar(1.);
  for (const double start : {0., 1e3}) {
    const MultiVector x = applied(solver, b, start);
    for (int column = 0; column < 3; ++column)
      EXPECT_LT(grid.relative_residual(Vector(x, column), Vector(b, column)), 1e-13) << column;
  }
}

TEST(GatheredSolver, CopyBeforeSetupAsMueLuMakesOne)
{
  const Grid grid(4);
  const auto copy = GatheredSolver().Copy();
  auto &solver = dynamic_cast<GatheredSolver &>(*copy);
  EXPECT_FALSE(solver.IsSetup());
  set_up(solver, grid.A);
  EXPECT_TRUE(solver.IsSetup());
  const Vector b = grid.right_side();
  EXPECT_LT(grid.relative_residual(Vector(applied(solver, b, 0), 0), b), 1e-13);
}

TEST(GatheredSolver, FollowsNewValuesOfTheMatrix)
{
  const Grid grid(5);
  GatheredSolver solver;
  set_up(solver, grid.A);
  grid.A->resumeFill();
  grid.A->scale(4.);
  grid.A->fillComplete();
  set_up(solver, grid.A);
  const Vector b = grid.right_side();
  EXPECT_LT(grid.relative_residual(Vector(applied(solver, b, 0), 0), b), 1e-13);
}

TEST(GatheredSolver, RefusesAMatrixThatIsNotPositiveDefiniteOnAllRanks)
{
  const Grid grid(4);
  grid.A->resumeFill();
  grid.A->scale(-1.);
  grid.A->fillComplete();
  GatheredSolver solver;
  EXPECT_THROW(set_up(solver, grid.A), std::runtime_error);
}

TEST(GatheredSolver, RefusesALevelOfTooManyRowsOnAllRanks)
{
  const Grid grid(51); // 5202 rows
  GatheredSolver solver;
  test::expect_error(ExitCode::bad_input, {"5202 rows", "at most 5000", "coarse: max size"},
                     [&] { set_up(solver, grid.A); });
}

/// Fails where it is told to, on the first rank alone.
class Failing : public solver::CoarseSolver
{
public:
  Failing(const bool in_setup, const bool in_apply) : in_setup_(in_setup), in_apply_(in_apply) {}
  void DeclareInput(MueLu::Level &) const override {}
  void Setup(MueLu::Level &) override { fail_if(in_setup_); }
  void Apply(XpetraVectors &x, const XpetraVectors &b, bool) const override
  {
    fail_if(in_apply_);
    x.update(2., b, 0.);
  }
  RCP<solver::CoarseSolver> Copy() const override { return rcp(new Failing(in_setup_, in_apply_)); }
  std::size_t getNodeSmootherComplexity() const override { return 0; }

private:
  static void fail_if(const bool here)
  {
    if (here && Tpetra::getDefaultComm()->getRank() == 0) throw std::runtime_error("singular");
  }
  bool in_setup_, in_apply_;
};

TEST(GuardedSolver, TellsAllRanksOfAFailureOnOneByTheNorm)
{
  const Grid grid(4);
  const auto b = rcp(new MultiVector(grid.map, 1)), x = rcp(new MultiVector(grid.map, 1));
  b->putScalar(1.);
  const RCP<XpetraVectors> from = muelu::to_xpetra(b), to = muelu::to_xpetra(x);
  for (const auto &[in_setup, in_apply] : {std::pair{false, false}, {true, false}, {false, true}}) {
    const auto guarded = solver::GuardedSolver(rcp(new Failing(in_setup, in_apply))).Copy();
    MueLu::Level level;
    guarded->Setup(level);
    guarded->Apply(*to, *from, true);
    const double norm = Vector(*x, 0).normInf();
    if (in_setup || in_apply)
      EXPECT_TRUE(std::isnan(norm) || std::isnan(Vector(*x, 0).norm2()));
    else
      EXPECT_EQ(norm, 2);
  }
}

} // namespace
} // namespace gathered_solver_test
