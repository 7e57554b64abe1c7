#include "../src/gathered_solver.hpp"

#include "expect_error.hpp"
#include "grid.hpp"

#include <MueLu_Level.hpp>
#include <MueLu_NoFactory.hpp>
#include <MueLu_Utilities.hpp>
#include <gtest/gtest.h>
#include <stdexcept>

namespace
{

using namespace rpc;
using rpc::test::Grid;
using solver::GatheredSolver;

/// Set up for a matrix, as MueLu does it on its coarsest level.
void set_up(GatheredSolver &solver, const RCP<CrsMatrix> &A)
{
  MueLu::Level level;
  level.Set("A", RCP<solver::XpetraMatrix>(MueLu::TpetraCrs_To_XpetraMatrix<double, LO, GO, Node>(A)));
  solver.SetFactory("A", MueLu::NoFactory::getRCP());
  level.Request(solver);
  solver.Setup(level);
}

MultiVector applied(const GatheredSolver &solver, const MultiVector &b, const double start)
{
  const auto right = rcp(new MultiVector(b, Teuchos::Copy)), left = rcp(new MultiVector(b.getMap(), b.getNumVectors()));
  left->putScalar(start);
  const RCP<solver::XpetraVectors> from = MueLu::TpetraMultiVector_To_XpetraMultiVector<double, LO, GO, Node>(right),
                                   to = MueLu::TpetraMultiVector_To_XpetraMultiVector<double, LO, GO, Node>(left);
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

} // namespace
