// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/load_history.hpp"

#include "expect_error.hpp"
#include "load_scenes.hpp"
#include "rpc/contact/node_columns.hpp"
#include "solved.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace load_history_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using analysis::LoadHistory;
using analysis::Problem;
using analysis::StepSolution;

// A block that is pressed uniformly ---------------------------------------------------------------------------------------

/// The same in one dimension, by hand: block and spring in series give d - w = a p, a = h/M + 1/k.
struct ByHand {
  Law law;
  double pressed = 0, pressure = 0, dent = 0, dissipated = 0, work = 0;

  void press(const double d)
  {
    const double a = 1 / modulus + law.compliance(), before = pressure;
    const double limit = law.yield + law.hardening * dent; // H = 0 where it never yields
    pressure = std::max(0., (d - dent) / a);
    if (pressure > limit) {
      const double deeper = (d - a * law.yield) / (1 + a * law.hardening);
      dissipated += law.yield * (deeper - dent) + 0.5 * law.hardening * (deeper * deeper - dent * dent);
      dent = deeper;
      pressure = law.yield + law.hardening * dent;
    }
    work += 0.5 * (before + pressure) * (d - pressed);
    pressed = d;
  }
};

TEST(LoadHistory, OfABlockUnderUniformPressureIsThatByHand)
{
  // Pressed, deeper, halfway back, lifted, pressed as deep as before, deeper, back to where it lifts off.
  const std::vector<double> path = {0.01, 0.05, 0.03, -0.02, 0.05, 0.09, 0.04, 0.};
  const auto pressed = [&path](const double t) { return path[static_cast<std::size_t>(t + 0.5) - 1]; };
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    auto history = history_of(column(law, pressed));
    ByHand expected{law};
    bool lifted = false, yielded = false;
    for (std::size_t k = 0; k < path.size(); ++k) {
      SCOPED_TRACE(k);
      const StepSolution s = advance(history, k + 1.);
      expected.press(path[k]);
      const double p = expected.pressure, width = 2;
      const auto &found = s.contact.total;
      const double force = 1e-9 * width * 3, length = 1e-10, energy = 1e-10;
      EXPECT_NEAR(found.force[1], width * p, force);
      EXPECT_NEAR(found.force[0], 0, force);
      EXPECT_NEAR(found.max_dent, expected.dent, length);
      EXPECT_NEAR(found.dent_volume, width * expected.dent, length);
      EXPECT_NEAR(s.reactions[2][1], -width * p, force);
      const analysis::Energies &e = history.last().energies;
      EXPECT_NEAR(e.strain, width * 0.5 * p * p / modulus, energy);
      EXPECT_NEAR(e.foundation, width * 0.5 * law.compliance() * p * p, energy);
      EXPECT_NEAR(e.dissipated, width * expected.dissipated, energy);
      EXPECT_NEAR(e.work, width * expected.work, energy);
      const auto dent = to_host(s.contact.dent);
      for (std::size_t i = 0; i < dent.extent(0); ++i) EXPECT_NEAR(dent(i), expected.dent, length);
      EXPECT_NEAR(history.last().displacements[2][1], -path[k], 1e-14);
      EXPECT_EQ(history.last().time, k + 1.);
      EXPECT_TRUE(history.last().converged);
      lifted = lifted || (expected.dent > 0 && p == 0);
      yielded = yielded || expected.dent > 0;
    }
    EXPECT_EQ(lifted && yielded, std::isfinite(law.yield));
  }
}

TEST(LoadHistory, GapsThatCloseOrOverlapAtFirstCountAsPenetration)
{
  for (const double gap : {0.02, -0.02})
    for (const Law &law : laws) {
      SCOPED_TRACE(law.name);
      auto model = column(law, [](const double t) { return t == 2 ? 0.01 : 0.05; });
      model.contact[0].gap = ScalarField(gap);
      auto history = history_of(model);
      ByHand expected{law};
      for (const double t : {1., 2., 3.}) {
        const StepSolution s = advance(history, t);
        expected.press((t == 2 ? 0.01 : 0.05) - gap);
        EXPECT_NEAR(s.contact.total.force[1], 2 * expected.pressure, 1e-8) << gap << " " << t;
        EXPECT_NEAR(s.contact.total.max_dent, expected.dent, 1e-10) << gap << " " << t;
        EXPECT_NEAR(history.last().energies.dissipated, 2 * expected.dissipated, 1e-10) << gap << " " << t;
      }
    }
}

