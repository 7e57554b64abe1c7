// SPDX-License-Identifier: BSD-3-Clause
#include "friction_reference.hpp"
#include "friction_scene.hpp"

// Friction against an independent program (dense Schur complements of the contact unknowns, exact solves), closed forms and
// published values.

namespace friction_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr double close = 1e-8;

class FrictionScene : public testing::TestWithParam<FrictionReference>
{
};
INSTANTIATE_TEST_SUITE_P(References, FrictionScene, testing::ValuesIn(friction_references),
                         [](const auto &info) { return std::string(info.param.name); });

TEST_P(FrictionScene, IsThatOfAnIndependentProgram)
{
  const FrictionReference &reference = GetParam();
  const Solution s = solved(reference.name);
  const int dim = s.discretization.dim();
  const auto &found = s.contact.total;
  EXPECT_NEAR(s.energy, reference.energy, close * std::abs(reference.energy));
  EXPECT_NEAR(s.energy_norm_squared, reference.energy_norm_squared, close * reference.energy_norm_squared);
  EXPECT_NEAR(found.force[dim - 1], reference.normal, close * reference.normal);
  for (int k = 0; k + 1 < dim; ++k)
    EXPECT_NEAR(found.force[k], -reference.tangential[k], close * std::abs(reference.tangential[k]));
  EXPECT_NEAR(found.max_pressure, reference.max_pressure, close * reference.max_pressure);
  EXPECT_NEAR(found.max_shear, reference.max_shear, close * reference.max_shear);
  EXPECT_NEAR(found.max_penetration, reference.max_penetration, close * reference.max_penetration + 1e-18);
  EXPECT_NEAR(found.max_slip, reference.max_slip, close * reference.max_slip);
  EXPECT_NEAR(found.friction_work, reference.friction_work, close * reference.friction_work);
  EXPECT_NEAR(found.dissipated, reference.dissipated, close * reference.dissipated + 1e-18);
  EXPECT_LE(s.uzawa.newton_iterations.front(), 12);
  EXPECT_EQ(s.line_search_steps, 0);
  EXPECT_EQ(s.linear.preconditioner_setups, 1);
}

TEST_P(FrictionScene, HasTheStatesOfAnIndependentProgramAtAllPoints)
{
  const FrictionReference &reference = GetParam();
  const Solution s = solved(reference.name);
  const auto points = contact_points(s);
  std::array<int, 3> of_state{};
  for (const ContactPoint &point : points)
    if (!point.fixed) ++of_state[point.state];
  EXPECT_EQ(of_state[static_cast<int>(contact::State::open)], reference.open);
  EXPECT_EQ(of_state[static_cast<int>(contact::State::closed)], reference.closed);
  EXPECT_EQ(of_state[static_cast<int>(contact::State::yielding)], reference.yielding);
  const FrictionCounts n = friction_counts(points);
  EXPECT_EQ(n.stick, reference.stick);
  EXPECT_EQ(n.slip, reference.slip);
  if (s.discretization.dim() == 2) {
    EXPECT_EQ(n.forward, reference.forward);
    EXPECT_EQ(n.backward, reference.backward);
    EXPECT_EQ(n.stick_open + n.slip_open, 0); // Coulomb's law
  } else {
    EXPECT_EQ(n.slip_open, 32); // Tresca's acts on open points too
    EXPECT_EQ(n.stick_open, 1);
  }
}

TEST_P(FrictionScene, HasTheTractionsOfAnIndependentProgram)
{
  const FrictionReference &reference = GetParam();
  const Solution s = solved(reference.name, {"Uzawa->Tolerance=1e-10"}); // 1e-8 is how far the tractions may be (5.10)
  const auto points = contact_points(s);
  double u_max = 0, slip_max = 0;
  for (const FrictionSample &sample : reference.samples) {
    u_max = std::max(u_max, std::abs(sample.u_nu));
    slip_max = std::max(slip_max, std::hypot(sample.slip[0], sample.slip[1]));
  }
  for (const FrictionSample &sample : reference.samples) {
    SCOPED_TRACE(sample.x);
    const auto point = std::find_if(points.begin(), points.end(), [&](const ContactPoint &c) {
      return std::hypot(c.x[0] - sample.x, c.x[1], c.x[2]) < 1e-6 * points.back().x[0];
    });
    ASSERT_NE(point, points.end());
    EXPECT_NEAR(point->pressure, sample.p, close * reference.max_pressure);
    EXPECT_NEAR(point->u_nu, sample.u_nu, close * u_max);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(point->q[k], sample.q[k], close * reference.max_shear);
      // Open points slip freely without Tresca's bound: no friction, no slip to speak of.
      if (point->slip_state != 0) {
        EXPECT_NEAR(point->slip[k], sample.slip[k], close * slip_max);
      }
    }
  }
}

TEST(Wedge, IsHeldByItsClosedForm)
{
  const double slope = std::atan(0.2), mu = 0.3, push = 10;
  const double normal = push / (std::sin(slope) + mu * std::cos(slope));
  const Solution s = solved("wedge");
  const auto &force = s.contact.total.force;
  EXPECT_NEAR(-force[0] * std::sin(slope) + force[1] * std::cos(slope), normal, 1e-9 * normal);
  EXPECT_NEAR(-force[0] * std::cos(slope) - force[1] * std::sin(slope), mu * normal, 1e-9 * normal);
  // What has no closed form is the independent program's.
  EXPECT_NEAR(s.energy, -0.29856226131053626, close * 0.2986);
  EXPECT_NEAR(s.energy_norm_squared, 0.19884326938815397, close * 0.1988);
  EXPECT_NEAR(s.contact.total.friction_work, 0.19914062661645565, close * 0.1991);
  EXPECT_NEAR(s.contact.total.max_pressure, 37.52837574847194, close * 37.5);
  EXPECT_NEAR(s.contact.total.max_shear, 0.3 * s.contact.total.max_pressure, 1e-12);
  EXPECT_NEAR(s.contact.total.max_slip, 0.036344138226771704, close * 0.0363);
  const FrictionCounts n = friction_counts(contact_points(s));
  EXPECT_EQ(n.slip, 33);
  EXPECT_EQ(n.stick, 0);
  EXPECT_LE(s.uzawa.newton_iterations.front(), 5);
}

