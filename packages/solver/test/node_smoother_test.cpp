// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/node_smoother.hpp"

#include "lines.hpp"
#include "rpc/core/device_values.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

namespace node_smoother_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using solver::NodeSmoother;

/// Eigenvalues of a diagonal matrix, by unknowns: 0.1 to 2.
double eigenvalue(const GO unknown)
{
  return 0.1 + 1.9 * static_cast<double>(unknown % 8) / 7;
}

/// Five nodes on each rank.
struct Nodes {
  int dim;
  RCP<const Map> dofs;
  RCP<CrsMatrix> A; // diagonal

  explicit Nodes(const int of) : dim(of)
  {
    const auto comm = Tpetra::getDefaultComm();
    const std::size_t local = 5 * dim;
    dofs = rcp(new Map(local * comm->getSize(), local, 0, comm));
    A = rcp(new CrsMatrix(dofs, 1));
    for (LO i = 0; i < num_local(*dofs); ++i) {
      const GO gid = dofs->getGlobalElement(i);
      A->insertGlobalValues(gid, Teuchos::tuple(gid), Teuchos::tuple(eigenvalue(gid)));
    }
    A->fillComplete();
  }
  NodeBlocks each(const std::vector<std::vector<double>> &block) const { return {{}, blocks(block)}; }
  /// (n, dim, dim) The same block n times.
  DeviceView<double ***> blocks(const std::vector<std::vector<double>> &block, const int n = 5) const
  {
    const DeviceView<double ***> result("block", n, dim, dim);
    const auto to = Kokkos::create_mirror_view(result);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) to(i, k, l) = block[k][l];
    Kokkos::deep_copy(result, to);
    return result;
  }
  NodeBlocks ones() const { return each({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}); }
  void expect_inverse(const NodeSmoother &smoother, const LO node, const std::vector<std::vector<double>> &value) const
  {
    const auto place = to_host(smoother.inverse_blocks().place);
    const auto inverse = to_host(smoother.inverse_blocks().block);
    const LO at = place.extent(0) == 0 ? node : place(node);
    for (int k = 0; k < dim; ++k)
      for (int l = 0; l < dim; ++l) EXPECT_NEAR(inverse(at, k, l), value[k][l], 1e-15) << node << k << l;
  }
};

TEST(NodeSmoother, InvertsItsBlocks)
{
  const Nodes plane(2), space(3);
  const NodeSmoother two(plane.A, plane.each({{4, 1}, {1, 3}}), {}, 1, {});
  const NodeSmoother three(space.A, space.each({{2, -1, 0}, {-1, 2, -1}, {0, -1, 2}}), {}, 1, {});
  for (LO n = 0; n < 5; ++n) {
    plane.expect_inverse(two, n, {{3. / 11, -1. / 11}, {-1. / 11, 4. / 11}});
    space.expect_inverse(three, n, {{0.75, 0.5, 0.25}, {0.5, 1, 0.5}, {0.25, 0.5, 0.75}});
  }
}

/// Blocks of stiff contact: their small eigenvalue is what is left of the body.
TEST(NodeSmoother, KeepsTheDigitsOfSmallEigenvalues)
{
  const Nodes plane(2);
  const double stiff = 1e8;
  const NodeSmoother smoother(plane.A, plane.each({{1 + stiff, stiff}, {stiff, 1 + stiff}}), {}, 1, {});
  const auto inverse = to_host(smoother.inverse_blocks().block); // eigenvalues 1 and 1 / (1 + 2 stiff)
  EXPECT_NEAR(inverse(0, 0, 0) - inverse(0, 0, 1), 1, 1e-7);
}

TEST(NodeSmoother, TakesTheSymmetricPartOfABlock)
{
  const Nodes plane(2);
  const NodeSmoother smoother(plane.A, plane.each({{4, 2}, {0, 3}}), {}, 1, {});
  plane.expect_inverse(smoother, 2, {{3. / 11, -1. / 11}, {-1. / 11, 4. / 11}});
}

TEST(NodeSmoother, ReplacesTheBlocksOfSomeNodes)
{
  const Nodes plane(2);
  NodeSmoother smoother(plane.A, plane.ones(), {}, 1, {});
  smoother.set_blocks(device_values(std::vector<LO>{1, 4}, "node"), plane.blocks({{4, 1}, {1, 3}}, 2));
  for (const LO n : {0, 2, 3}) plane.expect_inverse(smoother, n, {{1, 0}, {0, 1}});
  for (const LO n : {1, 4}) plane.expect_inverse(smoother, n, {{3. / 11, -1. / 11}, {-1. / 11, 4. / 11}});
}

