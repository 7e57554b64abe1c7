// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/load_history.hpp"
#include "rpc/contact/moving_dents.hpp"
#include "rpc/contact/node_columns.hpp"
#include "rpc/contact/surface/plane.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/box.hpp"
#include "solved.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

namespace foundation_dents_test
{
namespace
{

using namespace rpc;
using analysis::LoadHistory;
using analysis::Model;
using analysis::StepSolution;
using contact::DentsMoveWith;

constexpr double cell = 0.25, xi = 5;
constexpr int num_points = 17; // of the side

ScalarField field(std::function<double(const Point &, double)> f)
{
  return ScalarField("test", std::move(f));
}
ScalarField in_time(std::function<double(double)> f)
{
  return field([f = std::move(f)](const Point &, const double t) { return f(t); });
}

/// Numbers by time, linear in between, from 0 at t = 0.
struct Course {
  std::vector<double> values;

  double operator()(const double t) const
  {
    const int last = static_cast<int>(values.size());
    const int k = std::min(static_cast<int>(t), last - 1);
    const double before = k == 0 ? 0 : values[k - 1];
    return before + (t - k) * (values[k] - before);
  }
};

/// A block of 16 x 4 cells, 4 m by 1 m, of which the bottom slides.
Model sliding(const Course &slide, const DentsMoveWith carrier)
{
  Model model;
  model.materials = fem::Material{100, 0.3};
  contact::ContactOptions foundation;
  foundation.side = "bottom";
  foundation.yield_stress = ScalarField(xi);
  foundation.dents_move_with = carrier;
  model.contact.push_back(foundation);
  model.dirichlet.push_back({"bottom", "bottom", {in_time(slide), std::nullopt, std::nullopt}});
  return model;
}

/// The same, pressed at its top; its bottom is an arch, lowest at x = 2.
Model pressed(const Course &slide, const Course &press, const DentsMoveWith carrier)
{
  Model model = sliding(slide, carrier);
  model.contact[0].gap = field([](const Point &x, double) { return 0.02 * std::pow(x[0] - 2, 2); });
  model.dirichlet.push_back(
      {"top", "top", {in_time(slide), in_time([press](const double t) { return -press(t); }), std::nullopt}});
  return model;
}

/// In space the block is a slice that does not move across.
std::shared_ptr<const analysis::Problem> problem(Model model, const mesh::Element &element = {2, 1})
{
  mesh::BoxOptions box{{0, 0}, {4, 1}, {16, 4}, element};
  if (element.dim == 3) {
    box = {{0, 0, 0}, {4, 0.5, 1}, {16, 2, 4}, element};
    for (auto &condition : model.dirichlet) condition.displacement[2] = ScalarField(0.);
  }
  return std::make_shared<analysis::Problem>(
      std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())), model, 1.);
}

analysis::StepOptions exact()
{
  analysis::StepOptions options;
  options.uzawa.tolerance = 1e-10;
  options.newton.residual_tolerance = 1e-12;
  return options;
}

/// Values at the bottom's nodes from left to right, on all ranks.
std::vector<double> along_bottom(const fem::Discretization &d, const MultiVector &columns)
{
  std::vector<double> values(num_points, 0.);
  const auto coords = to_host(d.mesh->coords);
  const auto from = columns.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
    if (coords(n, 1) == 0) values[std::lround(coords(n, 0) / cell)] = from(n, 0);
  return summed(d.mesh->comm(), values);
}
/// The dents under the body's place in the mesh, (owned nodes; sides).
RCP<const MultiVector> dents_in_place(const LoadHistory &history)
{
  const fem::Discretization &d = history.problem().discretization();
  const analysis::Memory &memory = *history.memory();
  return contact::dents_met(d, history.problem().model().contact, memory.dent, memory.foundations,
                            Vector(d.owned_dofs));
}
std::vector<double> dents(const LoadHistory &history)
{
  return along_bottom(history.problem().discretization(), *dents_in_place(history));
}

double relative(const double a, const double b)
{
  return std::abs(a - b) / std::abs(b);
}

