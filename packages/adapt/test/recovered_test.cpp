// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "energy_of_difference.hpp"
#include "rpc/contact/surface/sphere.hpp"
#include "rpc/fem/surface.hpp"
#include "squeezed.hpp"

#include <limits>

namespace recovered_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
TEST(RecoveredEstimate, IsTheErrorOfAnInterpolantWhereRecoveryIsExact)
{
  // u_i = (a_i . x)^(p+1), which the element does not hold and its recovery does.
  constexpr double a[3][3] = {{0.3, -0.5, 0.2}, {-0.4, 0.1, 0.6}, {0.2, 0.7, -0.3}};
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const int n = element.order + 1;
    const auto dot = [&](const int i, const Point &x) { return a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2]; };
    const auto u = interpolate(d, [&](const Point &x) {
      return Point{std::pow(dot(0, x), n), std::pow(dot(1, x), n), std::pow(dot(2, x), n)};
    });
    const auto estimate = adapt::recovered_estimate({d, steel, {}, {}, {}, {}, *u});
    const double exact =
        sum_all(d.mesh->comm(), energy_of_difference(d, steel, *u, [&](const Point &x, double(&g)[3][3]) {
                  for (int i = 0; i < element.dim; ++i)
                    for (int j = 0; j < element.dim; ++j) g[i][j] = n * std::pow(dot(i, x), n - 1) * a[i][j];
                }));
    EXPECT_GT(exact, 0.01);
    EXPECT_NEAR(estimate.part("recovery") / exact, 1, 1e-9);
    EXPECT_EQ(estimate.total(), estimate.part("recovery"));
    double of_cells = 0;
    const auto squared = to_host(estimate.squared);
    for (LO cell = 0; cell < d.mesh->num_owned_cells; ++cell) of_cells += squared(cell);
    EXPECT_NEAR(sum_all(d.mesh->comm(), of_cells) / estimate.total(), 1, 1e-12);
  }
}

TEST(RecoveredEstimate, KnowsPressuresThatDoNotBalanceTheStress)
{
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const double balanced = -Squeezed::strain * Squeezed::stiffness();
    const auto none = Squeezed(element, 100, 0, balanced).estimate();
    EXPECT_LT(none.total(), 1e-24 * balanced * balanced);
    const auto more = Squeezed(element, 100, 0, balanced + 3).estimate();
    EXPECT_NEAR(more.part("contact_equilibrium") / Squeezed::equilibrium(3), 1, 1e-10);
    EXPECT_LT(more.part("recovery") + more.part("contact_complementarity"), 1e-20 * more.part("contact_equilibrium"));
    EXPECT_NEAR(more.total() / more.part("contact_equilibrium"), 1, 1e-10);
    EXPECT_NEAR(more.pressure, 3 * std::sqrt(Squeezed::length), 1e-10);
    EXPECT_NEAR(more.max_pressure, 3, 1e-10);
  }
}

TEST(RecoveredEstimate, CountsTractionsOnAContactSide)
{
  const double balanced = -Squeezed::strain * Squeezed::stiffness();
  fem::TractionLoad traction{"lift", "bottom", {ScalarField(0.), ScalarField(4.), ScalarField(0.)}};
  const Squeezed body({2, 1}, 100, 0, balanced - 4);
  EXPECT_LT(body.estimate({traction}).total(), 1e-20);
  traction.side = "top"; // elsewhere
  EXPECT_NEAR(body.estimate({traction}).part("contact_equilibrium") / Squeezed::equilibrium(4), 1, 1e-10);
}

TEST(RecoveredEstimate, KnowsWhatContradictsTheContactLaw)
{
  const double p = -Squeezed::strain * Squeezed::stiffness();
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    // Pressure across an open gap, g = 0.02.
    EXPECT_NEAR(Squeezed(element, 100, 0.02, p).estimate().part("contact_complementarity"),
                2 * Squeezed::length * p * 0.02, 1e-10);
    // A foundation that has given way by 0.03 at less than its yield stress; at the yield stress.
    EXPECT_NEAR(Squeezed(element, p + 5, -0.03, p).estimate().part("contact_complementarity"),
                2 * Squeezed::length * 5 * 0.03, 1e-10);
    EXPECT_NEAR(Squeezed(element, p, -0.03, p).estimate().part("contact_complementarity"), 0, 1e-10);
    // No finite yield stress: twice the largest pressure stands for it.
    const double rigid = std::numeric_limits<double>::infinity();
    EXPECT_NEAR(Squeezed(element, rigid, -0.03, p).estimate().part("contact_complementarity"),
                2 * Squeezed::length * p * 0.03, 1e-10);
  }
}