TEST(LoadHistory, OfABlockThatContactAloneHoldsFollowsItsLoad)
{
  // Hardening carries any load: w = (q - xi)/H. The perfectly plastic one carries less than xi.
  const auto load = [](const double t) { return t < 1.5 ? 2. : t < 2.5 ? 5. : t < 3.5 ? 1. : 7.; };
  auto model = column({"hardening", 3, 40, 200}, load);
  model.dirichlet.pop_back();
  model.tractions.push_back(
      {"top", "top", {ScalarField(0.), in_time([load](const Point &, const double t) { return -load(t); })}});
  auto history = history_of(model);
  for (const double t : {1., 2., 3., 4.}) {
    const StepSolution s = advance(history, t);
    const double dent = t == 1 ? 0 : t == 4 ? 4 / 40. : 2 / 40.;
    EXPECT_NEAR(s.contact.total.force[1], 2 * load(t), 1e-8);
    EXPECT_NEAR(s.contact.total.max_dent, dent, 1e-9);
    EXPECT_NEAR(s.contact.total.max_penetration, dent + load(t) / 200, 1e-9);
  }
}

// A block that is pressed unevenly ----------------------------------------------------------------------------------------

TEST(LoadHistory, MonotonePathsEndWhereOneStepEnds)
{
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    auto model = uneven(law, ramp);
    model.contact[0].gap = ScalarField(0.); // a proportional path
    auto once = history_of(model);
    const StepSolution expected = advance(once, 1);
    EXPECT_EQ(expected.contact.total.max_dent > 0, std::isfinite(law.yield));
    for (const int steps : {3, 10}) {
      auto history = history_of(model);
      StepSolution s;
      for (int k = 1; k <= steps; ++k) s = advance(history, k / double(steps));
      EXPECT_LT(distance(*s.u, *expected.u), 1e-9) << steps;
      EXPECT_LT(distance(*history.memory()->pressure, *once.memory()->pressure), 1e-8) << steps;
      if (std::isfinite(law.yield)) {
        EXPECT_LT(distance(*history.memory()->dent, *once.memory()->dent), 1e-8) << steps;
      }
      EXPECT_NEAR(history.last().energies.dissipated, once.last().energies.dissipated, 1e-9 * once.last().energies.work)
          << steps;
    }
  }
}

TEST(LoadHistory, RepeatingALoadYieldsNothingNew)
{
  for (const Law &law : laws) {
    if (std::isinf(law.yield)) continue;
    SCOPED_TRACE(law.name);
    auto history = history_of(uneven(law, to_and_fro));
    const StepSolution first = advance(history, 1);
    const auto dent = history.memory()->dent;
    const double dissipated = history.last().energies.dissipated;
    EXPECT_GT(first.contact.total.yielded_length, 0.1);
    for (const double t : {2., 3.}) {
      const StepSolution s = advance(history, t);
      EXPECT_LT(distance(*history.memory()->dent, *dent), 1e-9) << t;
      EXPECT_NEAR(history.last().energies.dissipated, dissipated, 1e-9 * dissipated) << t;
      if (t == 3) {
        EXPECT_LT(distance(*s.u, *first.u), 1e-9);
      }
    }
    advance(history, 4);
    EXPECT_GT(history.last().energies.dissipated, 1.1 * dissipated);
  }
}

/// The dents at all nodes of the bottom, by number along it, on all ranks.
std::vector<double> bottom_dents(const LoadHistory &history)
{
  const mesh::Mesh &mesh = *history.problem().discretization().mesh;
  const auto coords = to_host(mesh.coords);
  const auto dent = history.memory()->dent->getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<double> mine(13, 0.), all(13);
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
    if (coords(n, 1) == 0) mine[static_cast<std::size_t>(std::lround(6 * coords(n, 0)))] = dent(n, 0);
  Teuchos::reduceAll(mesh.comm(), Teuchos::REDUCE_SUM, 13, mine.data(), all.data());
  return all;
}