TEST(DentsOnTheFoundation, OfABodyWhoseBottomIsMovedAreThoseOfItsWay)
{
  // The depth of the bottom's points is given: dents are the deepest that any point was at a place. t = 1 pressed, 2 lifted, 3 moved by
  // two cells and pressed, 4 lifted and moved back, 5 pressed less.
  const Course slide{{0, 0, 2 * cell, 0, 0}};
  const auto first = [](const double x) { return 0.01 * x; };
  const auto second = [](const double x) { return 0.03 - 0.002 * x; };
  const auto depth = [&](const double x, const double t) {
    return t == 1 ? first(x) : t == 3 ? second(x) : t == 5 ? 0.5 * first(x) : -0.01;
  };
  Model model = sliding(slide, DentsMoveWith::foundation);
  model.dirichlet[0].displacement[1] = field([&](const Point &x, const double t) { return -depth(x[0], t); });
  model.dirichlet.push_back({"top", "top", {std::nullopt, ScalarField(0.), std::nullopt}});
  LoadHistory history(problem(model), exact(), 0);

  constexpr int beyond = 2; // cells
  std::vector<double> expected(num_points + beyond, 0.);
  double dissipated = 0;
  for (int t = 1; t <= 5; ++t) {
    const StepSolution s = history.advance(t);
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    const int moved = t == 3 ? beyond : 0;
    std::vector<double> met(num_points, 0.);
    for (int i = 0; i < num_points; ++i) {
      const double pressed_in = depth(i * cell, t), weight = i == 0 || i == num_points - 1 ? cell / 2 : cell;
      const double before = expected[i + moved];
      met[i] = std::max(pressed_in, before);
      dissipated += weight * xi * (met[i] - before);
    }
    for (int i = 0; i < num_points; ++i) expected[i + moved] = met[i];
    const auto found = dents(history);
    const auto points = along_bottom(
        history.problem().discretization(),
        *contact::node_columns(s.step.contact, s.contact.dent, history.problem().discretization().mesh->owned_nodes));
    for (int i = 0; i < num_points; ++i) {
      EXPECT_NEAR(found[i], expected[i], 1e-14) << "t = " << t << ", point " << i;
      EXPECT_NEAR(points[i], met[i], 1e-14) << "t = " << t << ", point " << i;
    }
    EXPECT_NEAR(s.contact.total.dent_volume, dissipated / xi, 1e-13) << t;
    EXPECT_NEAR(history.last().contact.max_dent, *std::max_element(expected.begin(), expected.end()), 1e-14) << t;
    EXPECT_NEAR(history.last().energies.dissipated, dissipated, 1e-12) << t;
    EXPECT_EQ(history.last().parts, 1);
  }
}

