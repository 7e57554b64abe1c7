// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"

// The solution belongs to the scene: to no way of writing it down.

namespace friction_invariance_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// A clamped block in space with Coulomb's friction: open, closed, yielding; stick and slip. Small.
const Assignments coulomb_in_space = {"Mesh->Cells={8, 6, 4}", "Contact->Friction Bound=0",
                                      "Contact->Friction Coefficient=0.3"};
/// A sheared column in steps, with all states: its sides are free.
const Assignments free_sides = {"Mesh->Cells={16, 8}", "Traction->left->X=0", "Traction->left->Y=0",
                                "Traction->right->X=0", "Traction->right->Y=0"};

// mu = 0 --------------------------------------------------------------------------------------------------------------

/// Numbers and counts of all steps.
struct Everything {
  std::vector<double> numbers;
  std::vector<int> counts;

  void add(const analysis::Solution &s)
  {
    numbers.insert(numbers.end(), {s.energy, s.energy_norm_squared, s.contact.total.force[0], s.contact.total.force[1],
                                   s.contact.total.force[2], s.contact.total.max_penetration});
    for (const ContactPoint &point : contact_points(s)) numbers.insert(numbers.end(), {point.pressure, point.u_nu});
    const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t i = 0; i < u.extent(0); ++i) numbers.push_back(u(i, 0));
    counts.insert(counts.end(), s.uzawa.newton_iterations.begin(), s.uzawa.newton_iterations.end());
    counts.insert(counts.end(), s.linear.iterations.begin(), s.linear.iterations.end());
    counts.insert(counts.end(), {s.uzawa.iterations, s.line_search_steps, s.linear.preconditioner_setups});
  }
};

TEST(FrictionInvariance, CoefficientZeroIsNoFrictionToTheLastDigitAndCount)
{
  const auto with = [](const std::string &deck, const Assignments &more, const std::string &mu) {
    Everything all;
    all.add(solved(deck, joined(more, {"Contact->Friction Bound=0", "Contact->Friction Coefficient=" + mu})));
    return all;
  };
  for (const auto &[deck, more] :
       {std::pair("cantilever_coulomb", Assignments{}), {"block_tresca", Assignments{"Mesh->Cells={8, 6, 4}"}}}) {
    SCOPED_TRACE(deck);
    const Everything none = with(deck, more, "0"), zero = with(deck, more, "0*x");
    EXPECT_EQ(none.numbers, zero.numbers);
    EXPECT_EQ(none.counts, zero.counts);
  }
}

TEST(FrictionInvariance, CoefficientZeroIsNoFrictionInLoadSteps)
{
  // Held by the top, so that nothing needs friction.
  const auto with = [](const std::string &mu) {
    Everything all;
    for (const auto &s :
         solved_steps("loop", joined(free_sides, {"Steps->Times={1, 1.5, 2, 3}", "Contact->Yield Stress=10",
                                                  "Contact->Friction Coefficient=" + mu})))
      all.add(s);
    return all;
  };
  const Everything none = with("0"), zero = with("0*x");
  EXPECT_EQ(none.numbers, zero.numbers);
  EXPECT_EQ(none.counts, zero.counts);
}

// Space and plane -----------------------------------------------------------------------------------------------------

