// SPDX-License-Identifier: BSD-3-Clause
/// The smoothed functional of foundations that harden, are elastic, or both.
#include "functional_checks.hpp"
#include "rpc/contact/iterate.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace other_foundations_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// The two foundations with these numbers in place of the perfectly plastic ones.
std::vector<contact::ContactOptions> foundations(const double hardening, const double stiffness)
{
  std::vector options{below(40), beside(25)};
  for (auto &side : options) {
    side.hardening = field([hardening](const Point &x) { return hardening * (1 + 0.3 * x[0]); });
    side.stiffness = ScalarField(stiffness);
  }
  return options;
}
const std::vector<std::vector<contact::ContactOptions>> &all_foundations()
{
  static const double inf = std::numeric_limits<double>::infinity();
  static const std::vector<std::vector<contact::ContactOptions>> all{foundations(9, inf), foundations(0, 80),
                                                                     foundations(9, 80)};
  return all;
}
void expect_all_states(const contact::Iterate &iterate, const Vector &u)
{
  const auto states = iterate.functional().count_states(u);
  EXPECT_GT(states.open, 0);
  EXPECT_GT(states.closed, 0);
  EXPECT_GT(states.yielding, 0);
}

TEST(OtherFoundations, GradientAndHessianAreDerivativesOnEachPiece)
{
  for (const auto &options : all_foundations()) {
    const Scene scene(options);
    auto &iterate = *scene.iterate;
    const auto u = scene.vector(0.08, 0.4), d = scene.vector(1, 2);
    expect_all_states(iterate, *u);
    Vector F(u->getMap());
    iterate.gradient(*u, F);
    const double h = 1e-5;
    const double difference = (iterate.value(*plus(*u, h, *d)) - iterate.value(*plus(*u, -h, *d))) / (2 * h);
    EXPECT_NEAR(difference, F.dot(*d), 1e-9 * F.norm2() * d->norm2());
    EXPECT_GT(iterate.update_hessian(*u), 0);
    EXPECT_EQ(iterate.update_hessian(*u), 0);
    EXPECT_LT(hessian_error(iterate, *u, *d), 1e-9);
  }
}

TEST(OtherFoundations, LineModelGivesTheSlopeOfTheFunctional)
{
  for (const auto &options : all_foundations()) {
    const Scene scene(options);
    auto &iterate = *scene.iterate;
    const auto u = scene.vector(0.08, 0.4), d = scene.vector(0.1, 2);
    expect_line_model(iterate, *u, *d);
    expect_lines_within(iterate, *u, {d, scene.vector(0.3, 0.7), scene.vector(0.02, 5)});
  }
}

TEST(OtherFoundations, ActiveSetGradientIsTheGradientOnItsOwnPiece)
{
  for (const auto &options : all_foundations()) {
    const Scene scene(options);
    auto &iterate = *scene.iterate;
    const auto u = scene.vector(0.08, 0.4), far = scene.vector(0.15, 1.1);
    iterate.update_hessian(*u);
    Vector F(u->getMap()), G(u->getMap());
    iterate.gradient(*u, F);
    active_set_gradient(iterate, *u, G);
    G.update(-1., F, 1.);
    EXPECT_LT(G.norm2(), 1e-13 * F.norm2());
    active_set_gradient(iterate, *far, G);
    iterate.gradient(*far, F);
    G.update(-1., F, 1.);
    EXPECT_GT(G.norm2(), 1e-3 * F.norm2());
  }
}