TEST(RecoveredEstimate, TakesNodesThatMissTheObstacleForOpenOnes)
{
  // Free of pressure, over a foundation that is far from all nodes, or that some of them miss.
  const contact::Obstacle below_all{contact::Sphere{2}, {1, -9, 0}};
  const contact::Obstacle below_some{contact::Sphere{0.6}, {1, -9, 0}};
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const Squeezed all(element, 100, 1, 0, below_all), some(element, 100, 1, 0, below_some);
    EXPECT_EQ(all.nodes.num_missing, 0);
    EXPECT_GT(some.nodes.num_missing, 0);
    const auto expected = all.estimate(), found = some.estimate();
    EXPECT_GT(expected.part("contact_equilibrium"), 0); // the stress of the strain presses on nothing
    EXPECT_NEAR(found.part("contact_equilibrium") / expected.part("contact_equilibrium"), 1, 1e-12);
    EXPECT_EQ(expected.part("contact_complementarity"), 0);
    EXPECT_EQ(found.part("contact_complementarity"), 0);
    EXPECT_EQ(found.pressure, expected.pressure);
  }
}

TEST(PressurePeak, IsExactAtTheHighestYieldStress)
{
  const auto nothing = [](double) { return 0.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto half = [](const double x) { return x < 1 ? 7. : 3.; };
    const auto peak = estimate_with(element, ScalarField(7.), 7, half, nothing).peak;
    EXPECT_TRUE(peak.at_bound);
    EXPECT_EQ(peak.unknown(), "");
    EXPECT_FALSE(estimate_with(element, ScalarField(8.), 7, half, nothing).peak.at_bound);
    EXPECT_FALSE(estimate_with(element, step(1, 7, 9), 7, half, nothing).peak.at_bound);
  }
}

TEST(PressurePeak, HasNoErrorWhereThePressureFallsWithinACell)
{
  const auto nothing = [](double) { return 0.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    // Cells have the length 0.5.
    const auto slow = estimate_with(
        element, ScalarField(99.), 10, [](const double x) { return 10 - 3 * x; }, nothing);
    EXPECT_NEAR(slow.peak.drop, 0.15, 1e-12);
    EXPECT_EQ(slow.peak.unknown(), "");
    const auto fast = estimate_with(
        element, ScalarField(99.), 10, [](const double x) { return 10 - 5 * x; }, nothing);
    EXPECT_NEAR(fast.peak.drop, 0.25, 1e-12);
    EXPECT_NE(fast.peak.unknown().find("25 %"), std::string::npos) << fast.peak.unknown();
  }
}

TEST(PressurePeak, HasNoErrorWhereTheYieldStressJumpsNextToAYieldedPart)
{
  const auto nothing = [](double) { return 0.; };
  const auto p = [](const double x) { return x < 0.9 ? 9. : 10.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    EXPECT_TRUE(estimate_with(element, step(0.9, 9, 12), 10, p, nothing).peak.yield_jump);
    EXPECT_FALSE(estimate_with(element, step(0.9, 9.5, 12), 10, p, nothing).peak.yield_jump); // nothing yields
    EXPECT_FALSE(estimate_with(element, step(0.9, 9, 10), 10, p, nothing).peak.yield_jump);   // both sides do
    const auto lower = [](const double x) { return x < 0.9 ? 9. : 9.5; };
    EXPECT_FALSE(estimate_with(element, step(0.9, 9, 9.8), 9.5, lower, nothing).peak.yield_jump); // as a slope may
  }
}

TEST(PressurePeak, HasNoErrorWhereContactEndsAtAJumpOfTheGap)
{
  const auto p = [](const double x) { return x < 0.9 ? 10. : 0.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const double pressed = 10 / Squeezed::stiffness() * Squeezed::h; // a facet's length under a strain of the pressure
    const auto jumps = [&](const double by, const double softness = 0) {
      const ScalarField gap("test", [by](const Point &x) { return x[0] < 0.9 ? 0. : by; });
      const auto opens = [by](const double x) { return x < 0.9 ? 0. : -by; };
      return estimate_with(element, ScalarField(99.), 10, p, opens, gap, softness).peak.gap_jump;
    };
    EXPECT_TRUE(jumps(1.1 * pressed));
    EXPECT_FALSE(jumps(0.9 * pressed));
    const double layer =
        Squeezed::h / Squeezed::stiffness(); // on springs pressures are bounded, if these are not as stiff as rock
    EXPECT_FALSE(jumps(1.1 * pressed, 1.1 * layer));
    EXPECT_TRUE(jumps(1.1 * pressed, 0.9 * layer));
  }
}