TEST(FrictionInvariance, WithoutPoissonsRatioSpaceIsThePlaneTimesItsDepth)
{
  constexpr double depth = 0.5;
  const Assignments both = joined(tight, {"Material->Poisson's Ratio=0"});
  const Solution plane = solved("cantilever_coulomb", joined(both, {"Mesh->Cells={48, 16}"}));
  const Solution space =
      solved("cantilever_coulomb", joined(both, {"Mesh->Lower={0, 0, 0}", "Mesh->Upper={3, 1, 0.5}",
                                                 "Mesh->Cells={48, 16, 2}", "Dirichlet->left->Z=0"}));
  const auto &one = plane.contact.total, &other = space.contact.total;
  EXPECT_NEAR(space.energy, depth * plane.energy, 1e-9 * std::abs(plane.energy));
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(other.force[k], depth * one.force[k], 1e-9 * std::abs(one.force[k])) << k;
  EXPECT_NEAR(other.force[2], 0, 1e-9 * one.force[1]);
  EXPECT_NEAR(other.friction_work, depth * one.friction_work, 1e-9 * one.friction_work);
  const FrictionCounts n = friction_counts(contact_points(plane)), m = friction_counts(contact_points(space));
  EXPECT_GT(n.stick, 2);
  EXPECT_GT(n.forward, 5);
  EXPECT_GT(n.backward, 1);
  EXPECT_EQ(m.stick, 3 * n.stick);
  EXPECT_EQ(m.forward, 3 * n.forward);
  EXPECT_EQ(m.backward, 3 * n.backward);
}

// Time ----------------------------------------------------------------------------------------------------------------

TEST(FrictionInvariance, OneStepOfAProportionalLoadIsMany)
{
  const auto steps_of = [](const std::string &deck, const Assignments &load, const std::string &times) {
    return solved_steps(deck, joined(joined(tight, load), {"Steps->Times=" + times}));
  };
  const Assignments plate = {"Traction->top->Y=-5e7*t", "Traction->left->X=15e7*t"};
  const Assignments block =
      joined(coulomb_in_space, {"Contact->Gap=0", "Contact->Yield Stress=inf", "Traction->front->X=0.5*t*sin(pi*x/2)",
                                "Traction->front->Z=-6*t*(1+0.3*y)"});
  for (const auto &[deck, load] : {std::pair("greco", plate), {"block_tresca", block}}) {
    SCOPED_TRACE(deck);
    const auto one = steps_of(deck, load, "{1}"), many = steps_of(deck, load, "{0.1, 0.35, 0.6, 0.8, 1}");
    const auto &a = one.back(), &b = many.back();
    EXPECT_NEAR(a.energy, b.energy, 1e-8 * std::abs(a.energy));
    EXPECT_LT(difference(contact_points(b), contact_points(a)), 1e-8);
    // The trapezoid too: s grows with the slip.
    const double friction = a.history.back().energies.friction;
    EXPECT_NEAR(b.history.back().energies.friction, friction, 1e-8 * friction);
    EXPECT_GT(friction_counts(contact_points(a)).slip, 5);
    EXPECT_GT(friction_counts(contact_points(a)).stick, 5);
  }
}

// Motion --------------------------------------------------------------------------------------------------------------

/// The last forces and what friction has dissipated, of a body whose top and foundation move.
struct Moved {
  contact::ContactSums sums;
  analysis::Energies energies;
};
Moved moved(const Assignments &scene)
{
  const Solution s = solved("loop", joined(tight, scene));
  return {s.contact.total, s.history.back().energies};
}
void expect_same(const Moved &a, const Moved &b)
{
  const double scale = std::hypot(a.sums.force[0], a.sums.force[1], a.sums.force[2]);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.sums.force[k], b.sums.force[k], 1e-9 * scale) << k;
  EXPECT_GT(a.energies.friction, 0);
  EXPECT_NEAR(a.energies.friction, b.energies.friction, 1e-8 * a.energies.friction);
  EXPECT_NEAR(a.energies.work, b.energies.work, 1e-8 * a.energies.work);
  EXPECT_NEAR(a.sums.max_slip, b.sums.max_slip, 1e-8 * a.sums.max_slip);
  EXPECT_GT(a.sums.stick_length, 0);
  EXPECT_GT(a.sums.slip_length, 0);
}