TEST(OtherFoundations, ResidualDualityGapAndEnergyAgreeWhereTheLawHoldsAndTellWhereItDoesNot)
{
  for (const auto &options : all_foundations()) {
    const Scene scene(options);
    auto &iterate = *scene.iterate;
    const auto u = scene.vector(0.08, 0.4);
    iterate.duals().update(*scene.vector(0.08, 3.4));
    EXPECT_GT(contact_law_residual(iterate, *u), 1e-3);
    EXPECT_GT(contact_energy(iterate, *u).duality_gap, 1e-4);
    for (int k = 0; k < 400; ++k) iterate.duals().update(*u); // at a fixed u
    EXPECT_LT(contact_law_residual(iterate, *u), 1e-13);
    EXPECT_NEAR(contact_energy(iterate, *u).duality_gap, 0, 1e-13);
    // J = Pi + sum of w psi(v), by hand: psi is what is in springs, and what new dents have taken up
    const auto &c = iterate.points();
    const auto weight = to_host(c.weight), xi = to_host(c.law.yield), gap = to_host(c.gap),
               H = to_host(c.law.hardening), compliance = to_host(c.law.compliance),
               lambda = to_host(iterate.duals().multipliers().normal);
    const auto node = to_host(c.node);
    const auto n = to_host(c.normal);
    const auto fixed = to_host(c.fixed);
    const auto x = u->getLocalViewHost(Tpetra::Access::ReadOnly);
    double stored = 0, lost = 0, held = 0;
    for (LO i = 0; i < c.size(); ++i) {
      const double v = n(i, 0) * x(2 * node(i), 0) + n(i, 1) * x(2 * node(i) + 1, 0) - gap(i);
      if (fixed(i)) { // held 0.005 deep, less than yields
        held += weight(i) * (compliance(i) > 0 ? 0.5 * v * v / compliance(i) : xi(i) * v + 0.5 * H(i) * v * v);
        continue;
      }
      const double p = lambda(i), w = v > 0 ? v - compliance(i) * p : 0;
      EXPECT_NEAR(p,
                  std::max(0., compliance(i) > 0 ? std::min(v / compliance(i), xi(i) + H(i) * w)
                               : v > 0           ? xi(i) + H(i) * w
                                                 : 0.),
                  1e-12);
      stored += weight(i) * 0.5 * compliance(i) * p * p;
      if (p >= xi(i)) lost += weight(i) * (xi(i) * w + 0.5 * H(i) * w * w);
    }
    const Comm &comm = scene.d.mesh->comm();
    const double all_lost = sum_all(comm, lost), all_stored = sum_all(comm, stored);
    EXPECT_GT(all_lost, 1e-3);
    EXPECT_NEAR(contact_energy(iterate, *u).dissipated, all_lost, 1e-12);
    Vector Ku(u->getMap());
    Scene bare(std::vector<contact::ContactOptions>{});
    bare.iterate->hessian()->apply(*u, Ku);
    const double elastic = 0.5 * u->dot(Ku) - scene.elastic.load->dot(*u);
    EXPECT_NEAR(energy(iterate, scene.elastic, *u), elastic + all_lost + all_stored + sum_all(comm, held), 1e-11);
  }
}

TEST(OtherFoundations, SweepsLetItFallUntilContactForcesBalance)
{
  for (const auto &both : all_foundations()) {
    const Scene scene(std::vector{both[0]});
    expect_sweeps_to_balance(scene, 300, 1e-8);
  }
}

TEST(OtherFoundations, ActiveSetMovesClosingPointsOntoTheCompressedSpring)
{
  // What closes from open or yielding comes to v = c lambda: there r (v - c lambda) is no residual.
  const Scene scene(foundations(9, 80));
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(0.08, 0.4);
  iterate.update_hessian(*scene.vector(0.08, 2.2)); // an active set that is not that of u
  const auto choice = iterate.choose_active_set(*u, 0);
  const auto next = to_host(choice.state);
  const auto moved = rcp(new Vector(*u, Teuchos::Copy));
  iterate.take_active_set(choice, *moved);
  const auto &c = iterate.points();
  const auto node = to_host(c.node);
  const auto free_gap = to_host(c.free_gap), compliance = to_host(c.law.compliance), xi = to_host(c.law.yield),
             lambda = to_host(iterate.duals().multipliers().normal);
  const auto n = to_host(c.direction);
  const auto fixed = to_host(c.fixed);
  const auto x = moved->getLocalViewHost(Tpetra::Access::ReadOnly), old = u->getLocalViewHost(Tpetra::Access::ReadOnly);
  GO closing = 0;
  for (LO i = c.first(0); i < c.first(1); ++i) {
    const bool still = x(2 * node(i), 0) == old(2 * node(i), 0) && x(2 * node(i) + 1, 0) == old(2 * node(i) + 1, 0);
    if (fixed(i) || still || c.num_sides() == 0) continue;
    EXPECT_EQ(next(i), contact::State::closed);
    const double v = n(i, 0) * x(2 * node(i), 0) + n(i, 1) * x(2 * node(i) + 1, 0) - free_gap(i);
    bool of_both = false; // the corner is moved for its other side too
    for (LO j = c.first(1); j < c.first(2); ++j) of_both = of_both || node(j) == node(i);
    if (of_both) continue;
    EXPECT_NEAR(v, compliance(i) * lambda(i), 1e-14);
    EXPECT_LE(lambda(i), xi(i));
    ++closing;
  }
  EXPECT_GT(sum_all(scene.d.mesh->comm(), closing), 0);
}

} // namespace
} // namespace other_foundations_test
