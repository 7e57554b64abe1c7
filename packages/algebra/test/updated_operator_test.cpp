// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/updated_operator.hpp"

#include "foundation_scene.hpp"
#include "rpc/algebra/along_points.hpp"
#include "rpc/algebra/bounded_update.hpp"
#include "rpc/core/error.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace updated_operator_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// K of a block with contact points on two of its sides, which share a node, and an operator on it.
struct Stiffness {
  Scene scene{std::vector{below(40), beside(40)}};
  contact::ContactNodes points = scene.iterate->points();
  CrsMatrix K{*scene.iterate->hessian()->base().matrix(), Teuchos::Copy};
  RCP<const StiffnessOperator> base = rcp(new StiffnessOperator(rcp(new CrsMatrix(K, Teuchos::Copy)), 2));
  UpdatedOperator H{base, distinct_nodes({points.node})};
  RCP<Vector> u = scene.vector(1, 0.3);

  /// (contact nodes) w a(i) m m^T, 0 at held points.
  DeviceView<double ***> added(const std::function<double(LO)> &a) const
  {
    const auto fixed = to_host(points.fixed);
    const auto weight = to_host(points.weight);
    HostView<double *> host("added", fixed.extent(0));
    for (std::size_t i = 0; i < host.extent(0); ++i) host(i) = fixed(i) ? 0 : weight(i) * a(static_cast<LO>(i));
    return along_directions(points, host);
  }
  /// K u + sum_i e_i block_i e_i^T u, by hand.
  Vector by_hand(const DeviceView<double ***> &block) const
  {
    Vector y(u->getMap());
    K.apply(*u, y);
    const auto node = to_host(points.node);
    const auto B = to_host(block);
    const auto x = u->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto to = y.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (LO i = 0; i < points.size(); ++i)
      for (int k = 0; k < 2; ++k)
        for (int l = 0; l < 2; ++l) to(2 * node(i) + k, 0) += B(i, k, l) * x(2 * node(i) + l, 0);
    return y;
  }
  double difference(const Operator &A, const Vector &y) const
  {
    Vector Au(u->getMap());
    A.apply(*u, Au);
    Au.update(-1., y, 1.);
    return Au.norm2() / y.norm2();
  }
  GO num_nodes() const { return sum_all(*u->getMap()->getComm(), GO(H.nodes().extent(0))); }
};

TEST(UpdatedOperator, AddsTheBlocksOfAllPointsOfANode)
{
  Stiffness s;
  EXPECT_LT(s.num_nodes(), sum_all(*s.u->getMap()->getComm(), GO(s.points.size()))) << "a node of two sides";
  const auto some = s.added([](const LO i) { return i % 2 ? 30. : 0.; }), all = s.added([](LO) { return 7.; });
  for (const auto &block : {some, all}) {
    EXPECT_GT(s.H.set(s.points, block), 0);
    EXPECT_LT(s.difference(s.H, s.by_hand(block)), 1e-14);
    EXPECT_TRUE(s.H.is_symmetric());
  }
}

TEST(UpdatedOperator, TakesBlocksThatAreNotSymmetric)
{
  Stiffness s;
  const DeviceView<double ***> block("block", s.points.size(), 2, 2);
  const auto to = Kokkos::create_mirror_view(block);
  for (LO i = 0; i < s.points.size(); ++i)
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l) to(i, k, l) = std::sin(1 + i + 2 * k + 5 * l);
  Kokkos::deep_copy(block, to);
  s.H.set(s.points, block);
  EXPECT_LT(s.difference(s.H, s.by_hand(block)), 1e-14);
  EXPECT_FALSE(s.H.is_symmetric());
  Vector y(*s.u, Teuchos::Copy), expected(*s.u, Teuchos::Copy); // alpha and beta
  expected.update(-2., s.by_hand(block), 3.);
  s.H.apply(*s.u, y, Teuchos::NO_TRANS, -2, 3);
  y.update(-1., expected, 1.);
  EXPECT_LT(y.norm2(), 1e-14 * expected.norm2());
  s.H.set(s.points, s.added([](LO) { return 0.; }));
  EXPECT_TRUE(s.H.is_symmetric());
}