TEST(FrictionInvariance, TopMovedOneWayIsTheFoundationMovedTheOther)
{
  const Assignments scene =
      joined(free_sides, {"Contact->Obstacle->Type=plane", "Contact->Obstacle->Normal={0, 1}", "Steps->Times={1, 2, 3}",
                          "Contact->Yield Stress=12", "Contact->Friction Coefficient=0.3"});
  // To and fro, and part of the way down, from t = 0 on.
  const std::string x = "(t < 2.5 ? 0.005*t : 0.0015)", y = "0.001*t";
  expect_same(moved(joined(scene, {"Dirichlet->top->X=" + x, "Dirichlet->top->Y=-0.01-" + y,
                                   "Contact->Obstacle->Point={0, 0}"})),
              moved(joined(scene, {"Dirichlet->top->X=0", "Dirichlet->top->Y=-0.01",
                                   "Contact->Obstacle->Point={-" + x + ", " + y + "}"})));
}

TEST(FrictionInvariance, TopMovedOneWayIsASlantedFoundationMovedTheOtherInSpace)
{
  const Assignments scene =
      joined(block_in_space, {"Contact->Obstacle->Type=plane", "Contact->Obstacle->Normal={-0.003, 0.002, 1}",
                              "Contact->Friction Coefficient=0.3"});
  // The first step is pressed only: a gap that the foundation closes is no work, and one that the body closes is.
  const std::string x = "(t < 2.5 ? 0.004*max(0, t-1) : 0.002)", y = "0.002*max(0, t-1)^2", z = "0.0005*max(0, t-1)";
  expect_same(moved(joined(scene, {"Dirichlet->top->X=" + x, "Dirichlet->top->Y=" + y, "Dirichlet->top->Z=-0.01-" + z,
                                   "Contact->Obstacle->Point={0, 0, 0}"})),
              moved(joined(scene, {"Dirichlet->top->X=0", "Dirichlet->top->Y=0", "Dirichlet->top->Z=-0.01",
                                   "Contact->Obstacle->Point={-" + x + ", -" + y + ", " + z + "}"})));
}

/// A column that is free at its sides, on a plane. Pressed and moved by (0.02, -0.01) by t = 1.
Assignments pressed_and_moved(const bool body, const Assignments &steps)
{
  return joined(joined(free_sides, steps), {"Contact->Obstacle->Type=plane", "Contact->Obstacle->Normal={0, 1}",
                                            "Contact->Obstacle->Point=" + std::string(body ? "{0, 0}" : "{-0.02*t, 0}"),
                                            "Dirichlet->top->X=" + std::string(body ? "0.02*t" : "0"),
                                            "Dirichlet->top->Y=-0.01*t", "Contact->Friction Coefficient=0.3"});
}

TEST(FrictionInvariance, FirstStepCountsTheFoundationsMotionSinceTheBodyWasAtRest)
{
  for (const char *times : {"{1}", "{0.5, 1}", "{0.001, 1}", "{}"}) {
    SCOPED_TRACE(times);
    const Assignments steps = {std::string("Steps->Times=") + times};
    const Solution body = solved("loop", joined(tight, pressed_and_moved(true, steps))),
                   foundation = solved("loop", joined(tight, pressed_and_moved(false, steps)));
    const auto &a = body.contact.total, &b = foundation.contact.total;
    EXPECT_LT(a.force[0], -6);
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(b.force[k], a.force[k], 1e-9 * a.force[1]) << k;
    EXPECT_NEAR(b.max_slip, a.max_slip, 1e-8 * a.max_slip);
    EXPECT_NEAR(b.friction_work, a.friction_work, 1e-8 * a.friction_work);
    if (body.history.empty()) continue;
    const auto &x = body.history.back().energies, &y = foundation.history.back().energies;
    EXPECT_NEAR(y.work, x.work, 1e-8 * x.work);
    EXPECT_NEAR(y.friction, x.friction, 1e-8 * x.friction);
  }
}

