// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/bounded_update.hpp"

#include "rpc/algebra/along_points.hpp"
#include "updated.hpp"

#include <Tpetra_Core.hpp>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

namespace bounded_update_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// Three nodes on each rank, whose blocks of K are full and different, with a point at each.
template <int Dim>
struct Nodes {
  NodePoints points;
  RCP<UpdatedOperator> H;

  Nodes()
  {
    constexpr LO n = 3;
    const auto comm = Tpetra::getDefaultComm();
    const auto map = rcp(new Map(static_cast<std::size_t>(n) * Dim * comm->getSize(), std::size_t(n) * Dim, 0, comm));
    const auto K = rcp(new CrsMatrix(map, Dim));
    for (LO row = 0; row < num_local(*map); ++row)
      for (int l = 0; l < Dim; ++l) {
        const GO column = dof(Dim, node_of(Dim, map->getGlobalElement(row)), l);
        const int k = component_of(Dim, row);
        K->insertGlobalValues(map->getGlobalElement(row), Teuchos::tuple(column),
                              Teuchos::tuple(k == l ? 4. + k + row / Dim : 0.5 + 0.25 * k * l));
      }
    K->fillComplete();
    points.dim = Dim;
    points.first = HostView<LO *>("first", 2);
    points.first(1) = n;
    points.node = DeviceView<LO *>("node", n);
    points.weight = DeviceView<double *>("weight", n);
    points.direction = DeviceView<double **>("direction", n, Dim);
    const auto node = Kokkos::create_mirror_view(points.node);
    const auto direction = Kokkos::create_mirror_view(points.direction);
    for (LO i = 0; i < n; ++i) {
      node(i) = i;
      double length = 0;
      for (int k = 0; k < Dim; ++k) length += std::pow(direction(i, k) = std::sin(1 + i + 2 * k), 2);
      for (int k = 0; k < Dim; ++k) direction(i, k) /= std::sqrt(length);
    }
    Kokkos::deep_copy(points.node, node);
    Kokkos::deep_copy(points.direction, direction);
    Kokkos::deep_copy(points.weight, 0.5);
    H = updated(K, points);
  }
  /// The same block at all nodes.
  void set(const std::array<std::array<double, 3>, 3> &values) const
  {
    const DeviceView<double ***> block("block", points.size(), Dim, Dim);
    const auto to = Kokkos::create_mirror_view(block);
    for (LO i = 0; i < points.size(); ++i)
      for (int k = 0; k < Dim; ++k)
        for (int l = 0; l < Dim; ++l) to(i, k, l) = values[k][l];
    Kokkos::deep_copy(block, to);
    H->set(points, block);
  }
};

template <class T>
class BoundedUpdate : public testing::Test
{
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BoundedUpdate, Dimensions);

TYPED_TEST(BoundedUpdate, OfOneDirectionBoundsItsStiffnessByTheNodesOwn)
{
  constexpr int dim = TypeParam::value;
  const Nodes<dim> nodes;
  const auto own = to_host(own_stiffness(nodes.H->base(), nodes.points));
  HostView<double *> a("a", 3), expected("expected", 3);
  for (const double most : {1., 5.}) {
    for (LO i = 0; i < 3; ++i) {
      a(i) = 0.5 * own(i) * (i == 0 ? 0.7 : i == 1 ? 3 : 1e5);
      expected(i) = std::min(a(i), most * own(i) * 0.5);
    }
    nodes.H->set(nodes.points, along_directions(nodes.points, a));
    const auto bounded = to_host(bounded_update(*nodes.H, most));
    const auto by_formula = to_host(along_directions(nodes.points, expected));
    for (LO i = 0; i < 3; ++i)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
          EXPECT_NEAR(bounded(i, k, l), by_formula(i, k, l), 1e-15 * std::max(a(i), expected(i))) << i << k << l;
  }
}

TYPED_TEST(BoundedUpdate, LeavesWhatIsBelowTheBoundAsItIs)
{
  constexpr int dim = TypeParam::value;
  const Nodes<dim> nodes;
  nodes.set({{{2, 0.1, 0.3}, {0.1, 1, 0.2}, {0.3, 0.2, 1.5}}});
  for (const auto &same : {bounded_update(*nodes.H, 5), bounded_update(*nodes.H)}) {
    const auto bounded = to_host(same), update = to_host(nodes.H->update());
    for (LO i = 0; i < 3; ++i)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) EXPECT_EQ(bounded(i, k, l), update(i, k, l));
  }
}

TYPED_TEST(BoundedUpdate, OfADiagonalBlockBoundsEachEntryExactly)
{
  constexpr int dim = TypeParam::value;
  const Nodes<dim> nodes;
  nodes.set({{{1e5, 0, 0}, {0, 0.5, 0}, {0, 0, 1e7}}});
  const auto bounded = to_host(bounded_update(*nodes.H, 2)), base = to_host(nodes.H->base_blocks());
  for (LO i = 0; i < 3; ++i)
    for (int k = 0; k < dim; ++k)
      for (int l = 0; l < dim; ++l)
        EXPECT_EQ(bounded(i, k, l), k != l ? 0 : k == 1 ? 0.5 : 2 * base(i, k, k)) << i << k << l;
}

/// Friction: the symmetric part counts, and what is negative of it makes no preconditioner.
TYPED_TEST(BoundedUpdate, OfABlockThatIsNotSymmetricIsSymmetricAndNotNegative)
{
  constexpr int dim = TypeParam::value;
  const Nodes<dim> nodes;
  nodes.set({{{100, 0, 0}, {30, 0, 0}, {20, 0, 0}}});
  ASSERT_FALSE(nodes.H->is_symmetric());
  const auto whole = to_host(bounded_update(*nodes.H)), bounded = to_host(bounded_update(*nodes.H, 1));
  for (LO i = 0; i < 3; ++i) {
    for (int k = 0; k < dim; ++k)
      for (int l = 0; l < dim; ++l) EXPECT_NEAR(bounded(i, k, l), bounded(i, l, k), 1e-14);
    EXPECT_EQ(whole(i, 0, 1), 15);
    EXPECT_EQ(whole(i, 1, 0), 15);
    for (const double angle : {0., 0.4, 1., 1.7, 2.4}) {
      const double x[3] = {std::cos(angle), std::sin(angle), 0.3 * std::sin(3 * angle)};
      double energy = 0;
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) energy += x[k] * bounded(i, k, l) * x[l];
      EXPECT_GE(energy, -1e-13);
    }
  }
}

} // namespace
} // namespace bounded_update_test