TEST(UpdatedOperator, HasARevisionForEachChange)
{
  Stiffness s;
  const int first = s.H.revision();
  const auto all = s.added([](LO) { return 7.; });
  EXPECT_GT(s.H.set(s.points, all), 0);
  EXPECT_EQ(s.H.revision(), first + 1);
  EXPECT_EQ(s.H.set(s.points, all), 0);
  EXPECT_EQ(s.H.revision(), first + 1);
  const bool has_first = s.points.size() > 0 && s.u->getMap()->getComm()->getRank() == 0;
  const auto fixed = to_host(s.points.fixed);
  const GO one = sum_all(*s.u->getMap()->getComm(), GO(has_first && !fixed(0)));
  EXPECT_EQ(s.H.set(s.points, s.added([&](const LO i) { return has_first && i == 0 ? 6. : 7.; })), one);
  ASSERT_EQ(one, 1);
}

/// The update and whether it is symmetric, on the same nodes.
TEST(UpdatedOperator, FollowsAnother)
{
  Stiffness s;
  UpdatedOperator twice(s.H.shared_base(), s.H.nodes());
  const auto expect_equal = [&] {
    twice.follow(s.H);
    EXPECT_EQ(twice.revision(), s.H.revision());
    EXPECT_EQ(twice.is_symmetric(), s.H.is_symmetric());
    Vector x(s.u->getMap()), y(s.u->getMap());
    s.H.apply(*s.u, x);
    twice.apply(*s.u, y);
    y.update(-1., x, 1.);
    EXPECT_EQ(y.norm2(), 0);
  };
  const auto added = s.added([](const LO i) { return 7. + i; });
  s.H.set(s.points, added);
  expect_equal();
  const int dim = s.H.dofs_per_node();
  const DeviceView<double ***> twist("twist", s.points.size(), dim, dim);
  const auto host = Kokkos::create_mirror_view(twist);
  for (LO i = 0; i < s.points.size(); ++i) host(i, 0, 1) = 1;
  Kokkos::deep_copy(twist, host);
  s.H.set(s.points, added, twist);
  EXPECT_FALSE(s.H.is_symmetric());
  expect_equal();
  const auto before = to_host(twice.update());
  s.H.set(s.points, s.added([](LO) { return 1.; }));
  const auto after = to_host(twice.update());
  for (std::size_t n = 0; n < before.extent(0); ++n)
    EXPECT_EQ(after(n, 0, 0), before(n, 0, 0)) << "until it follows again";
  expect_equal();
}

TEST(UpdatedOperator, RefusesPointsAtOtherNodes)
{
  Stiffness s;
  UpdatedOperator nowhere(s.base, DeviceView<LO *>());
  EXPECT_THROW(nowhere.set(s.points, s.added([](LO) { return 1.; })), Error);
}

TEST(UpdatedOperator, OfLargePenaltiesLeavesNoRoundingInTheElasticProduct)
{
  Stiffness s;
  Vector Ku(s.u->getMap()), same(s.u->getMap());
  s.K.apply(*s.u, Ku);
  s.H.set(s.points, s.added([](LO) { return 1e12; }));
  s.H.shared_base()->apply(*s.u, same);
  same.update(-1., Ku, 1.);
  EXPECT_LE(same.norm2(), 1e-15 * Ku.norm2());
  s.H.set(s.points, s.added([](LO) { return 0.; }));
  EXPECT_LE(s.difference(s.H, Ku), 1e-15);
}

TEST(UpdatedOperator, IsWrittenIntoACopyAndLeavesKAsItIs)
{
  Stiffness s;
  const auto block = s.added([](const LO i) { return i % 2 ? 30. : 0.; });
  const auto none = s.added([](LO) { return 0.; });
  s.H.set(s.points, block);
  const auto A = s.base->copy();
  EXPECT_EQ(A->getCrsGraph().get(), s.base->matrix()->getCrsGraph().get());
  write_update(*A, s.H, s.H.update());
  EXPECT_LT(s.difference(*A, s.by_hand(block)), 1e-14);
  EXPECT_LT(s.difference(*s.base, s.by_hand(none)), 1e-14);
  EXPECT_LT(s.difference(*s.base->matrix(), s.by_hand(none)), 1e-14);
  EXPECT_LT(s.difference(s.H, s.by_hand(block)), 1e-14);
}

