// SPDX-License-Identifier: BSD-3-Clause
#include "factor/local_correction.hpp"

#include "foundation_scene.hpp"
#include "rpc/algebra/bounded_update.hpp"
#include "rpc/solver/exact_line_search.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Functional, operator, line search and local correction for a body in space.

namespace space_test
{
namespace
{

using namespace rpc;

/// A block of 2 m x 1 m x 1 m, held at its top, on a foundation whose normal is not an axis and whose yield stress and gap vary,
/// and between walls at two sides.
struct Block {
  fem::Discretization d;
  fem::ElasticProblem elastic;
  std::shared_ptr<contact::Iterate> iterate;
  const fem::Material material{10, 0.3};

  Block()
  {
    const mesh::BoxOptions box{{0, 0, 0}, {2, 1, 1}, {6, 3, 3}, {3, 1}};
    d = fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
    const auto load = rcp(new Vector(d.owned_dofs));
    fem::add_body_force(d, {ScalarField(0.3), ScalarField(-2.), ScalarField(0.5)}, "Body Force", *load);
    const fem::DirichletCondition held{"top", "top", {ScalarField(0.), ScalarField(0.), ScalarField(0.)}};
    const auto dirichlet = fem::dirichlet_dofs(d, {held});
    const auto K = fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, material), dirichlet.fixed);
    auto below = test::below(40), beside = test::beside(25);
    below.gap = test::field([](const Point &x) { return 0.02 * (1 - x[0]) + 0.01 * x[2]; });
    below.normal = contact::Normal::fixed;
    below.direction = {0.36, -0.8, 0.48};
    const auto nodes = contact::contact_nodes(d, {below, beside}, dirichlet, material);
    elastic = fem::elastic_problem(d, K.couplings, load, dirichlet);
    iterate = std::make_shared<contact::Iterate>(elastic, nodes, test::updated(K.matrix, nodes));
  }

  /// Waves that depend on the place alone: 0 where prescribed.
  RCP<Vector> vector(const double scale, const double phase) const
  {
    const auto v = rcp(new Vector(d.owned_dofs));
    const auto to = v->getLocalViewHost(Tpetra::Access::OverwriteAll);
    const auto x = to_host(d.mesh->coords);
    const auto fixed = to_host(elastic.dirichlet.fixed);
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
      for (int k = 0; k < 3; ++k) {
        const double angle = phase + 5 * x(n, 0) + 3 * x(n, 1) + 4 * x(n, 2) + 2 * k;
        to(3 * n + k, 0) = fixed(3 * n + k) ? 0 : scale * std::sin(angle);
      }
    return v;
  }
};

Vector plus(const Vector &u, const double t, const Vector &d)
{
  Vector sum(u, Teuchos::Copy);
  sum.update(t, d, 1.);
  return sum;
}

void expect_all_states(const contact::StateCounts &states)
{
  ASSERT_GT(states.open, 0);
  ASSERT_GT(states.closed, 0);
  ASSERT_GT(states.yielding, 0);
}

constexpr double step = 1e-5; // of differences: keeps each point on its piece, where M is quadratic

TEST(InSpace, GradientIsTheDerivativeOfTheFunctional)
{
  const Block block;
  const auto u = block.vector(0.05, 0.4), d = block.vector(1, 2);
  expect_all_states(block.iterate->functional().count_states(*u));
  Vector F(u->getMap());
  block.iterate->gradient(*u, F);
  const double difference =
      (block.iterate->value(plus(*u, step, *d)) - block.iterate->value(plus(*u, -step, *d))) / (2 * step);
  EXPECT_NEAR(difference, F.dot(*d), 1e-9 * F.norm2() * d->norm2());
}