TEST(LoadHistory, UnloadingIsSignorinisProblemWithTheDentAddedToTheGap)
{
  for (const Law &law : {laws[0], laws[1], laws[2]}) {
    SCOPED_TRACE(law.name);
    const auto model = uneven(law, to_and_fro);
    auto history = history_of(model);
    advance(history, 1);
    const std::vector<double> dent = bottom_dents(history);
    EXPECT_GT(*std::max_element(dent.begin(), dent.end()), 0.01);
    const StepSolution unloaded = advance(history, 2);
    EXPECT_LT(unloaded.contact.total.contact_length, 1.99);
    EXPECT_GT(unloaded.contact.total.contact_length, 0.1);

    auto signorini = model;
    signorini.contact[0].gap = in_time([&dent](const Point &x, double) {
      return 0.004 * x[0] + dent[static_cast<std::size_t>(std::lround(6 * x[0]))];
    });
    signorini.contact[0].yield_stress = ScalarField(inf);
    signorini.contact[0].hardening = ScalarField(0.);
    const Problem problem(block(), signorini, 2);
    const auto expected = test::solved(problem, problem.step(2), close());
    EXPECT_TRUE(expected.uzawa.converged) << expected.uzawa.reason;
    EXPECT_LT(distance(*unloaded.u, *expected.u), 1e-9);
    EXPECT_NEAR(unloaded.contact.total.force[1], expected.contact.total.force[1],
                1e-9 * expected.contact.total.force[1]);
    EXPECT_EQ(unloaded.contact.total.yielded_length, 0);
    EXPECT_EQ(unloaded.contact.total.dissipated, 0);
  }
}

TEST(LoadHistory, ReversibleLawForgetsAndItsEnergyComesBack)
{
  for (const Law &law : {laws[0], laws[3]}) {
    SCOPED_TRACE(law.name);
    auto model = uneven(law, to_and_fro);
    model.contact[0].remembers = false;
    auto history = history_of(model);
    for (const double t : {1., 2., 4., 1.5}) {
      // time that runs back is no history, but its own problem
      if (t < history.last().time) break;
      const StepSolution s = advance(history, t);
      const Problem problem(block(), model, t);
      const auto expected = test::solved(problem, problem.step(t), close());
      EXPECT_LT(distance(*s.u, *expected.u), 1e-9) << t;
      EXPECT_NEAR(s.contact.total.max_dent, expected.contact.total.max_dent, 1e-10) << t;
      EXPECT_EQ(history.memory()->dent->getVector(0)->normInf(), 0);
      const analysis::Energies &e = history.last().energies;
      EXPECT_EQ(e.dissipated, 0) << t;
      // what the foundation stores is sum of w psi(v): here by what the body and its loads leave of J, (1.4)
      const double stored = e.foundation, external = expected.energy - 0.5 * expected.energy_norm_squared - stored;
      double load_work = 0;
      load_work = -s.step.elastic.applied_load->dot(*s.u);
      EXPECT_NEAR(external, load_work, 1e-9 * std::abs(load_work)) << t;
    }
  }
}

TEST(LoadHistory, OneOfTwoFoundationsMayForget)
{
  auto model = uneven(laws[0], to_and_fro);
  model.dirichlet.erase(model.dirichlet.begin());
  model.dirichlet[0].displacement[0] = ScalarField(0.);
  model.contact[0].remembers = false;
  auto wall = foundation("left", {"soft", 0.4, 5, inf});
  model.tractions[0].traction[0] = in_time([](const Point &, const double t) { return -1.5 * to_and_fro(t); });
  model.contact.push_back(wall);
  auto history = history_of(model);
  for (const double t : {1., 2., 3.}) {
    const StepSolution s = advance(history, t);
    if (t == 1) {
      EXPECT_GT(s.contact.sides[0].max_dent, 1e-3);
      EXPECT_GT(s.contact.sides[1].max_dent, 1e-3);
    }
    EXPECT_EQ(history.memory()->dent->getVector(0)->normInf(), 0);
    EXPECT_EQ(history.memory()->dent->getVector(1)->normInf(), s.contact.sides[1].max_dent);
  }
}

// Other meshes, options -------------------------------------------------------------------------------------------------

TEST(LoadHistory, GoesOnFromWhatIsRemembered)
{
  const auto model = uneven(laws[3], to_and_fro);
  auto whole = history_of(model), first = history_of(model), second = history_of(model);
  for (const double t : {1., 2.}) {
    advance(whole, t);
    advance(first, t);
  }
  second.go_on_from(*first.memory());
  const StepSolution expected = advance(whole, 4), s = advance(second, 4);
  EXPECT_LT(distance(*s.u, *expected.u), 1e-9);
  EXPECT_LT(distance(*second.memory()->dent, *whole.memory()->dent), 1e-9);
  const analysis::Energies &a = second.last().energies, &b = whole.last().energies;
  EXPECT_NEAR(a.work, b.work, 1e-10 * b.work);
  EXPECT_NEAR(a.dissipated, b.dissipated, 1e-10 * b.work);
  EXPECT_NEAR(a.imbalance, b.imbalance, 1e-10 * b.work);
}

