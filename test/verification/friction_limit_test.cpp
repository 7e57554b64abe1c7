// SPDX-License-Identifier: BSD-3-Clause
#include "expect_error.hpp"
#include "friction_scene.hpp"

#include <cstdlib>

// A block that lies on its foundation and is pushed along it: friction holds it up to mu N, and no further.

namespace friction_limit_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// The number behind a text of a message.
double number_after(const std::string &message, const std::string &before)
{
  const auto at = message.find(before);
  EXPECT_NE(at, std::string::npos) << message;
  return at == std::string::npos ? NAN : std::strtod(message.c_str() + at + before.size(), nullptr);
}

constexpr double load = 12.345, mu = 0.3;     // of the top, per area
constexpr double normal = 2 * load;           // 2 m by 1 m, or 2 m
constexpr double holds = mu * normal;         // Coulomb
constexpr double also = 1.5, more = 2 * also; // Tresca's bound, and what it adds

/// A law of friction, what it holds, and how the block is pushed: by all of a force along a direction.
struct Push {
  const char *name;
  double limit;
  Assignments law;
  int dim;
  std::array<double, 2> along;

  Assignments by(const double force) const
  {
    const auto traction = [&](const std::string &side, const std::string &axis, const double share, const double area) {
      return "Traction->" + side + "->" + axis + "=" + text(share * force / area);
    };
    if (dim == 2) return joined(law, {traction("left", "X", along[0], 1)});
    return joined(law, {"Mesh->Lower={0, 0, 0}", "Mesh->Upper={2, 1, 1}", "Mesh->Cells={8, 4, 4}", "Contact->Side=back",
                        "Traction->top->Y=0", "Traction->front->Z=" + text(-load), traction("front", "X", along[0], 2),
                        traction("front", "Y", along[1], 2)});
  }
};
const Assignments coulomb = {}, bounded = {"Contact->Friction Bound=" + text(also)},
                  tresca = {"Contact->Friction Coefficient=0", "Contact->Friction Bound=" + text(also)};
const Push pushes[] = {{"Coulomb", holds, coulomb, 2, {1, 0}},
                       {"CoulombBackwards", holds, coulomb, 2, {-1, 0}},
                       {"CoulombOnAYieldingFoundation", holds, {"Contact->Yield Stress=60"}, 2, {1, 0}},
                       {"CoulombQ2", holds, {"Mesh->Element=Q2", "Mesh->Cells={8, 4}"}, 2, {1, 0}},
                       {"CoulombP1", holds, {"Mesh->Element=P1"}, 2, {1, 0}},
                       {"Tresca", more, tresca, 2, {1, 0}},
                       {"Both", holds + more, bounded, 2, {1, 0}},
                       {"CoulombInSpace", holds, coulomb, 3, {0.6, 0.8}},
                       {"TrescaInSpace", more, tresca, 3, {0.6, -0.8}}};

class PushedBlock : public testing::TestWithParam<Push>
{
};
INSTANTIATE_TEST_SUITE_P(Laws, PushedBlock, testing::ValuesIn(pushes),
                         [](const auto &info) { return std::string(info.param.name); });

TEST_P(PushedBlock, IsHeldBelowTheLimit)
{
  const Push &push = GetParam();
  for (const double share : {0.5, 0.99, 0.9999}) {
    SCOPED_TRACE(share);
    const double force = share * push.limit;
    const Solution s = solved("push", push.by(force));
    EXPECT_TRUE(s.step.support.by_contact_only);
    for (int k = 0; k + 1 < push.dim; ++k) EXPECT_NEAR(s.contact.total.force[k], -force * push.along[k], 1e-8 * normal);
    EXPECT_NEAR(s.contact.total.force[push.dim - 1], normal, 1e-8 * normal);
    EXPECT_LE(s.uzawa.residuals.worst(), 1e-8);
  }
}

TEST_P(PushedBlock, IsHeldAMillionthBelowTheLimit)
{
  const Push &push = GetParam();
  const Solution s = solved("push", push.by(0.999999 * push.limit));
  for (int k = 0; k + 1 < push.dim; ++k)
    EXPECT_NEAR(s.contact.total.force[k], -0.999999 * push.limit * push.along[k], 1e-8 * normal);
}

