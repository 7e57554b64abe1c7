// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/checkerboards.hpp"

#include "lines.hpp"
#include "rpc/core/device_values.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <vector>

/// What the Schur complement lacks for pressures that alternate from cell to cell.                     doc/theory.md (4.15a)
namespace checkerboards_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr int nx = 9, ny = 7, cells = nx * ny, nodes = (nx + 1) * (ny + 1), dofs = 2 * nodes;
constexpr double own = 4; // K_0's diagonal

/// A grid of unit squares of Q1 on each rank, whose left side is held: each mode is the mean of du_x/dx + du_y/dy, +-1/2 a node. The
/// stiffness of cells in the last row is not split.
struct Grid {
  RCP<const Map> of_cells, of_nodes, of_dofs;
  StiffDilatation dilatation;
  RCP<StiffnessOperator> soft;
  double s;

  explicit Grid(const double stiffness, const bool all_move = false) : s(stiffness)
  {
    const auto comm = Tpetra::getDefaultComm();
    const auto map = [&](const int n) { return rcp(new Map(GO(n) * comm->getSize(), n, 0, comm)); };
    of_cells = map(cells);
    of_nodes = map(nodes);
    of_dofs = map(dofs);
    const auto Z = rcp(new CrsMatrix(of_cells, 8)), N = rcp(new CrsMatrix(of_cells, 4));
    const auto K = rcp(new CrsMatrix(of_dofs, 2));
    for (int c = 0; c < cells; ++c)
      for (int a = 0; a < 4; ++a) {
        const double split = is_split(c) ? 1 : 0, moves = node_of(c, a) % (nx + 1) > 0 ? 0.5 * split : 0;
        const GO cell = of_cells->getMinGlobalIndex() + c, first = of_dofs->getMinGlobalIndex() + 2 * node_of(c, a);
        Z->insertGlobalValues(cell, Teuchos::tuple<GO>(first, first + 1),
                              Teuchos::tuple(a % 2 == 1 ? moves : -moves, a / 2 == 1 ? moves : -moves));
        N->insertGlobalValues(cell, Teuchos::tuple<GO>(of_nodes->getMinGlobalIndex() + node_of(c, a)),
                              Teuchos::tuple(split));
      }
    for (int n = 0; n < nodes; ++n)
      for (int k = 0; k < 2; ++k) {
        const GO first = of_dofs->getMinGlobalIndex() + 2 * n;
        K->insertGlobalValues(first + k, Teuchos::tuple<GO>(first, first + 1),
                              Teuchos::tuple(k == 0 ? own : 0., k == 1 ? own : 0.));
      }
    Z->fillComplete(of_dofs, of_cells);
    N->fillComplete(of_nodes, of_cells);
    K->fillComplete();
    std::vector<double> of_split(cells), ones(cells, 1.);
    for (int c = 0; c < cells; ++c) of_split[c] = is_split(c) ? s : 0;
    dilatation = {
        Z, N, all_move, device_values(of_split, "s"), device_values(ones, "wave"), device_values(ones, "bulk")};
    soft = rcp(new StiffnessOperator(K, 2));
  }
  static bool is_split(const int cell) { return cell < nx * (ny - 1); }
  static int node_of(const int cell, const int a) { return (nx + 1) * (cell / nx + a / 2) + cell % nx + a % 2; }

  /// Z diag(K_0)^-1 Z^T + 1/s, by the nodes that cells share.
  static Dense to_be_inverted(const double s)
  {
    Dense A(cells, cells);
    for (int c = 0; c < cells; ++c) {
      A(c, c) = is_split(c) ? 1 / s : 1;
      for (int d = 0; d < cells; ++d)
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b < 4; ++b) {
            if (node_of(c, a) != node_of(d, b) || node_of(c, a) % (nx + 1) == 0) continue;
            if (!is_split(c) || !is_split(d)) continue;
            A(c, d) += ((a % 2 == b % 2 ? 0.25 : -0.25) + (a / 2 == b / 2 ? 0.25 : -0.25)) / own;
          }
    }
    return A;
  }
  /// I - F
  static Dense without_smooth()
  {
    Dense G(cells, cells);
    std::vector<int> around(nodes);
    for (int c = 0; c < cells; ++c)
      for (int a = 0; a < 4; ++a) around[node_of(c, a)] += is_split(c);
    for (int c = 0; c < cells; ++c) {
      G(c, c) = 1;
      for (int d = 0; d < cells; ++d)
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b < 4; ++b)
            if (node_of(c, a) == node_of(d, b) && is_split(c) && is_split(d))
              G(c, d) -= 1. / (4 * around[node_of(c, a)]);
    }
    return G;
  }
};