TEST(DentsOnTheFoundation, AreAGapUnderTheBodyThatIsPressedBesideItsDent)
{
  const Course slide{{0, 0, 3 * cell}}, press{{0.2, -0.05, 0.2}};
  LoadHistory history(problem(pressed(slide, press, DentsMoveWith::foundation)), exact(), 0);
  for (const double t : {1, 2}) ASSERT_TRUE(history.advance(t).uzawa.converged);
  const auto before = dents(history);
  const StepSolution s = history.advance(3);
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;

  Model alone = pressed(slide, press, DentsMoveWith::body);
  alone.contact[0].gap = field([&](const Point &x, double) {
    const int place = static_cast<int>(std::lround(x[0] / cell)) + 3;
    return 0.02 * std::pow(x[0] - 2, 2) + (place < num_points ? before[place] : 0);
  });
  const auto same = problem(alone);
  const StepSolution expected = test::solved(*same, same->step(3), exact());
  ASSERT_TRUE(expected.uzawa.converged) << expected.uzawa.reason;
  EXPECT_GT(s.contact.total.yielded_length, 0);
  EXPECT_LT(relative(s.energy_norm_squared, expected.energy_norm_squared), 1e-8);
  EXPECT_LT(relative(s.contact.total.force[1], expected.contact.total.force[1]), 1e-8);
  Vector difference(*s.u, Teuchos::Copy);
  difference.update(-1., *expected.u, 1.);
  EXPECT_LT(difference.norm2(), 1e-8 * expected.u->norm2());

  // Dents of the first place stay where the body does not stand on them any more.
  const auto after = dents(history);
  EXPECT_GT(before[7], 0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(after[i], before[i]);
  double added = 0;
  for (int i = 0; i < num_points; ++i) {
    EXPECT_GE(after[i], before[i]);
    added += after[i] - before[i];
  }
  EXPECT_GT(added, 0);
}

TEST(DentsOnTheFoundation, AreFoundAgainThereAndBackUnderAnyElement)
{
  const Course slide{{0, 0, 3 * cell, -1.37 * cell, 0}}, press{{0.1, -0.05, -0.05, -0.05, 0.1}};
  for (const mesh::Element &element : mesh::all_elements()) {
    LoadHistory history(problem(pressed(slide, press, DentsMoveWith::foundation), element), exact(), 0);
    const StepSolution first = history.advance(1);
    ASSERT_TRUE(first.uzawa.converged) << element.name() << ": " << first.uzawa.reason;
    EXPECT_EQ(history.last().solves, 1);
    MultiVector added(*dents_in_place(history), Teuchos::Copy);
    const double deepest = added.getVector(0)->normInf(), dissipated = history.last().energies.dissipated;
    EXPECT_GT(dissipated, 0);
    StepSolution s;
    for (const double t : {2, 3, 4, 5}) {
      s = history.advance(t);
      ASSERT_TRUE(s.uzawa.converged) << element.name() << ": " << s.uzawa.reason;
      EXPECT_EQ(s.contact.total.max_pressure > 0, t == 5) << t;
      EXPECT_EQ(history.last().solves, 1) << "the prescribed motion tells where points will stand";
    }
    EXPECT_LT(relative(history.last().energies.dissipated, dissipated), 1e-8) << element.name();
    EXPECT_LT(relative(s.contact.total.force[1], first.contact.total.force[1]), 1e-8) << element.name();
    EXPECT_LT(relative(s.energy_norm_squared, first.energy_norm_squared), 1e-8) << element.name();
    added.update(1., *dents_in_place(history), -1.);
    EXPECT_LT(added.getVector(0)->normInf(), 1e-8 * deepest) << element.name();
  }
}

TEST(DentsOnTheFoundation, ThatTheBodyHasLeftBehindAreMetAgain)
{
  // Pressed, in three steps; lifted and moved by more than the side's length; pressed as before; lifted and moved back; pressed as before.
  const Course slide{{0, 20 * cell, 20 * cell, 0, 0}}, press{{0.1, -0.05, 0.1, -0.05, 0.1}};
  for (const mesh::Element &element : mesh::all_elements()) {
    LoadHistory history(problem(pressed(slide, press, DentsMoveWith::foundation), element), exact(), 0);
    double dissipated = 0, deepest = 0, volume = 0;
    for (const double t : {0.4, 0.7, 1., 2., 2.6, 3., 4., 4.5, 5.}) {
      const StepSolution s = history.advance(t);
      ASSERT_TRUE(s.uzawa.converged) << element.name() << ": " << s.uzawa.reason;
      if (t < 1 || (t > 2 && t < 3)) continue;
      const contact::ContactSums &sums = s.contact.total;
      EXPECT_GE(sums.max_dent, deepest) << "the deepest dent lies elsewhere now";
      deepest = sums.max_dent;
      if (t == 1) {
        dissipated = history.last().energies.dissipated;
        volume = sums.dent_volume;
        EXPECT_GT(dissipated, 0);
      }
      const int places = t < 3 ? 1 : 2;
      EXPECT_LT(relative(history.last().energies.dissipated, places * dissipated), 1e-10) << element.name() << " " << t;
      EXPECT_LT(relative(sums.dent_volume, places * volume), 1e-10) << element.name() << " " << t;
      EXPECT_LT(relative(sums.dent_volume * xi, history.last().energies.dissipated), 1e-12) << element.name();
    }
  }
}

TEST(DentsOnTheFoundation, AreMetWhereAStepLeadsPointsThatAreFree)
{
  const Course slide{{0, 1.4 * cell}}, press{{0.2, 0.15}};
  Model model = pressed(slide, press, DentsMoveWith::foundation);
  model.dirichlet.erase(model.dirichlet.begin()); // the bottom slides as the top and the foundation's dents lead it
  LoadHistory history(problem(model), exact(), 0);
  ASSERT_TRUE(history.advance(1).uzawa.converged);
  const analysis::Memory before = *history.memory();
  const StepSolution s = history.advance(2);
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_GT(s.contact.total.contact_length, 0);
  EXPECT_GT(history.last().solves, 1);
  EXPECT_LE(history.last().solves, 5);
  EXPECT_EQ(history.last().parts, 1);
  const fem::Discretization &d = history.problem().discretization();
  const contact::ContactNodes &points = s.step.contact;
  const auto met = along_bottom(d, *contact::node_columns(points, points.dent, d.mesh->owned_nodes));
  const auto where_they_lie =
      along_bottom(d, *contact::dents_met(d, model.contact, before.dent, before.foundations, *s.u));
  for (int i = 0; i < num_points; ++i) EXPECT_NEAR(met[i], where_they_lie[i], 1e-6 * before.foundations[0].deepest);
}

TEST(DentsOnTheFoundation, OfAnObstacleThatMovesAreThoseOfABodyThatSlidesTheOtherWay)
{
  const Course slide{{0, 0, 2.4 * cell}}, none{{0, 0, 0}}, press{{0.1, -0.05, 0.1}};
  const auto yield_stress = field([](const Point &x, double) { return 6 + x[0]; });
  Model body = pressed(slide, press, DentsMoveWith::foundation),
        foundation = pressed(none, press, DentsMoveWith::foundation);
  for (Model *const model : {&body, &foundation}) {
    contact::ContactOptions &side = model->contact[0];
    side.yield_stress = yield_stress;
    side.normal = contact::Normal::foundation;
    side.obstacle.surface = contact::Plane{{0, 1, 0}};
    side.gap = ScalarField(0.);
  }
  foundation.contact[0].obstacle.path[0] = in_time([slide](const double t) { return -slide(t); });
  LoadHistory a(problem(body), exact(), 0), b(problem(foundation), exact(), 0);
  for (const double t : {1, 2, 3}) {
    const StepSolution slid = a.advance(t), carried = b.advance(t);
    ASSERT_TRUE(slid.uzawa.converged && carried.uzawa.converged) << t;
    EXPECT_EQ(a.problem().stiffness()->assemblies() + b.problem().stiffness()->assemblies(), 2);
    EXPECT_NEAR(carried.energy_norm_squared, slid.energy_norm_squared, 1e-8) << t;
    const auto one = dents(a), other = dents(b);
    for (int i = 0; i < num_points; ++i) EXPECT_NEAR(other[i], one[i], 1e-9) << t;
  }
  EXPECT_GT(dents(a)[4], 0);
}

TEST(DentsOnTheFoundation, UnderABodyThatIsDraggedCostTheWorkThatMovesIt)
{
  // Drawn along under its load, the body leaves a track; work and energies differ by what the trapezoidal rule misses.
  const Course slide{{0, 3.3 * cell}}, press{{0.2, 0.2}};
  double imbalance[2];
  for (const int steps : {6, 24}) {
    LoadHistory history(problem(pressed(slide, press, DentsMoveWith::foundation)), exact(), 0);
    double pressed_only = 0;
    for (int k = 1; k <= 2 * steps; ++k) {
      ASSERT_TRUE(history.advance(double(k) / steps).uzawa.converged);
      if (k == steps) pressed_only = history.last().energies.dissipated;
    }
    const analysis::Energies &e = history.last().energies;
    EXPECT_GT(e.dissipated, 1.1 * pressed_only);
    imbalance[steps == 24] = std::abs(e.imbalance) / e.dissipated;
  }
  EXPECT_LT(imbalance[0], 0.05);
  EXPECT_LT(imbalance[1], 0.5 * imbalance[0]);
}

TEST(DentsOfTheBody, SlideAlongWithIt)
{
  const Course slide{{0, 2 * cell, 3 * cell}}, none{{0, 0, 0}}, press{{0.2, 0.18, 0.25}};
  LoadHistory moved(problem(pressed(slide, press, DentsMoveWith::body)), exact(), 0),
      still(problem(pressed(none, press, DentsMoveWith::body)), exact(), 0);
  for (const double t : {1, 2, 3}) {
    const StepSolution a = moved.advance(t), b = still.advance(t);
    ASSERT_TRUE(a.uzawa.converged && b.uzawa.converged);
    EXPECT_LT(relative(a.energy_norm_squared, b.energy_norm_squared), 1e-8) << t;
    EXPECT_GT(b.contact.total.force[1], 0);
    EXPECT_EQ(moved.last().solves, 1);
    const auto one = dents(moved), other = dents(still);
    for (int i = 0; i < num_points; ++i) EXPECT_NEAR(one[i], other[i], 1e-9) << t;
  }
  EXPECT_GT(dents(still)[8], 0);
}

} // namespace
} // namespace foundation_dents_test
