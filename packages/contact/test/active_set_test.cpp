// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/iterate.hpp"

#include "foundation_scene.hpp"
#include "rpc/algebra/along_points.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <optional>

namespace active_set_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr double yield = 3, penalty = 40;
constexpr int num_nodes = 7;

/// A body on its foundation; multipliers start at yield / 2 unless there is a gap.
contact::ContactOptions foundation(const double gap = 0)
{
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = ScalarField(yield);
  options.gap = ScalarField(gap);
  options.penalty = penalty;
  return options;
}

/// Presses lambda + r v up by these pressures, at the node x = 0 and at all others [Pa].
RCP<Vector> pressing(const Scene &scene, const double first, const double others)
{
  return scene.vector([&](const Point &x) { return Point{0, -(x[0] == 0 ? first : others) / penalty, 0}; });
}

/// Multipliers at the node x = 0 and at all others.
void expect_multipliers(const Scene &scene, const double first, const double others)
{
  const auto &c = scene.iterate->points();
  const auto coords = to_host(scene.d.mesh->coords);
  const auto node = to_host(c.node);
  const auto lambda = to_host(scene.iterate->duals().multipliers().normal);
  for (LO i = 0; i < c.size(); ++i)
    EXPECT_NEAR(lambda(i), coords(node(i), 0) == 0 ? first : others, 1e-14) << coords(node(i), 0);
}

/// A scene whose nodes are all closed, by a first choice without any penetration.
std::unique_ptr<Scene> all_closed()
{
  auto scene = std::make_unique<Scene>(std::vector{foundation()});
  EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, 0, 0)).changes, num_nodes);
  expect_multipliers(*scene, 1.5, 1.5);
  return scene;
}

TEST(ChooseStates, TakesThePressuresOfThePieceForMultipliersUpToTheLimits)
{
  auto scene = all_closed();
  EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, -1.6, 1.2)).changes, 1);
  expect_multipliers(*scene, 0, 2.7);
  scene = all_closed();
  EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, 1, 1.6)).changes, num_nodes - 1);
  expect_multipliers(*scene, 2.5, yield);
}

TEST(ChooseStates, AnOpenNodeClosesBeforeItYieldsHoweverDeepItIs)
{
  for (const double depth : {1e-9, 0.1, 1e3}) {
    const auto scene = all_closed();
    choose(*scene->iterate, *pressing(*scene, -1.6, 0)); // opens the first
    EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, depth * penalty, 0)).changes, 1);
    EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, 0, 0)).changes, 0) << "closed on the foundation, with p = 0";
    EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, 3.1, 0)).changes, 1);
    expect_multipliers(*scene, yield, 1.5);
  }
}

TEST(ChooseStates, AYieldingNodeClosesBeforeItOpensHoweverFarItIs)
{
  for (const double height : {1e-9, 0.1, 1e3}) {
    const auto scene = all_closed();
    choose(*scene->iterate, *pressing(*scene, 1.6, 0)); // yields at the first
    EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, -height * penalty, 0)).changes, 1);
    EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, 0, 0)).changes, 0) << "closed, with p = xi";
    EXPECT_EQ(choose(*scene->iterate, *pressing(*scene, -3.1, 0)).changes, 1);
    expect_multipliers(*scene, 0, 1.5);
  }
}

TEST(ChooseStates, KeepsOpenAndYieldedNodesOnTheirSidesOfTheSurface)
{
  const auto scene = all_closed();
  choose(*scene->iterate, *pressing(*scene, -1.6, 1.6)); // the first opens, the others yield
  EXPECT_TRUE(choose(*scene->iterate, *pressing(*scene, -0.1, 0.1)).confirmed);
  expect_multipliers(*scene, 0, yield);
}

TEST(ChooseStates, DoNothingWhereNoStateChanges)
{
  const auto scene = all_closed();
  const auto change = choose(*scene->iterate, *pressing(*scene, 1, -1));
  EXPECT_EQ(change.changes, 0);
  expect_multipliers(*scene, 1.5, 1.5);
}

TEST(ChooseStates, NegligibleViolationsChangeNoState)
{
  const auto scene = all_closed();
  const auto u = pressing(*scene, -1.5 - 1e-3, 1); // p = -0.001 at the first node, 2.5 at the others
  EXPECT_EQ(scene->iterate->choose_active_set(*u, 1e-3).changes, 0);
  EXPECT_EQ(scene->iterate->choose_active_set(*u, 3e-4).changes, 1);
  choose(*scene->iterate, *u); // opens it
  const auto own = to_host(own_stiffness(scene->iterate->hessian()->base(), scene->iterate->points()));
  double k = 0;
  for (std::size_t i = 0; i < own.extent(0); ++i) k = std::max(k, own(i));
  k = max_all(scene->d.mesh->comm(), k);
  const auto in = pressing(*scene, 1e-3 * penalty / k, 0); // k v = 0.001 at most, beside pressures of 2.5
  EXPECT_EQ(scene->iterate->choose_active_set(*in, 1e-3).changes, 0);
  EXPECT_EQ(scene->iterate->choose_active_set(*in, 0).changes, 1);
}

TEST(ChooseStates, FirstStatesAreThoseOfMultipliersAndPenetrations)
{
  Scene scene(std::vector{foundation()});
  const auto &c = scene.iterate->points();
  DeviceView<double *> given("given", c.size());
  Kokkos::deep_copy(given, yield);
  Vector unused(scene.d.owned_dofs);
  scene.iterate->start_from({scene.vector(0, 0), given, {}},
                            unused); // as of a coarser mesh: all yield or are about to
  const auto u = scene.vector([](const Point &x) {
    return Point{0, x[0] == 0 ? 1. : -0.01, 0};
  });                                                           // the first is far off
  EXPECT_EQ(choose(*scene.iterate, *u).changes, num_nodes - 1); // open is the state before any choice
  expect_multipliers(scene, 0, yield);
}