TEST(InSpace, HessianIsTheDerivativeOfTheGradient)
{
  const Block block;
  const auto u = block.vector(0.05, 0.4), d = block.vector(1, 2);
  EXPECT_GT(block.iterate->update_hessian(*u), 0);
  Vector Hd(u->getMap()), up(u->getMap()), down(u->getMap()), Ad(u->getMap());
  block.iterate->hessian()->apply(*d, Hd);
  block.iterate->gradient(plus(*u, step, *d), up);
  block.iterate->gradient(plus(*u, -step, *d), down);
  up.update(-1., down, 1.);
  up.update(-1., Hd, 1 / (2 * step));
  EXPECT_LT(up.norm2(), 1e-9 * Hd.norm2());
  const UpdatedOperator &H = *block.iterate->hessian();
  const auto A = H.base().copy();
  write_update(*A, H, H.update());
  A->apply(*d, Ad);
  Ad.update(-1., Hd, 1.);
  EXPECT_LT(Ad.norm2(), 1e-14 * Hd.norm2()) << "the matrix has the update too";
}

TEST(InSpace, SweepLowersTheFunctional)
{
  const Block block;
  const auto u = block.vector(0.05, 0.4);
  Vector moved(*u, Teuchos::Copy);
  block.iterate->sweep(moved);
  EXPECT_LT(block.iterate->value(moved), block.iterate->value(*u));
  EXPECT_GT(plus(moved, -1, *u).norm2(), 1e-3 * u->norm2());
}

TEST(InSpace, ExactStepEndsWhereTheDirectionIsNoDescentAnyMore)
{
  const Block block;
  const auto u = block.vector(0.05, 0.4), d = block.vector(1, 2);
  Vector F(u->getMap());
  block.iterate->gradient(*u, F);
  if (F.dot(*d) > 0) d->scale(-1.);
  const double t = solver::exact_step(*block.iterate->along(*u, *d, F));
  ASSERT_GT(t, 0);
  Vector there(u->getMap());
  const Vector at = plus(*u, t, *d);
  block.iterate->gradient(at, there);
  EXPECT_NEAR(there.dot(*d) / F.dot(*d), 0, 1e-12);
  for (const double other : {0.9 * t, 1.1 * t})
    EXPECT_GT(block.iterate->value(plus(*u, other, *d)), block.iterate->value(at));
}

/// A preconditioner that does nothing.
class Identity : public Operator
{
public:
  explicit Identity(RCP<const Map> map) : map_(std::move(map)) {}
  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const override
  {
    y.update(1., x, 0.);
  }

private:
  RCP<const Map> map_;
};

TEST(InSpace, LocalCorrectionIsSymmetricPositiveAndExactAtChangedPoints)
{
  const Block block;
  auto &H = *block.iterate->hessian();
  block.iterate->update_hessian(*block.vector(0.05, 0.4));
  const auto A = H.base().copy();
  const auto written = bounded_update(H);
  write_update(*A, H, written);
  block.iterate->update_hessian(*block.vector(0.05, 1.4));
  const auto correction = solver::LocalCorrection::around(H, *A, written);
  ASSERT_TRUE(correction);
  const auto x = block.vector(1, 0.2), y = block.vector(1, 2.5);
  const Identity M(x->getMap());
  Vector Bx(x->getMap()), By(x->getMap()), rest(x->getMap());
  correction->apply(M, *x, Bx);
  correction->apply(M, *y, By);
  EXPECT_NEAR(Bx.dot(*y), By.dot(*x), 1e-12 * std::sqrt(Bx.dot(*x) * By.dot(*y)));
  EXPECT_GT(Bx.dot(*x), 0);
  H.apply(Bx, rest);
  rest.update(-1., *x, 1.);
  EXPECT_GT(solver::num_changes(H, written), 5);
  const auto node = to_host(H.nodes());
  const auto before = to_host(written), now = to_host(bounded_update(H));
  const auto at = rest.getLocalViewHost(Tpetra::Access::ReadOnly);
  const double scale = A->getFrobeniusNorm() * Bx.norm2();
  for (std::size_t i = 0; i < node.extent(0); ++i) {
    bool changed = false;
    for (int k = 0; k < 3; ++k) changed = changed || now(i, k, k) != before(i, k, k);
    for (int k = 0; k < 3 && changed; ++k) EXPECT_NEAR(at(3 * node(i) + k, 0), 0, 1e-12 * scale) << i;
  }
}

} // namespace
} // namespace space_test