TEST(NodeSmoother, ReplacesTheBlocksOfNodesThatShareThemWithOthers)
{
  const Nodes plane(2);
  const auto list = [](const std::vector<LO> &values) { return device_values(values, "nodes"); };
  const NodeBlocks shared{list({0, 1, 0, 0, 1}), plane.blocks({{2, 0}, {0, 4}}, 2)};
  NodeSmoother smoother(plane.A, shared, list({1, 3}), 1, {});
  for (const LO n : {0, 1, 2, 3, 4}) plane.expect_inverse(smoother, n, {{0.5, 0}, {0, 0.25}});
  smoother.set_blocks(list({3}), plane.blocks({{4, 1}, {1, 3}}, 1));
  for (const LO n : {0, 1, 2, 4}) plane.expect_inverse(smoother, n, {{0.5, 0}, {0, 0.25}});
  plane.expect_inverse(smoother, 3, {{3. / 11, -1. / 11}, {-1. / 11, 4. / 11}});
  smoother.set_blocks(list({1, 3}), plane.blocks({{1, 0}, {0, 1}}, 2));
  for (const LO n : {0, 2, 4}) plane.expect_inverse(smoother, n, {{0.5, 0}, {0, 0.25}});
  for (const LO n : {1, 3}) plane.expect_inverse(smoother, n, {{1, 0}, {0, 1}});
}

TEST(NodeSmoother, RefusesABlockThatIsNotDefiniteOnAllRanks)
{
  const Nodes plane(2);
  NodeSmoother smoother(plane.A, plane.ones(), {}, 1, {});
  const bool last = Tpetra::getDefaultComm()->getRank() == Tpetra::getDefaultComm()->getSize() - 1;
  const double nan = std::nan("");
  for (const double bad : {0.9, 1., nan}) { // determinant < 0, 0, NaN
    const auto node = device_values(last ? std::vector<LO>{3} : std::vector<LO>{}, "node");
    const auto block = plane.blocks({{bad, 1}, {1, bad}}, last ? 1 : 0);
    EXPECT_THROW(smoother.set_blocks(node, block), std::runtime_error) << bad;
  }
}

/// With D = 1 each error component is multiplied by T((c - eigenvalue) / r) / T(c / r), T Chebyshev's polynomial and c and r the
/// centre and the radius of what is damped.
TEST(NodeSmoother, IsChebyshevsPolynomial)
{
  const Nodes plane(2);
  constexpr double largest = 2, ratio = 5, centre = 1.2, radius = 0.8;
  const auto chebyshev = [](const int degree, const double x) {
    double before = 1, now = x;
    for (int k = 1; k < degree; ++k) before = std::exchange(now, 2 * x * now - before);
    return now;
  };
  for (const int degree : {1, 2, 3}) {
    const NodeSmoother smoother(plane.A, plane.ones(), {}, largest, {degree, ratio});
    const Vector solution = wave_on(plane.dofs, 0.2);
    Vector b(plane.dofs), x(plane.dofs);
    plane.A->apply(solution, b);
    const auto expect_error = [&](const Vector &before) {
      const auto was = before.getLocalViewHost(Tpetra::Access::ReadOnly);
      const auto is = x.getLocalViewHost(Tpetra::Access::ReadOnly);
      const auto exact = solution.getLocalViewHost(Tpetra::Access::ReadOnly);
      for (LO i = 0; i < num_local(*plane.dofs); ++i) {
        const double at = (centre - eigenvalue(plane.dofs->getGlobalElement(i))) / radius;
        const double factor = chebyshev(degree, at) / chebyshev(degree, centre / radius);
        EXPECT_NEAR(exact(i, 0) - is(i, 0), factor * (exact(i, 0) - was(i, 0)), 1e-14) << degree;
      }
    };
    smoother.start(b, x);
    expect_error(Vector(plane.dofs));
    const Vector before = wave_on(plane.dofs, 3);
    x.update(1., before, 0.);
    smoother.improve(b, x);
    expect_error(before);
  }
}

TEST(NodeSmoother, FindsTheLargestEigenvalue)
{
  for (const int dim : {2, 3}) {
    const Nodes nodes(dim);
    const double found = solver::largest_eigenvalue(*nodes.A, nodes.ones());
    EXPECT_GE(found, 2) << dim;
    EXPECT_LE(found, 2.2) << dim;
  }
  const Nodes plane(2);
  const double halved = solver::largest_eigenvalue(*plane.A, plane.each({{2, 0}, {0, 2}}));
  EXPECT_NEAR(halved, 0.5 * solver::largest_eigenvalue(*plane.A, plane.ones()), 1e-12);
  plane.A->resumeFill();
  plane.A->scale(-1.);
  plane.A->fillComplete();
  EXPECT_THROW(solver::largest_eigenvalue(*plane.A, plane.ones()), std::runtime_error);
}

} // namespace
} // namespace node_smoother_test
