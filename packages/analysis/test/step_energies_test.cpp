// SPDX-License-Identifier: BSD-3-Clause
/// The balance of energies along a load history.
#include "load_scenes.hpp"
#include "rpc/contact/surface/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace step_energies_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using analysis::StepSolution;

TEST(LoadHistory, EnergiesBalanceToTheSquareOfTheStep)
{
  const double pi = std::acos(-1.);
  const auto smooth = [pi](const double t) { return 2.2 * std::sin(0.5 * pi * t) * std::sin(0.5 * pi * t); };
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    // Up to t = 1, back to 2: all kinds of kinks on the way.
    std::vector<double> missed;
    double work = 0;
    for (const int steps : {16, 64}) {
      auto history = history_of(uneven(law, smooth), {}, 0, 2. / steps);
      double sum = 0, before = 0;
      for (int k = 1; k <= steps; ++k) {
        advance(history, 2. * k / steps);
        const double now = history.last().energies.imbalance;
        sum += std::abs(now - before);
        before = now;
        work = std::max(work, history.last().energies.work);
      }
      missed.push_back(sum);
    }
    EXPECT_GT(missed[1], 1e-9 * work); // what is measured is not rounding
    EXPECT_GT(std::log2(missed[0] / missed[1]) / 2, 1.7) << missed[0] << " " << missed[1];
  }
}

TEST(LoadHistory, StepsAreDividedUntilTheirEnergiesBalance)
{
  const auto there_and_back = [](const double t) { return t <= 1 ? 2 * t : 4 - 2 * t; };
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    std::vector<double> missed;
    std::vector<int> parts;
    for (const double tolerance : {std::numeric_limits<double>::infinity(), 1e-2, 1e-4}) {
      auto history = history_of(uneven(law, there_and_back), {}, 0, 1);
      analysis::StepsOptions balanced;
      balanced.energy_tolerance = tolerance;
      history.balance_energies(balanced);
      analysis::Energies before;
      missed.push_back(0);
      parts.push_back(0);
      for (const double t : {1., 2.}) {
        advance(history, t);
        const analysis::Energies now = history.last().energies;
        missed.back() = std::max(missed.back(), analysis::relative_imbalance(before, now));
        parts.back() += history.last().parts;
        EXPECT_LE(analysis::relative_imbalance(before, now), tolerance) << t;
        before = now;
      }
    }
    EXPECT_EQ(parts[0], 2);
    EXPECT_GT(missed[0], 0.02); // points close and open within the steps
    EXPECT_LT(missed[2], 0.1 * missed[0]);
    EXPECT_GT(parts[2], parts[1]);
  }
}

TEST(LoadHistory, EnergiesBalanceToTheSquareOfTheStepWhereNormalsTurn)
{
  auto model = column(laws[0], [](double) { return 0.02; });
  model.dirichlet = {prescribed("top", ScalarField(0.1), ScalarField(-0.02))};
  auto &ball = model.contact[0].obstacle;
  ball.surface = contact::Sphere{3};
  ball.path[0] = in_time([](const Point &, const double t) { return 0.8 + 0.2 * t; });
  ball.path[1] = ScalarField(-3.);
  ball.point = {0.8, -3, 0};
  model.contact[0].normal = contact::Normal::foundation;
  std::vector<double> missed;
  for (const int steps : {4, 16}) {
    auto history = history_of(model, close(), 0, 1, 2);
    advance(history, 1);
    double sum = 0, before = history.last().energies.imbalance;
    for (int k = 1; k <= steps; ++k) {
      advance(history, 1 + 1. * k / steps);
      const double now = history.last().energies.imbalance;
      sum += std::abs(now - before);
      before = now;
    }
    missed.push_back(sum);
  }
  EXPECT_GT(missed[1], 1e-10);
  EXPECT_GT(std::log2(missed[0] / missed[1]) / 2, 1.5) << missed[0] << " " << missed[1];
}

TEST(LoadHistory, EnergiesBalanceExactlyOnProportionalElasticPaths)
{
  // Without gap, yielding and states that change, all is linear in the load, and the trapezoid exact.
  auto model = uneven(laws[4], ramp);
  model.contact[0].gap = ScalarField(0.);
  model.tractions[0].traction[0] = ScalarField(0.);
  model.dirichlet.pop_back();
  auto history = history_of(model);
  for (const double t : {0.3, 1., 0.4 + 1}) {
    const StepSolution s = advance(history, t);
    ASSERT_EQ(s.contact.total.contact_length, 2);
    const analysis::Energies &e = history.last().energies;
    EXPECT_GT(e.foundation, 0.01 * e.work);
    EXPECT_NEAR(e.imbalance, 0, 1e-10 * e.work) << t;
  }
}

} // namespace
} // namespace step_energies_test