// The plain iteration over the bounds moves away by the factor 0.3/0.2.
TEST(Wedge, FollowsFromTrescaProblemsWithAcceleratedBounds)
{
  const Solution s = solved("wedge", {"NOX->Direction->Method=Newton"});
  EXPECT_GT(s.uzawa.iterations, 3);
  EXPECT_LE(s.uzawa.iterations, 25);
  const double slope = std::atan(0.2), normal = 10 / (std::sin(slope) + 0.3 * std::cos(slope));
  const auto &force = s.contact.total.force;
  EXPECT_NEAR(-force[0] * std::sin(slope) + force[1] * std::cos(slope), normal, 1e-6 * normal);
}

TEST(Greco, ProbesAreThePublishedOnes)
{
  const Solution s = solved("greco");
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto x = to_host(mesh.coords);
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  int found = 0;
  for (LO node = 0; node < mesh.num_owned_nodes(); ++node)
    for (const auto &[at, published] : {std::pair(0., 28.6), {0.00125, 27.2}, {0.005, 22.8}, {0.0075, 19.8}}) {
      if (x(node, 1) > 1e-12 || std::abs(x(node, 0) - at) > 1e-9) continue;
      EXPECT_NEAR(1e6 * u(2 * node, 0), published, 0.06) << at;
      ++found;
    }
  EXPECT_EQ(sum_all(mesh.comm(), GO(found)), 4);
}

/// A column of height 1 and width 2 on the foundation, pressed down by 0.01, whose top is moved along it: elastic, perfectly plastic
/// friction. All is uniform.
struct Column {
  double shear = 1000 / 2.6, confined = 1000 * 0.7 / (1.3 * 0.4), pressure, dent, bound;
  double q = 0, top = 0, slipped = 0, dissipated = 0; // now, and since the start
  double slip = 0, moment = 0;                        // of the step: its slip, and s |e| over the width

  /// On a foundation that yields at this pressure, with mu = 0.2.
  explicit Column(const double yield_stress)
      : pressure(std::min(confined * 0.01, yield_stress)), dent(0.01 - pressure / confined), bound(0.2 * pressure)
  {
  }
  void move_top(const double to)
  {
    const double before = q;
    q = std::max(-bound, std::min(bound, q + shear * (to - top)));
    slip = to - q / shear - slipped;
    slipped += slip;
    top = to;
    moment = 2 * bound * std::abs(slip);
    dissipated += 2 * slip * (q + before) / 2;
  }
  /// Sides are loaded alike, so that their tractions do no work on the uniform motion: J = a(u, u)/2 + xi times new dents.
  double energy(const double new_dent) const
  {
    return pressure * pressure / confined + q * q / shear + 2 * pressure * new_dent;
  }
};

void expect_column(const std::string &name, Column column, const bool yields)
{
  const auto steps = solved_steps(name);
  ASSERT_GT(steps.size(), 6u);
  for (const auto &s : steps) {
    SCOPED_TRACE(s.time);
    const analysis::StepRecord &record = s.history.back();
    const bool first = s.history.size() == 1;
    column.move_top(record.displacements.front()[0]);
    EXPECT_NEAR(s.contact.total.force[0], -2 * column.q, close * column.bound);
    EXPECT_NEAR(s.contact.total.force[1], 2 * column.pressure, close * column.pressure);
    EXPECT_NEAR(s.contact.total.max_shear, std::abs(column.q), close * column.bound);
    EXPECT_NEAR(s.energy, column.energy(first ? column.dent : 0), close * column.energy(0));
    EXPECT_NEAR(s.contact.total.friction_work, column.moment, close * column.bound * 0.01);
    EXPECT_NEAR(record.energies.friction, column.dissipated, close * column.bound * 0.01);
    EXPECT_NEAR(record.energies.dissipated, 2 * column.pressure * column.dent, close * column.pressure * 0.01);
    if (!yields) { // the first step's trapezoid misses where it yields
      EXPECT_NEAR(record.energies.imbalance, 0, 1e-10);
    }
    EXPECT_LE(record.newton_iterations, 4);
    const auto points = contact_points(s);
    for (const ContactPoint &point : points) {
      EXPECT_NEAR(point.q[0], column.q, close * column.bound);
      EXPECT_NEAR(point.pressure, column.pressure, close * column.pressure);
    }
    // Where a foundation that has yielded is pressed on at its limit, sticking and slipping is a matter of rounding.
    if (yields && !first) continue;
    const FrictionCounts n = friction_counts(points);
    EXPECT_EQ(n.stick, std::abs(column.slip) < 1e-12 ? 9 : 0);
    EXPECT_EQ(n.forward, column.slip > 1e-12 ? 9 : 0);
    EXPECT_EQ(n.backward, column.slip < -1e-12 ? 9 : 0);
  }
}

TEST(Loop, FollowsItsClosedFormThroughReversals)
{
  expect_column("loop", Column(1e9), false);
}

TEST(Loop, OnAYieldingFoundationSlipsAtTheYieldStressTimesMu)
{
  expect_column("loop_yield", Column(10), true);
}

} // namespace
} // namespace friction_test