TEST_P(PushedBlock, BeyondTheLimitIsRefusedWithIt)
{
  const Push &push = GetParam();
  for (const double share : {1.00001, 1.01, 1.5}) {
    SCOPED_TRACE(share);
    const Error error = error_of([&] { run_scene(friction_deck("push"), push.by(share * push.limit)); });
    EXPECT_EQ(error.code(), ExitCode::no_solution);
    EXPECT_NEAR(number_after(error.what(), "friction holds at most "), push.limit, 1e-6 * push.limit) << error.what();
    EXPECT_NEAR(number_after(error.what(), "with a resultant of "), share * push.limit, 1e-5 * push.limit);
  }
}

TEST(PushedBlockInSteps, EndsWithTheStepBelowTheLimit)
{
  std::ostream nowhere(nullptr);
  const Scene scene = read_scene(friction_deck("push"), {"Traction->left->X=" + text(holds) + "*t",
                                                         "Steps->Times={0.5, 0.9, 0.99, 0.99999, 1.00001}"});
  const Solution s = solve(scene, Tpetra::getDefaultComm(), nowhere);
  ASSERT_TRUE(s.failure);
  EXPECT_EQ(s.failure->code, ExitCode::no_solution);
  EXPECT_EQ(s.failure->time, 1.00001);
  EXPECT_NEAR(number_after(s.failure->reason, "friction holds at most "), holds, 1e-6 * holds) << s.failure->reason;
  EXPECT_EQ(s.time, 0.99999);
  EXPECT_NEAR(s.contact.total.force[0], -0.99999 * holds, 1e-8 * normal);
}

/// Pulled by the side, which moves on and on.
class DraggedBlock : public testing::TestWithParam<Push>
{
};
const Push drags[] = {{"Coulomb", holds, coulomb, 2, {1, 0}},
                      {"CoulombBackwards", holds, coulomb, 2, {-1, 0}},
                      {"Tresca", more, tresca, 2, {1, 0}},
                      {"CoulombOnAYieldingFoundation", holds, {"Contact->Yield Stress=60"}, 2, {1, 0}},
                      {"CoulombInSpace", holds, coulomb, 3, {0.6, 0.8}}};
INSTANTIATE_TEST_SUITE_P(Laws, DraggedBlock, testing::ValuesIn(drags),
                         [](const auto &info) { return std::string(info.param.name); });

TEST_P(DraggedBlock, SlidesOnAtTheLimit)
{
  const Push &drag = GetParam();
  // It sticks at first: the column shears by mu load / G = 0.01.
  constexpr double speed = 0.01;
  const bool plane = drag.dim == 2;
  Assignments deck = joined(drag.by(0), {"Steps->Times={0.2, 1, 4, 20, 100, 600, 3000}"});
  const std::string top = plane ? "top" : "front";
  for (int k = 0; k + 1 < drag.dim; ++k)
    deck.push_back("Dirichlet->" + top + "->" + "XY"[k] + "=" + text(speed * drag.along[k]) + "*t");
  const auto steps = solved_steps("push", deck);
  double before = 0, friction_before = 0;
  bool slides = false;
  for (const auto &s : steps) {
    SCOPED_TRACE(s.time);
    const auto &sums = s.contact.total;
    double force = 0;
    for (int k = 0; k + 1 < drag.dim; ++k) force -= sums.force[k] * drag.along[k];
    EXPECT_NEAR(sums.force[drag.dim - 1], normal, 1e-8 * normal);
    EXPECT_LE(force, drag.limit * (1 + 1e-8));
    for (int k = 0; k + 1 < drag.dim; ++k) // what holds the top pulls as much
      EXPECT_NEAR(s.reactions[0][k], -sums.force[k], 1e-8 * normal);
    const double dissipated = s.history.back().energies.friction;
    if (slides) {                                                         // as a whole, by as much as the top moves
      EXPECT_NEAR(force, drag.limit, (plane ? 1e-8 : 1e-6) * drag.limit); // in space directions settle
      for (int k = 0; k + 1 < drag.dim; ++k) EXPECT_NEAR(sums.force[k], -drag.limit * drag.along[k], 1e-6 * drag.limit);
      EXPECT_NEAR(sums.max_slip, speed * (s.time - before), 1e-6 * speed * (s.time - before));
      EXPECT_NEAR(dissipated - friction_before, drag.limit * speed * (s.time - before),
                  1e-6 * drag.limit * speed * (s.time - before));
      EXPECT_EQ(friction_counts(contact_points(s)).stick, 0);
    }
    slides = s.time >= (plane ? 20 : 600);
    before = s.time;
    friction_before = dissipated;
  }
  EXPECT_GT(friction_counts(contact_points(steps[0])).stick, 0);
}