TEST(UpdatedOperator, HasTheBlocksOfBothParts)
{
  Stiffness s;
  s.H.set(s.points, s.added([](const LO i) { return 10. + i; }));
  const auto A = s.base->copy();
  write_update(*A, s.H, s.H.update());
  const StiffnessOperator sum(A, 2);
  const auto expected = to_host(sum.diagonal_blocks(s.H.nodes())), blocks = to_host(s.H.blocks());
  const NodeBlocks own = s.base->diagonal_blocks();
  const auto all = to_host(own.block), base = to_host(s.H.base_blocks());
  const auto node = to_host(s.H.nodes());
  for (std::size_t n = 0; n < node.extent(0); ++n)
    for (int k = 0; k < 2; ++k)
      for (int l = 0; l < 2; ++l) {
        EXPECT_EQ(blocks(n, k, l), expected(n, k, l));
        EXPECT_EQ(base(n, k, l), all(node(n), k, l)); // none repeat
      }
}

TEST(UpdatedOperator, OfSweepsBoundsTheEnergyOfAllMovesAtOnce)
{
  Stiffness s;
  const auto &c = s.points;
  const auto node = to_host(c.node);
  const auto m = to_host(c.direction);
  const auto kappa = to_host(coupled_stiffness(*s.base, c)), own = to_host(own_stiffness(*s.base, c));
  const auto weight = to_host(c.weight);
  const auto coords = to_host(s.scene.d.mesh->coords);
  for (const double frequency : {0., 1., 20.}) { // moves together, and against each other
    Vector d(s.u->getMap()), Kd(s.u->getMap());
    double bound = 0, alone = 0;
    {
      const auto to = d.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (LO i = 0; i < c.size(); ++i) {
        const double length = std::hypot(m(i, 0), m(i, 1));
        if (length == 0) continue;
        const double move = std::cos(frequency * coords(node(i), 0));
        for (int k = 0; k < 2; ++k) to(2 * node(i) + k, 0) += move * m(i, k) / (length * length);
        bound += kappa(i) * move * move;
        alone += own(i) * weight(i) / (length * length) * move * move;
      }
    }
    s.K.apply(d, Kd);
    const auto &comm = *s.u->getMap()->getComm();
    EXPECT_LE(d.dot(Kd), sum_all(comm, bound)) << frequency;
    EXPECT_LE(sum_all(comm, bound), 6 * sum_all(comm, alone)) << "not far above the nodes' own";
  }
}

TEST(UpdatedOperator, RoundsTheBodyButNotTheUpdate)
{
  Stiffness s;
  const auto product = [&](const bool rounded, const bool with_update) {
    Vector y(s.u->getMap());
    if (with_update)
      rounded ? s.H.apply_rounded(*s.u, y) : s.H.apply(*s.u, y);
    else
      rounded ? s.H.apply_base_rounded(*s.u, y) : s.H.shared_base()->apply(*s.u, y);
    return y;
  };
  const auto distance = [](Vector a, const Vector &b) {
    a.update(-1., b, 1.);
    return a.norm2();
  };
  const double force = product(false, false).norm2();
  EXPECT_EQ(distance(product(true, false), product(false, false)), 0) << "before it is allowed to";
  EXPECT_FALSE(s.H.is_rounded());
  s.H.allow_rounding(true);
  s.H.set(s.points, s.added([](LO) { return 1e12; })); // single precision would be off by 1e5
  for (const bool with_update : {false, true})
    EXPECT_LT(distance(product(true, with_update), product(false, with_update)), 1e-6 * force);
  s.H.allow_rounding(false);
  EXPECT_EQ(distance(product(true, true), product(false, true)), 0);
}

} // namespace
} // namespace updated_operator_test