TEST(PressurePeak, HasNoErrorWhereTheFoundationIsDentedUpToAJumpOfTheGap)
{
  // Earlier steps have pressed in the foundation to the left of 0.9; the body has left it beside the jump.
  const auto p = [](const double x) { return x < 0.4 ? 10. : 0.; };
  const ScalarField gap = step(0.9, 0, 1);
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    for (const double w : {0., 0.1}) {
      const auto opens = [w](const double x) { return x < 0.9 ? w - (x < 0.4 ? 0 : 1e-3) : -1.; };
      const auto peak = estimate_with(element, ScalarField(99.), 10, p, opens, gap, 0, step(0.9, w, 0)).peak;
      EXPECT_EQ(peak.dented_jump, w > 0);
      EXPECT_FALSE(peak.gap_jump);
      EXPECT_EQ(peak.unknown().find("dented") != std::string::npos, w > 0);
    }
  }
}

TEST(PressurePeak, HasAnErrorWhereTheGapIsCurvedAlone)
{
  const auto p = [](const double x) { return x < 0.6 ? 10. : 0.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto gap_jump = [&](const std::function<double(double)> &gap) {
      const ScalarField field("test", [gap](const Point &x) { return gap(x[0]); });
      const auto opens = [&](const double x) { return x < 0.6 ? 0. : -gap(x); };
      return estimate_with(element, ScalarField(99.), 10, p, opens, field).peak.gap_jump;
    };
    EXPECT_FALSE(gap_jump([](const double x) { return 0.2 * x * x; }));
    EXPECT_FALSE(gap_jump([](const double x) { return x < 0.5 ? 0. : 0.2 * (x - 0.5) * (x - 0.5); })); // a fillet
    EXPECT_FALSE(gap_jump([](const double x) { return x < 0.7 ? 0. : 0.2 * (x - 0.7) * (x - 0.7); })); // within a facet
    EXPECT_TRUE(gap_jump([](const double x) { return x < 0.5 ? 0. : 0.2 * (x - 0.5); }));              // a chamfer
    EXPECT_TRUE(gap_jump([](const double x) { return x < 0.7 ? 0. : 0.2; }));
  }
}

TEST(PressurePeak, HasNoErrorAtAKinkOfTheGap)
{
  const auto nothing = [](double) { return 0.; };
  const auto p = [](double) { return 10.; };
  const ScalarField wedge("test", [](const Point &x) { return 0.2 * std::abs(x[0] - 1); }),
      inside("test", [](const Point &x) { return 0.2 * std::abs(x[0] - 0.88); }), // within a facet, near its end
      valley("test", [](const Point &x) { return -0.2 * std::abs(x[0] - 1); }),
      smooth("test", [](const Point &x) { return 0.2 * (x[0] - 1) * (x[0] - 1); });
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto at_tip = estimate_with(element, ScalarField(99.), 10, p, nothing, wedge);
    EXPECT_NEAR(at_tip.peak.kink, 2000 / (1 - 0.3 * 0.3) * 0.4 / (2 * 3.14159265358979 * 10), 1e-9);
    EXPECT_EQ(estimate_with(element, ScalarField(99.), 10, p, nothing, wedge, 1).peak.kink, 0); // on springs
    EXPECT_NE(at_tip.peak.unknown().find("logarithm"), std::string::npos);
    EXPECT_NEAR(estimate_with(element, ScalarField(99.), 10, p, nothing, smooth).peak.kink, 0, 1e-9);
    EXPECT_NEAR(estimate_with(element, ScalarField(99.), 10, p, nothing, inside).peak.kink, at_tip.peak.kink, 1e-9);
    EXPECT_NEAR(estimate_with(element, ScalarField(99.), 10, p, nothing, valley).peak.kink, 0, 1e-9);
    const auto aside = [](const double x) { return x < 0.4 ? 10. : 3.; }; // the tip bears little
    EXPECT_NEAR(estimate_with(element, ScalarField(99.), 10, aside, nothing, wedge).peak.kink, 0, 1e-9);
    EXPECT_EQ(estimate_with(element, ScalarField(10.), 10, p, nothing, wedge).peak.kink, 0); // it yields
    const auto yields = [](const double x) { return std::abs(x - 1) < 0.01 ? 10. : 9.; };    // at the tip alone
    EXPECT_EQ(estimate_with(element, ScalarField(10.), 10, yields, nothing, wedge).peak.kink < 1, element.order == 2);
  }
}

