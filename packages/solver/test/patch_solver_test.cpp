// SPDX-License-Identifier: BSD-3-Clause
#include "../src/patch_solver.hpp"

#include "lines.hpp"
#include "rpc/core/device_values.hpp"

#include <Teuchos_LAPACK.hpp>
#include <gtest/gtest.h>
#include <set>
#include <stdexcept>
#include <vector>

namespace patch_solver_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using solver::AddedBlocks;
using solver::PatchSolver;

constexpr int num_nodes = 24;

/// Neighbours are coupled by full blocks; all rows but those near the ends repeat.
Dense line_matrix(const int dim)
{
  Dense A(dim * num_nodes, dim * num_nodes);
  for (int n = 0; n < num_nodes; ++n)
    for (int m = std::max(0, n - 1); m <= std::min(num_nodes - 1, n + 1); ++m)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
          A(dof(dim, n, k), dof(dim, m, l)) = n == m ? (k == l ? 5 : 0.7) : -0.6 - 0.1 * (k + l);
  return A;
}
/// Contact couples nodes 2 to 5, each with itself and its neighbours among them.
double contact(const GO n, const GO m, const int k, const int l, const double size)
{
  if (std::min(n, m) < 2 || std::max(n, m) > 5 || std::abs(n - m) > 1) return 0;
  return size * ((n == m ? 2 : 0.3) * (k == l ? 1 : 0.2) + (n == m && n == 4 ? 3 * k * l : 0));
}

struct Line {
  int dim, length;
  RCP<const Map> nodes = line_of(num_nodes), unknowns;
  RCP<CrsMatrix> A;
  std::vector<GO> columns;
  NodePatches patches; // some nodes in a row, of which each rank has those that begin at its own; fewer at the end
  std::vector<LO> row, column;

  Line(const int unknowns_of_node, const int nodes_of_patch)
      : dim(unknowns_of_node), length(nodes_of_patch), unknowns(unknowns_of(*nodes, dim)),
        A(distributed(line_matrix(dim), unknowns, unknowns))
  {
    const Map &of = *A->getColMap();
    for (LO i = 0; i < num_local(of); i += dim) columns.push_back(node_of<GO>(dim, of.getGlobalElement(i)));
    for (LO n = 0; n < num_local(*nodes); ++n) {
      const GO first = nodes->getGlobalElement(n);
      if (first == num_nodes - 1) continue;
      for (GO m = first; m < std::min<GO>(first + length, num_nodes); ++m) patches.node.push_back(m);
      patches.begin.push_back(patches.node.size());
      for (std::size_t c = 0; c < columns.size(); ++c)
        if (contact(first, columns[c], 0, 0, 1) != 0) {
          row.push_back(n);
          column.push_back(static_cast<LO>(c));
        }
    }
  }
  DeviceView<double ***> blocks(const double size) const
  {
    const DeviceView<double ***> block("block", row.size(), dim, dim);
    const auto to = Kokkos::create_mirror_view(block);
    for (std::size_t b = 0; b < row.size(); ++b)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
          to(b, k, l) = contact(nodes->getGlobalElement(row[b]), columns[column[b]], k, l, size);
    Kokkos::deep_copy(block, to);
    return block;
  }
  PatchSolver solver(const double size) const
  {
    return {RepeatedRows::of(A, dim), nodes, columns, patches,
            AddedBlocks{device_values(row, "row"), device_values(column, "column"), blocks(size)}};
  }
  /// sum_p R_p^T (R_p (A + contact) R_p^T)^-1 R_p r
  std::vector<double> expected(const double size, const double phase) const
  {
    const Dense K = line_matrix(dim);
    std::vector<double> z(static_cast<std::size_t>(dim) * num_nodes);
    for (int first = 0; first + 1 < num_nodes; ++first) {
      const int count = dim * std::min(length, num_nodes - first);
      std::vector<double> matrix(static_cast<std::size_t>(count) * count), x(count);
      for (int i = 0; i < count; ++i) {
        x[i] = wave(dim * first + i, phase);
        for (int j = 0; j < count; ++j)
          matrix[count * i + j] =
              K(dim * first + i, dim * first + j) + contact(first + i / dim, first + j / dim, i % dim, j % dim, size);
      }
      int info = 0;
      std::vector<int> pivots(count);
      Teuchos::LAPACK<int, double>().GESV(count, 1, matrix.data(), count, pivots.data(), x.data(), count, &info);
      for (int i = 0; i < count; ++i) z[dim * first + i] += x[i];
    }
    return z;
  }
  void expect(const PatchSolver &B, const double size) const
  {
    for (const double phase : {0.3, 2.}) {
      Vector z(unknowns);
      B.apply(wave_on(unknowns, phase), z);
      const auto found = z.getLocalViewHost(Tpetra::Access::ReadOnly);
      const auto sum = expected(size, phase);
      for (LO i = 0; i < num_local(*unknowns); ++i)
        EXPECT_NEAR(found(i, 0), sum[unknowns->getGlobalElement(i)], 1e-13) << unknowns->getGlobalElement(i);
    }
  }
};

std::vector<Line> lines()
{
  return {{2, 3}, {3, 9}, {2, 15}}; // up to 30 unknowns a patch
}

TEST(PatchSolver, AddsExactSolvesUp)
{
  for (const Line &line : lines()) {
    line.expect(line.solver(0), 0);
    line.expect(line.solver(50), 50);
  }
}

TEST(PatchSolver, FollowsContact)
{
  for (const Line &line : lines()) {
    PatchSolver B = line.solver(0);
    for (const double size : {3., 1e5, 1e5, 0.}) {
      B.set_added(line.blocks(size));
      line.expect(B, size);
    }
  }
}

/// Patches of as many nodes have equal matrices, but for those that contact changes: they begin at nodes 0 to 5.
TEST(PatchSolver, SharesInversesOfPatchesThatAreAlike)
{
  for (const Line &line : lines()) {
    const PatchSolver B = line.solver(0);
    int changing = 0;
    std::set<std::size_t> sizes;
    for (int p = 0; p < line.patches.size(); ++p) {
      const bool changes = line.patches.node[line.patches.begin[p]] <= 5;
      changing += changes;
      if (!changes) sizes.insert(line.patches.begin[p + 1] - line.patches.begin[p]);
    }
    EXPECT_EQ(B.num_inverses(), changing + static_cast<int>(sizes.size()));
  }
}

TEST(PatchSolver, TellsAllRanksOfAMatrixThatIsNotPositiveDefinite)
{
  const Line line(2, 3);
  EXPECT_THROW(line.solver(-1e3), std::runtime_error);
  PatchSolver B = line.solver(0);
  EXPECT_THROW(B.set_added(line.blocks(-1e3)), std::runtime_error);
  B.set_added(line.blocks(2));
  line.expect(B, 2);
  line.A->resumeFill();
  line.A->scale(-1.);
  line.A->fillComplete();
  EXPECT_THROW(line.solver(0), std::runtime_error);
}

} // namespace
} // namespace patch_solver_test