TEST(PressFit, HoldsWhatItsOwnPressureBearsAndSaysSoWhereThatIsTooLittle)
{
  // Between two rigid walls 0.004 m nearer than it is long: E/(1 - nu^2) 0.002 = 2.2 Pa on 1 m each, and 0.3 of it along each wall.
  const auto pressed = [](const double weight) {
    return Assignments{"Contact->Side=left",
                       "Contact->Gap=-0.002",
                       "Contact->Sides->right->Side=right",
                       "Contact->Sides->right->Gap=-0.002",
                       "Contact->Sides->right->Friction Coefficient=0.3",
                       "Traction->top->Y=" + text(-0.5 * weight)};
  };
  const Solution held = solved("push", pressed(0.5));
  EXPECT_NEAR(held.contact.total.force[1], 0.5, 1e-8);
  EXPECT_TRUE(held.step.support.by_coulomb_only);
  const Solution slips = run_scene(friction_deck("push"), pressed(5));
  EXPECT_FALSE(slips.uzawa.converged);
  EXPECT_NE(slips.uzawa.reason.find("no pressures were found that hold it; raise the friction"), std::string::npos)
      << slips.uzawa.reason;
  EXPECT_EQ(slips.uzawa.reason.find("rounding"), std::string::npos) << slips.uzawa.reason;
}

TEST(SqueezedBlock, BetweenTwoFoundationsIsPulledOutAtTheSumOfTheirLimits)
{
  // Two plates 0.01 nearer than the block is high; it is pulled out by its right side.
  const auto steps = solved_steps(
      "push", joined(tight, {"Traction->top->Y=0", "Contact->Gap=-0.004", "Contact->Friction Coefficient=0.3",
                             "Contact->Sides->top->Gap=-0.006", "Contact->Sides->top->Friction Coefficient=0.15",
                             "Dirichlet->right->X=0.02*(t-1)^3", "Steps->Times={1, 1.2, 2, 3, 4}"}));
  double last = 0;
  for (const auto &s : steps) {
    SCOPED_TRACE(s.time);
    ASSERT_EQ(s.contact.sides.size(), 2u);
    const auto &below = s.contact.sides[0].force, &above = s.contact.sides[1].force;
    const double N = below[1];
    // The corners that are pulled are held by that: they bear no friction.
    std::array<double, 2> held{};
    for (const ContactPoint &point : contact_points(s))
      if (point.x[0] > 2 - 1e-9) held[point.x[1] > 0.5 ? 1 : 0] = point.weight * point.pressure;
    EXPECT_GT(N, 10);
    EXPECT_NEAR(above[1], -N, 1e-8 * N);
    EXPECT_LE(std::abs(below[0]), 0.3 * N * (1 + 1e-8));
    EXPECT_LE(std::abs(above[0]), 0.15 * N * (1 + 1e-8));
    EXPECT_NEAR(s.reactions[0][0], -below[0] - above[0], 1e-8 * N);
    if (s.time >= 3) {
      EXPECT_NEAR(below[0], -0.3 * (N - held[0]), 1e-8 * N);
      EXPECT_NEAR(above[0], -0.15 * (N - held[1]), 1e-8 * N);
      EXPECT_EQ(s.contact.total.stick_length, 0);
      if (s.time >= 4) {
        EXPECT_NEAR(s.reactions[0][0], last, 1e-8 * N);
      }
    }
    last = s.reactions[0][0];
  }
}

} // namespace
} // namespace friction_limit_test