TEST(FrictionInvariance, FirstStepInPartsCountsTheFoundationsMotionOnce)
{
  // It yields on the way, and its energies do not balance in one part.
  const Assignments divided =
      joined(tight, {"Steps->Times={1}", "Steps->Energy Tolerance=1e-3", "Contact->Yield Stress=15"});
  const Solution body = solved("loop", pressed_and_moved(true, divided)),
                 foundation = solved("loop", pressed_and_moved(false, divided));
  EXPECT_GT(body.history.back().parts, 1);
  EXPECT_EQ(foundation.history.back().parts, body.history.back().parts);
  const auto &a = body.contact.total, &b = foundation.contact.total;
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(b.force[k], a.force[k], 1e-9 * a.force[1]) << k;
}

TEST(FrictionInvariance, StepsBeforeAndAtZeroStartWhereTheFirstOneEnds)
{
  // t = 0 has no special place in a history that begins before it.
  const auto shifted = [](const std::string &t, const std::string &times) {
    return solved("loop",
                  joined(joined(tight, free_sides),
                         {"Contact->Obstacle->Type=plane", "Contact->Obstacle->Normal={0, 1}",
                          "Contact->Obstacle->Point={-0.01*max(0, " + t + "), 0}", "Dirichlet->top->X=0",
                          "Dirichlet->top->Y=-0.01", "Contact->Friction Coefficient=0.3", "Steps->Times=" + times}));
  };
  const Solution late = shifted("t-1", "{1, 2, 3}"), early = shifted("t+2", "{-2, -1, 0}");
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(early.contact.total.force[k], late.contact.total.force[k], 1e-9) << k;
  EXPECT_GT(std::abs(late.contact.total.force[0]), 1);
}

// Mirrors -------------------------------------------------------------------------------------------------------------

TEST(FrictionInvariance, MirroredSceneInThePlaneHasTheMirroredSolution)
{
  const Solution s = solved("cantilever_coulomb", tight);
  const Solution mirrored = solved(
      "cantilever_coulomb",
      joined(tight, {"Dirichlet->left->Side=right", "Traction->top->X=-20*(3-x)", "Traction->top->Y=-100*(1+(3-x)/3)",
                     "Contact->Gap=0.002+0.004*(3-x-1.2)^2", "Contact->Yield Stress=200*(1+0.5*sin(3*(3-x)))"}));
  auto points = contact_points(mirrored);
  std::reverse(points.begin(), points.end());
  for (ContactPoint &point : points) point.q[0] *= -1;
  EXPECT_LT(difference(points, contact_points(s)), 1e-9);
  EXPECT_NEAR(mirrored.energy, s.energy, 1e-10 * std::abs(s.energy));
}

TEST(FrictionInvariance, MirroredSceneInSpaceHasTheMirroredSolution)
{
  for (const Assignments &law : {Assignments{"Mesh->Cells={8, 6, 4}"}, coulomb_in_space}) {
    const Assignments both = joined(tight, law);
    const Solution s = solved("block_tresca", both);
    Assignments other =
        joined(both, {"Traction->front->Z=-6*(1+0.3*(1.5-y))", "Contact->Gap=0.004*(x-0.7)^2+0.006*(1.5-y-0.6)^2"});
    if (law.size() == 1) other.push_back("Contact->Friction Bound=1+0.5*(1.5-y)");
    const Solution mirrored = solved("block_tresca", other);
    auto points = contact_points(mirrored);
    for (ContactPoint &point : points) {
      point.x[1] = 1.5 - point.x[1];
      point.q[1] *= -1;
    }
    auto by_place = [](const ContactPoint &a, const ContactPoint &b) {
      return std::abs(a.x[0] - b.x[0]) > 1e-9 ? a.x[0] < b.x[0] : a.x[1] < b.x[1];
    };
    std::sort(points.begin(), points.end(), by_place);
    auto reference = contact_points(s);
    std::sort(reference.begin(), reference.end(), by_place);
    EXPECT_LT(difference(points, reference), 1e-9);
    EXPECT_NEAR(mirrored.energy, s.energy, 1e-10 * std::abs(s.energy));
    const FrictionCounts n = friction_counts(reference);
    EXPECT_GT(n.stick, 5);
    EXPECT_GT(n.slip, 5);
  }
}

} // namespace
} // namespace friction_invariance_test
