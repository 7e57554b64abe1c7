#include "rpc/algebra/updated_operator.hpp"

#include "foundation_scene.hpp"

#include <gtest/gtest.h>

namespace
{

using namespace rpc;
using namespace rpc::test;

/// K of a block with contact points on two of its sides, which share a node, and an operator that starts from it.
struct Stiffness {
  Scene scene{std::vector{below(40), beside(40)}};
  CrsMatrix K{*scene.functional->hessian()->matrix(), Teuchos::Copy};
  UpdatedOperator H{rcp(new CrsMatrix(K, Teuchos::Copy)), scene.functional->contact()};
  RCP<Vector> u = scene.vector(1, 0.3);

  /// (contact nodes) value(i) where the node is to be stiffened, 0 at held ones.
  DeviceView<double *> added(const std::function<double(LO)> &value) const
  {
    const auto fixed = to_host(scene.functional->contact().fixed);
    HostView<double *> host("added", fixed.extent(0));
    for (std::size_t i = 0; i < host.extent(0); ++i) host(i) = fixed(i) ? 0 : value(static_cast<LO>(i));
    return to_device(host);
  }
  /// K u + sum_i added_i w_i m_i (m_i . u), by hand.
  Vector by_hand(const DeviceView<double *> &added) const
  {
    Vector y(u->getMap());
    K.apply(*u, y);
    const auto &c = scene.functional->contact();
    const auto node = to_host(c.node);
    const auto m = to_host(c.direction);
    const auto w = to_host(c.weight), s = to_host(added);
    const auto x = u->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto to = y.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (LO i = 0; i < c.size(); ++i) {
      const double along = m(i, 0) * x(2 * node(i), 0) + m(i, 1) * x(2 * node(i) + 1, 0);
      for (int k = 0; k < 2; ++k) to(2 * node(i) + k, 0) += s(i) * w(i) * along * m(i, k);
    }
    return y;
  }
  double difference(const Operator &A, const Vector &y) const
  {
    Vector Au(u->getMap());
    A.apply(*u, Au);
    Au.update(-1., y, 1.);
    return Au.norm2() / y.norm2();
  }
};

TEST(UpdatedOperator, AppliesWhatWasAddedWhetherWrittenOrNot)
{
  Stiffness s;
  const auto some = s.added([](const LO i) { return i % 2 ? 30. : 0.; });
  EXPECT_GT(s.H.set(some), 0);
  EXPECT_LT(s.difference(s.H, s.by_hand(some)), 1e-14);
  EXPECT_LT(s.difference(*s.H.matrix(), s.by_hand(s.added([](LO) { return 0.; }))), 1e-14);
  s.H.write();
  EXPECT_LT(s.difference(s.H, s.by_hand(some)), 1e-14);
  EXPECT_LT(s.difference(*s.H.matrix(), s.by_hand(some)), 1e-14);
}

TEST(UpdatedOperator, HasARevisionForEachChange)
{
  Stiffness s;
  const int first = s.H.revision();
  const auto all = s.added([](LO) { return 7.; });
  const GO free = s.scene.functional->contact().num_total - s.scene.functional->contact().num_fixed;
  EXPECT_EQ(s.H.set(all), free);
  EXPECT_EQ(s.H.revision(), first + 1);
  EXPECT_EQ(s.H.set(all), 0);
  s.H.write();
  EXPECT_EQ(s.H.revision(), first + 1);
}

TEST(UpdatedOperator, ListsNodesThatDifferFromTheMatrix)
{
  Stiffness s;
  const auto all = s.added([](LO) { return 7.; });
  const GO free = s.scene.functional->contact().num_total - s.scene.functional->contact().num_fixed;
  const auto &comm = *s.u->getMap()->getComm();
  EXPECT_EQ(sum_all(comm, GO(s.H.changes().size())), 0);
  s.H.set(all);
  EXPECT_EQ(sum_all(comm, GO(s.H.changes().size())), free);
  s.H.write();
  EXPECT_EQ(sum_all(comm, GO(s.H.changes().size())), 0);
  s.H.set(s.added([](const LO i) { return i == 0 ? 0. : 7.; }));
  const auto changes = s.H.changes();
  const auto coefficient = to_host(changes.coefficient), w = to_host(s.scene.functional->contact().weight);
  const auto node = to_host(changes.node), of = to_host(s.scene.functional->contact().node);
  ASSERT_LE(changes.size(), 1);
  if (changes.size() == 1) {
    EXPECT_EQ(node(0), of(0));
    EXPECT_DOUBLE_EQ(coefficient(0), -7 * w(0));
  }
}

TEST(UpdatedOperator, OfLargePenaltiesLeavesNoRoundingInTheElasticProduct)
{
  Stiffness s;
  Vector Ku(s.u->getMap()), same(s.u->getMap());
  s.K.apply(*s.u, Ku);
  s.H.set(s.added([](LO) { return 1e12; }));
  s.H.write();
  s.H.apply_base(*s.u, same);
  same.update(-1., Ku, 1.);
  EXPECT_LE(same.norm2(), 1e-15 * Ku.norm2());
  s.H.set(s.added([](LO) { return 0.; })); // released, with the penalty still in the matrix
  EXPECT_LE(s.difference(s.H, Ku), 1e-15);
}

TEST(UpdatedOperator, IsWrittenUpToABound)
{
  Stiffness s;
  const auto own = to_host(s.H.own_stiffness());
  const auto soft_and_hard = [&](const double hard) {
    return s.added([&](const LO i) { return (i % 2 ? hard : 0.5) * own(i); });
  };
  s.H.set(soft_and_hard(100));
  s.H.write(5);
  EXPECT_LT(s.difference(s.H, s.by_hand(soft_and_hard(100))), 1e-13);
  EXPECT_LT(s.difference(*s.H.matrix(), s.by_hand(soft_and_hard(5))), 1e-14);
  const auto changes = s.H.changes();
  const auto coefficient = to_host(changes.coefficient);
  for (LO i = 0; i < changes.size(); ++i) EXPECT_GT(coefficient(i), 0);
}

TEST(UpdatedOperator, OfSweepsBoundsTheEnergyOfAllMovesAtOnce)
{
  Stiffness s;
  const auto &c = s.scene.functional->contact();
  const auto node = to_host(c.node);
  const auto m = to_host(c.direction);
  const auto kappa = to_host(s.H.coupled_stiffness());
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
        alone += to_host(s.H.own_stiffness())(i) * to_host(c.weight)(i) / (length * length) * move * move;
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
      rounded ? s.H.apply_base_rounded(*s.u, y) : s.H.apply_base(*s.u, y);
    return y;
  };
  const auto distance = [](Vector a, const Vector &b) {
    a.update(-1., b, 1.);
    return a.norm2();
  };
  const double force = product(false, false).norm2();
  EXPECT_EQ(distance(product(true, false), product(false, false)), 0) << "before it is allowed to";
  s.H.allow_rounding(true);
  s.H.set(s.added([](LO) { return 1e12; })); // single precision would be off by 1e5
  for (const bool with_update : {false, true})
    EXPECT_LT(distance(product(true, with_update), product(false, with_update)), 1e-6 * force);
  s.H.allow_rounding(false);
  EXPECT_EQ(distance(product(true, true), product(false, true)), 0);
}

} // namespace