TEST(RecoveredEstimate, KnowsWhatJumpsOfDataLeaveOpen)
{
  const auto nothing = [](double) { return 0.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    // A yield stress that jumps from 3 to 12 within a facet of the length h, reached on the left.
    const auto yields = [](const double x) { return x < 0.6 ? 3. : 10.; };
    const auto yield_jump = estimate_with(element, step(0.6, 3, 12), 10, yields, nothing);
    EXPECT_NEAR(yield_jump.jumped_force, (10 - 3) * Squeezed::h / 2, 1e-12);
    EXPECT_EQ(yield_jump.jumped_energy, 0);
    const auto below = [](const double x) { return x < 0.6 ? 2. : 10.; }; // not reached
    EXPECT_EQ(estimate_with(element, step(0.6, 3, 12), 10, below, nothing).jumped_force, 0);
    // Contact that ends at a jump of the gap, and at a smooth end.
    const auto p = [](const double x) { return x < 0.6 ? 10. : 0.; };
    const auto opens = [](const double x) { return x < 0.6 ? 0. : -1.; };
    const auto gap_jump = estimate_with(element, ScalarField(99.), 10, p, opens);
    EXPECT_EQ(gap_jump.jumped_force, 0);
    EXPECT_NEAR(gap_jump.jumped_energy, 10 * 10 * Squeezed::h * Squeezed::h / (2 * Squeezed::stiffness()), 1e-12);
    const auto hardly = [](const double x) { return x < 0.6 ? 0. : -1e-4; };
    EXPECT_EQ(estimate_with(element, ScalarField(99.), 10, p, hardly).jumped_energy, 0);
    // A part that yields up to it: its edge is as uncertain, and there is no singularity.
    const auto to_the_edge = estimate_with(element, step(0.6, 10, 99), 10, p, opens);
    EXPECT_NEAR(to_the_edge.jumped_force, 10 * Squeezed::h / 2, 1e-12);
    EXPECT_EQ(to_the_edge.jumped_energy, 0);
  }
  // A slope is no jump where middle nodes show it.
  const ScalarField slope("test", [](const Point &x) { return 3 + 4 * x[0]; });
  const auto along = [](const double x) { return 3 + 4 * x; };
  for (const auto &element : plane_elements())
    EXPECT_EQ(estimate_with(element, slope, 11, along, nothing).jumped_force == 0, element.order == 2);
}

TEST(RecoveredEstimate, KnowsWhereTheMeshDoesNotTellTheEndOfContact)
{
  const auto nothing = [](double) { return 0.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto part = [](const double x) { return x > 0.4 && x < 1.1 ? 10. : 0.; }; // 0.5 to 1 at the nodes
    EXPECT_NEAR(estimate_with(element, ScalarField(99.), 10, part, nothing).contact_ends, 2 * Squeezed::h / 2, 1e-12);
    const auto all = [](double) { return 10.; };
    EXPECT_EQ(estimate_with(element, ScalarField(99.), 10, all, nothing).contact_ends, 0);
  }
}

TEST(RecoveredEstimate, HasNoNegativePartWhereTheYieldStressJumps)
{
  const auto yields = [](const double x) { return x < 0.6 ? 3. : 100.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto estimate = estimate_with(element, step(0.6, 3, 100), 100, yields, [](double) { return 0.01; });
    const auto squared = to_host(estimate.squared);
    for (LO cell = 0; cell < static_cast<LO>(squared.extent(0)); ++cell) EXPECT_GE(squared(cell), 0);
    EXPECT_GE(estimate.part("contact_complementarity"), 0);
  }
}

TEST(RecoveredEstimate, DoesNotCountWhatASolveLeavesOfPenetrationAtClosedNodes)
{
  const auto p = [](const double) { return 26.; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto with = [&](const double left) {
      return estimate_with(element, ScalarField(99.), 26, p, [left](const double x) { return x < 1 ? left : -left; });
    };
    EXPECT_EQ(with(1e-12).part("contact_complementarity"), 0);
    EXPECT_EQ(with(1e-12).total(), with(0).total());
    EXPECT_NEAR(with(1e-6).part("contact_complementarity") / with(1e-5).part("contact_complementarity"), 0.1,
                1e-9); // more than a solve leaves
    EXPECT_GT(with(1e-6).part("contact_complementarity"), 0);
  }
}