/// Of A x = b.
Dense solution(Dense A, Dense b)
{
  int info = 0;
  Teuchos::LAPACK<int, double>().POSV('L', cells, 1, A.value.data(), cells, b.value.data(), cells, &info);
  EXPECT_EQ(info, 0);
  return b;
}

double dot(const Dense &x, const Dense &y)
{
  return std::inner_product(x.value.begin(), x.value.end(), y.value.begin(), 0.);
}

TEST(Checkerboards, LeaveConstantPressuresAlone)
{
  const Grid grid(100);
  const solver::Checkerboards C(grid.dilatation, *grid.soft);
  Vector x(grid.of_cells), y(grid.of_cells);
  for (int c = 0; c < cells; ++c) x.replaceLocalValue(c, Grid::is_split(c) ? 3 : 0);
  C.apply(x, y);
  EXPECT_LT(y.normInf(), 1e-11);
}

/// By hand: inside, the mean of a checkerboard at each node is 0, and it moves none of them, so that nothing but 1/s is left of the matrix. A
/// pressure that alternates in one direction moves all nodes, by 2 * 2 * (1/2)^2 a cell beside 4.
TEST(Checkerboards, AreAsSoftAsTheDilatationInsideTheBody)
{
  const Dense A = Grid::to_be_inverted(100), G = Grid::without_smooth();
  Dense board(cells, 1), stripes(cells, 1);
  for (int c = 0; c < cells; ++c) {
    stripes(c, 0) = c % nx % 2 == 0 ? 1 : -1;
    board(c, 0) = c / nx % 2 == 0 ? stripes(c, 0) : -stripes(c, 0);
  }
  const int inside = nx * 2 + 4;
  EXPECT_NEAR(product(A, board)(inside, 0), board(inside, 0) / 100, 1e-15);
  EXPECT_NEAR(product(G, board)(inside, 0), board(inside, 0), 1e-15);
  EXPECT_NEAR(product(A, stripes)(inside, 0), stripes(inside, 0) * (1 + 0.01), 1e-15);
  EXPECT_NEAR(product(G, stripes)(inside, 0), stripes(inside, 0), 1e-15);
}

/// A polynomial whose degree is 0.7 of the root of the condition number lies within 1 -+ 1/cosh(1.4) of the inverse, for all vectors. Above a
/// degree of 40, or of 4 where all pressures are said to move the body, it falls short of it for the softest ones, and is not much larger for
/// any.
TEST(Checkerboards, StandForTheInverse)
{
  const double error = 1 / std::cosh(1.4);
  for (const bool all_move : {false, true})
    for (const double s : {3., 30., 300., 1e5}) {
      const bool is_exact = all_move ? s < 10 : s < 1e4;
      const Grid grid(s, all_move);
      const solver::Checkerboards C(grid.dilatation, *grid.soft);
      const Dense A = Grid::to_be_inverted(s), G = Grid::without_smooth();
      for (int phase = 0; phase < 12; ++phase) {
        Dense x(cells, 1), y(cells, 1);
        for (int c = 0; c < cells; ++c)
          x(c, 0) = phase == 0   ? (c == 20)
                    : phase == 1 ? (c + c / nx) % 2 - 0.5
                                 : std::sin(phase + 12.9898 * c * phase);
        Vector given(grid.of_cells), found(grid.of_cells);
        for (int c = 0; c < cells; ++c) given.replaceLocalValue(c, x(c, 0));
        C.apply(given, found);
        for (int c = 0; c < cells; ++c) y(c, 0) = found.getData()[c];
        const Dense rest = product(G, x);
        const double expected = dot(rest, solution(A, rest));
        EXPECT_GT(dot(x, y), is_exact ? (1 - error) * expected : 0) << s << " " << phase;
        EXPECT_LT(dot(x, y), (1 + error) * expected) << s << " " << phase;
      }
    }
}

} // namespace
} // namespace checkerboards_test