TEST(LoadHistory, WhatIsRememberedGoesToOtherMeshesByInterpolation)
{
  auto history = history_of(uneven(laws[1], to_and_fro));
  advance(history, 1);
  const auto &coarse = history.problem().discretization();
  const auto fine = fem::discretize(block(2));
  const analysis::Memory there = analysis::interpolated(*history.memory(), coarse, fine);
  EXPECT_EQ(there.time, 1);
  EXPECT_EQ(there.energies.work, history.memory()->energies.work);
  const std::vector<double> dent = bottom_dents(history);
  const auto coords = to_host(fine.mesh->coords);
  const auto found = there.dent->getLocalViewHost(Tpetra::Access::ReadOnly);
  double largest = 0;
  for (LO n = 0; n < fine.mesh->num_owned_nodes(); ++n) {
    if (coords(n, 1) > 0) continue;
    const auto k = static_cast<std::size_t>(std::lround(12 * coords(n, 0)));
    EXPECT_NEAR(found(n, 0), 0.5 * (dent[k / 2] + dent[(k + 1) / 2]), 1e-15);
    largest = std::max(largest, found(n, 0));
  }
  EXPECT_GT(max_all(fine.mesh->comm(), largest), 1e-3);
  auto finer = history_of(uneven(laws[1], to_and_fro), close(), 0, 1, 2);
  finer.go_on_from(there);
  const StepSolution again = advance(finer, 3);
  EXPECT_EQ(again.step.contact.num_total, 25);
  EXPECT_LT(again.contact.total.dissipated, 0.1 * history.last().energies.dissipated); // the dents are there already
}

TEST(LoadHistory, DentsOfTheFoundationNeitherRiseNorFallOnAnotherMesh)
{
  // The deepest dent lies at a node that the other mesh does not have.
  auto model = column(laws[0], [](const double t) { return t == 2 ? -0.01 : 0.06; });
  model.contact[0].gap = in_time([](const Point &x, double) { return 0.02 * std::abs(x[0] - 13. / 12); });
  auto fine = history_of(model, close(), 0, 1, 2), coarse = history_of(model);
  const contact::ContactSums before = advance(fine, 1).contact.total;
  EXPECT_GT(before.max_dent, 1e-3);
  coarse.go_on_from(
      analysis::interpolated(*fine.memory(), fine.problem().discretization(), coarse.problem().discretization()));
  EXPECT_LT(coarse.memory()->dent->getVector(0)->normInf(), 0.99 * before.max_dent);
  const contact::ContactSums lifted = advance(coarse, 2).contact.total;
  EXPECT_EQ(lifted.max_dent, before.max_dent);
  EXPECT_EQ(lifted.dent_volume, before.dent_volume);
  const contact::ContactSums again = advance(coarse, 3).contact.total;
  EXPECT_GE(again.max_dent, before.max_dent);
  EXPECT_GE(again.dent_volume, before.dent_volume);
  const double dissipated = coarse.last().energies.dissipated;
  EXPECT_NEAR(laws[0].yield * again.dent_volume, dissipated, 1e-9 * dissipated);
}

TEST(Steps, TimesMustRiseAndNumbersBeInRange)
{
  const auto read = [](const Teuchos::Array<double> &times, const int every, const int halvings) {
    Teuchos::ParameterList list = analysis::valid_steps_parameters();
    list.set("Times", times);
    list.set("Write Every", every);
    list.set("Max Halvings", halvings);
    return analysis::steps_options(list);
  };
  const auto options = read(Teuchos::tuple(0.5, 1., 4.), 3, 2);
  EXPECT_EQ(options.times, (std::vector<double>{0.5, 1, 4}));
  EXPECT_EQ(options.write_every, 3);
  EXPECT_EQ(options.max_halvings, 2);
  EXPECT_TRUE(analysis::steps_options(analysis::valid_steps_parameters()).times.empty());
  expect_error(ExitCode::bad_input, {"\"Steps->Times\"", "rise", "got 1 after 1"},
               [&] { read(Teuchos::tuple(0.5, 1., 1.), 1, 0); });
  expect_error(ExitCode::bad_input, {"\"Steps->Times\"", "finite"}, [&] { read(Teuchos::tuple(inf), 1, 0); });
  expect_error(ExitCode::bad_input, {"\"Steps->Write Every\"", "> 0", "got 0"},
               [&] { read(Teuchos::tuple(1.), 0, 0); });
  for (const int halvings : {-1, 31})
    expect_error(ExitCode::bad_input, {"\"Steps->Max Halvings\"", "[0, 30]", std::to_string(halvings)},
                 [&] { read(Teuchos::tuple(1.), 1, halvings); });
}

} // namespace
} // namespace load_history_test
