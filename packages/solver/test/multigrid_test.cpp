// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/multigrid.hpp"

#include "grid.hpp"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <gtest/gtest.h>
#include <string>

// What stands in for factories of MueLu gives MueLu's own hierarchy.

namespace multigrid_test
{
namespace
{

using namespace rpc;
using rpc::test::Grid;

/// Smoothed aggregation with a coarse level that smooths only: MueLu's direct solvers are wrong on several ranks.
Teuchos::ParameterList list_for(const Grid &grid, const std::string &reuse = "none")
{
  Teuchos::ParameterList list;
  list.set("verbosity", "none");
  list.set("number of equations", 2);
  list.set("aggregation: deterministic", true);
  list.set("smoother: type", "CHEBYSHEV");
  list.sublist("smoother: params").set("chebyshev: max eigenvalue", 2.6); // estimates start with random numbers
  list.set("coarse: type", "RELAXATION");
  list.set("coarse: max size", 50);
  list.set("reuse: type", reuse);
  list.sublist("user data").set("Coordinates", grid.coordinates);
  list.sublist("user data").set("Nullspace", grid.null_space);
  return list;
}

Vector applied(const Operator &preconditioner, const Vector &b)
{
  Vector x(b.getMap());
  preconditioner.apply(b, x);
  return x;
}

/// |x - y| / |y|
double difference(const Vector &x, const Vector &y)
{
  Vector d(x, Teuchos::Copy);
  d.update(-1., y, 1.);
  return d.norm2() / y.norm2();
}

void expect_muelus_own(const Grid &grid)
{
  const Vector b = grid.right_side();
  auto list = list_for(grid);
  list.set("use kokkos refactor",
           false); // its factories for many threads form other aggregates, which rpc replaces on purpose
  const auto plain = list;
  const auto muelus = MueLu::CreateTpetraPreconditioner(RCP<Operator>(grid.A), list);
  const auto ours = solver::make_multigrid(grid.A, plain);
  EXPECT_GT(ours->GetHierarchy()->GetNumLevels(), 1);
  EXPECT_EQ(ours->GetHierarchy()->GetNumLevels(), muelus->GetHierarchy()->GetNumLevels());
  EXPECT_LT(difference(applied(*ours, b), applied(*muelus, b)), 1e-12);
}

TEST(Multigrid, OfUnknownsThatLieNodeByNodeIsMueLus)
{
  expect_muelus_own(Grid(24));
}

TEST(Multigrid, OfNodesWithGapsBetweenTheirNumbersIsMueLus)
{
  expect_muelus_own(Grid(24, [](const GO unknown) { return 6 * (unknown / 2) + unknown % 2; }));
}

void expect_falling_residuals(const Grid &grid, const Operator &multigrid)
{
  const Vector b = grid.right_side();
  Vector x(grid.map);
  double before = 1;
  for (int cycle = 0; cycle < 4; ++cycle) {
    Vector r(b, Teuchos::Copy);
    grid.A->apply(x, r, Teuchos::NO_TRANS, -1., 1.);
    x.update(1., applied(multigrid, r), 1.);
    const double now = grid.relative_residual(x, b);
    EXPECT_LT(now, 0.7 * before) << cycle;
    before = now;
  }
}

TEST(Multigrid, LowersTheResidualOfEachCycle)
{
  const Grid grid(24);
  expect_falling_residuals(grid, *solver::make_multigrid(grid.A, list_for(grid)));
}

TEST(Multigrid, RenewedForAScaledMatrixIsTheScaledInverse)
{
  for (const char *reuse : {"tP", "RP"}) {
    const Grid grid(24);
    const Vector b = grid.right_side();
    auto multigrid = solver::make_multigrid(grid.A, list_for(grid, reuse));
    const Vector before = applied(*multigrid, b);
    grid.A->resumeFill();
    grid.A->scale(4.);
    grid.A->fillComplete();
    ASSERT_TRUE(solver::renew_multigrid(grid.A, multigrid));
    Vector after = applied(*multigrid, b);
    after.scale(4.);
    EXPECT_LT(difference(after, before), 1e-3) << reuse; // eigenvalues for the smoothers are estimated anew
  }
}

/// Entries of 0 among the unknowns of the last rank become a little.
void fill_zeros_of_last_rank(CrsMatrix &A)
{
  const Comm &comm = *A.getComm();
  A.resumeFill();
  if (comm.getRank() == comm.getSize() - 1) {
    const auto rows = A.getRowMap(), columns = A.getColMap();
    const auto local = A.getLocalMatrixHost();
    for (LO row = 0; row < num_local(*rows); ++row)
      for (std::size_t e = local.graph.row_map(row); e < local.graph.row_map(row + 1); ++e)
        if (local.values(e) == 0 && rows->isNodeGlobalElement(columns->getGlobalElement(local.graph.entries(e))))
          local.values(e) = 0.01;
  }
  A.fillComplete();
}

TEST(Multigrid, IsRenewedOnAllRanksWhereZerosOfOneRankFill)
{
  for (const char *reuse : {"tP", "RP"}) {
    SCOPED_TRACE(reuse);
    const Grid grid(
        24, [](const GO unknown) { return unknown; }, true);
    auto multigrid = solver::make_multigrid(grid.A, list_for(grid, reuse));
    fill_zeros_of_last_rank(*grid.A);
    const bool renewed = solver::renew_multigrid(grid.A, multigrid);
    EXPECT_EQ(renewed, !multigrid.is_null());
    if (grid.map->getComm()->getSize() > 1) {
      ASSERT_TRUE(renewed);
    }
    if (renewed) expect_falling_residuals(grid, *multigrid);
  }
}

} // namespace
} // namespace multigrid_test