/// What contradicts the law, 2 sum of (psi(v) + psi*(p) - p v) over the bottom, where all nodes are at the pressure p and the
/// penetration v on dents w.
double contradiction(const mesh::Element &element, const contact::ContactOptions &law, const double w, const double p,
                     const double v)
{
  Squeezed body(element, 1, 0, p);
  contact::ContactOptions options = law;
  options.side = "bottom";
  MultiVector dents(body.d.mesh->owned_nodes, 1);
  dents.putScalar(w);
  body.nodes = contact::contact_nodes(body.d, {options}, fem::dirichlet_dofs(body.d, {}), steel, &dents);
  Kokkos::deep_copy(body.result.penetration, v);
  const auto estimate = body.estimate();
  const auto squared = to_host(estimate.squared);
  for (LO cell = 0; cell < static_cast<LO>(squared.extent(0)); ++cell) EXPECT_GE(squared(cell), 0);
  return estimate.part("contact_complementarity");
}

TEST(RecoveredEstimate, KnowsWhatContradictsTheLawOfOtherFoundations)
{
  contact::ContactOptions hardening, elastic, both;
  hardening.yield_stress = elastic.yield_stress = both.yield_stress = ScalarField(20.);
  hardening.hardening = both.hardening = ScalarField(300.);
  elastic.stiffness = both.stiffness = ScalarField(1000.);
  const double twice = 2 * Squeezed::length, slope = 1 / (1 / 1000. + 1 / 300.); // of spring and hardening in series
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    // v and p as the law has them, at first and on dents: xi + 300 w at v = w + 0.02.
    for (const double w : {0., 0.05}) {
      const double xi = 20 + 300 * w;
      EXPECT_NEAR(contradiction(element, hardening, w, xi + 6, w + 0.02), 0, 1e-11);
      EXPECT_NEAR(contradiction(element, hardening, w, 7, w), 0, 1e-11); // closed
      EXPECT_NEAR(contradiction(element, elastic, w, 15, w + 0.015), 0, 1e-11);
      EXPECT_NEAR(contradiction(element, elastic, w, 20, w + 0.06), 0, 1e-11);
      EXPECT_NEAR(contradiction(element, both, w, 15, w + 0.015), 0, 1e-11);
      EXPECT_NEAR(contradiction(element, both, w, xi + slope * 0.01, w + xi / 1000 + 0.01), 0, 1e-11);
      // Off by 0.01 m on a branch of slope H, k or both.
      EXPECT_NEAR(contradiction(element, hardening, w, xi + 6, w + 0.03), twice * 0.5 * 300 * 1e-4, 1e-10);
      EXPECT_NEAR(contradiction(element, elastic, w, 11, w + 0.001), twice * 0.5 * 1000 * 1e-4, 1e-10);
      EXPECT_NEAR(contradiction(element, both, w, xi + slope * 0.01, w + xi / 1000 + 0.02), twice * 0.5 * slope * 1e-4,
                  1e-10);
      // Pressure across a gap, less than all that the dent leaves: p d + what the spring would store.
      EXPECT_NEAR(contradiction(element, hardening, w, 7, w - 0.01), twice * 7 * 0.01, 1e-10);
      EXPECT_NEAR(contradiction(element, elastic, w, 7, w - 0.01), twice * (7 * 0.01 + 0.5 * 7 * 7 / 1000), 1e-10);
    }
  }
}

TEST(RecoveredEstimate, OfAHardeningFoundationKnowsNoBoundOfThePressure)
{
  // The peak is no yield stress, which it may exceed further on.
  for (const double hardening : {0., 300.}) {
    Squeezed body({2, 1}, 20, 0, 26);
    contact::ContactOptions options;
    options.side = "bottom";
    options.yield_stress = ScalarField(20.);
    options.hardening = ScalarField(hardening);
    body.nodes = contact::contact_nodes(body.d, {options}, fem::dirichlet_dofs(body.d, {}), steel);
    Kokkos::deep_copy(body.result.penetration, 0.02);
    if (hardening == 0) Kokkos::deep_copy(body.result.pressure, 20.);
    body.result.total.max_pressure = hardening == 0 ? 20 : 26;
    const auto estimate = body.estimate();
    EXPECT_EQ(estimate.peak.at_bound, hardening == 0);
    // What the stress tells of pressures that are the yield stress is nothing new; of hardening ones it is.
    EXPECT_EQ(estimate.pressure > 0, hardening > 0);
  }
}

} // namespace
} // namespace recovered_test