TEST(ChooseStates, FingerprintsAreEqualForEqualStates)
{
  const auto scene = all_closed();
  auto &iterate = *scene->iterate;
  const auto at = [&](const double first, const double others) {
    return choose(iterate, *pressing(*scene, first, others)).fingerprint;
  };
  const auto closed = at(0, 0), first_open = at(-1.6, 0), again = at(-1.6, 0);
  EXPECT_NE(closed, first_open);
  EXPECT_EQ(first_open, again);
  EXPECT_EQ(at(0.01 * penalty, 0), closed);
}

TEST(ChooseStates, AllStickFirstWhereContactMustHoldTheBody)
{
  const Scene free(std::vector{foundation(0.1)}), held_by_contact(std::vector{foundation(0.1)});
  held_by_contact.iterate->hold_by_contact();
  EXPECT_EQ(choose(*free.iterate, *pressing(free, 0, 0)).changes, 0);
  EXPECT_EQ(choose(*held_by_contact.iterate, *pressing(held_by_contact, 0, 0)).changes, num_nodes);
  // p = 0 + r v with v = -0.1: pulled, they open again.
  EXPECT_EQ(choose(*held_by_contact.iterate, *pressing(held_by_contact, 0, 0)).changes, num_nodes);
}

/// Of points that were to slip since they cannot stick, and that keep their state.
TEST(ChooseStates, PointsThatKeepTheirStateCanStickAsBefore)
{
  auto rough = foundation();
  rough.friction_coefficient = ScalarField(0.5);
  const Scene scene(std::vector{rough});
  const auto u = pressing(scene, 0, 0);
  choose(*scene.iterate, *u);
  auto choice = scene.iterate->choose_active_set(*u, 0);
  ASSERT_EQ(choice.changes, 0); // all stick
  Kokkos::deep_copy(choice.slip, contact::Slip::slip);
  Kokkos::deep_copy(choice.cannot_stick, true);
  const auto violation = Kokkos::create_mirror_view(choice.violation);
  const auto coords = to_host(scene.d.mesh->coords);
  const auto node = to_host(scene.iterate->points().node);
  for (std::size_t i = 0; i < node.extent(0); ++i) violation(i) = coords(node(i), 0) == 0 ? 1 : 0.1;
  Kokkos::deep_copy(choice.violation, violation);
  const auto changed = scene.iterate->largest_changes(choice, 0.5);
  EXPECT_EQ(changed.changes, 1);
  const auto slip = to_host(changed.slip);
  const auto cannot_stick = to_host(changed.cannot_stick);
  for (std::size_t i = 0; i < slip.extent(0); ++i) EXPECT_EQ(cannot_stick(i), slip(i) == contact::Slip::slip);
}

/// On rollers at its left, so that only contact stops it from going down.
struct OnRollers : Scene {
  OnRollers() : Scene({foundation(0.1)}, {"left", "left", {ScalarField(0.), std::nullopt}}) {}
  RCP<Vector> down(const double by) const
  {
    return vector([&](const Point &) { return Point{0, -by, 0}; });
  }
  double stiffness_down() const
  {
    const auto d = down(1);
    Vector Hd(d->getMap());
    iterate->hessian()->apply(*d, Hd);
    return d->dot(Hd);
  }
};

TEST(HoldByContact, KeepsTheHessianPositiveDefiniteWhereNoNodeIsClosed)
{
  const OnRollers loose, held;
  held.iterate->hold_by_contact();
  for (const OnRollers *scene : {&loose, &held}) {
    scene->iterate->update_hessian(*scene->down(0.2)); // yielding or closed
    scene->iterate->update_hessian(*scene->down(0));
    EXPECT_EQ(scene->iterate->functional().count_states(*scene->down(0)).open, num_nodes);
  }
  const double rounding = 1e-12 * held.material.youngs_modulus;
  EXPECT_NEAR(loose.stiffness_down(), 0, rounding);
  EXPECT_GT(held.stiffness_down(), 1e6 * rounding);
  // but weak against the body's own: E / diameter over 2 m of side
  EXPECT_LT(held.stiffness_down(), 1e-2 * 2 * held.material.youngs_modulus / std::sqrt(5.));
}

TEST(HoldByContact, ChangesNeitherTheFunctionalNorItsGradients)
{
  const OnRollers loose, held;
  held.iterate->hold_by_contact();
  for (const double depth : {0., 0.12, 0.3}) { // open, closed, yielding
    const auto u = loose.down(depth), d = loose.vector(0.01, 0.7);
    u->update(1., *d, 1.);
    Vector F(u->getMap()), G(u->getMap());
    for (const bool piece : {false, true}) {
      const auto gradient = [&](const OnRollers &scene, Vector &to) {
        scene.iterate->update_hessian(*u);
        if (piece)
          active_set_gradient(*scene.iterate, *u, to);
        else
          scene.iterate->gradient(*u, to);
      };
      gradient(loose, F);
      gradient(held, G);
      G.update(-1., F, 1.);
      EXPECT_LT(G.norm2(), 1e-13 * F.norm2()) << depth;
    }
    const double value = loose.iterate->value(*u);
    EXPECT_NEAR(held.iterate->value(*u), value, 1e-13 * std::abs(value));
    const auto line = loose.iterate->along(*u, *d, F), same = held.iterate->along(*u, *d, F);
    EXPECT_NEAR(same->at(1).slope, line->at(1).slope, 1e-13 * std::abs(line->at(1).slope));
    EXPECT_NEAR(same->at(1).curvature, line->at(1).curvature, 1e-12 * line->at(1).curvature);
  }
}

} // namespace
} // namespace active_set_test
