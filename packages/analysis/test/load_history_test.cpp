#include "rpc/analysis/load_history.hpp"

#include "expect_error.hpp"
#include "rpc/contact/node_columns.hpp"
#include "rpc/mesh/box.hpp"
#include "solved.hpp"

#include <Teuchos_Array.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace
{

using namespace rpc;
using analysis::LoadHistory;
using analysis::Problem;
using analysis::StepSolution;
using rpc::test::expect_error;

constexpr double inf = std::numeric_limits<double>::infinity();

ScalarField in_time(std::function<double(const Point &, double)> f)
{
  return ScalarField("test", std::move(f));
}

/// A foundation's law; the first four are the families, the last one never yields.
struct Law {
  const char *name;
  double yield, hardening, stiffness;
  double compliance() const { return 1 / stiffness; }
};
const Law laws[] = {{"perfectly plastic", 3, 0, inf},
                    {"hardening", 3, 40, inf},
                    {"elastic, perfectly plastic", 3, 0, 200},
                    {"elastic, hardening", 3, 40, 200},
                    {"Winkler", inf, 0, 200}};

contact::ContactOptions foundation(const std::string &side, const Law &law)
{
  contact::ContactOptions options;
  options.side = side;
  options.path = "Contact->Sides->" + side;
  options.yield_stress = ScalarField(law.yield);
  options.hardening = ScalarField(law.hardening);
  options.stiffness = ScalarField(law.stiffness);
  return options;
}

std::shared_ptr<const mesh::Mesh> block(const int refinement = 1)
{
  const mesh::BoxOptions box{{0, 0}, {2, 1}, {12 * refinement, 6 * refinement}, {2, 1}};
  return std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
}

/// Close solves, for numbers to be compared to 1e-9.
analysis::StepOptions close()
{
  analysis::StepOptions options;
  options.uzawa.tolerance = 1e-11;
  options.newton.residual_tolerance = 1e-12;
  return options;
}
LoadHistory history_of(const analysis::Model &model, const analysis::StepOptions &options = close(),
                       const int halvings = 0, const double first_time = 1, const int refinement = 1)
{
  return {std::make_shared<Problem>(block(refinement), model, first_time), options, halvings};
}

StepSolution advance(LoadHistory &history, const double t)
{
  StepSolution s = history.advance(t);
  EXPECT_TRUE(s.uzawa.converged) << "t = " << t << ": " << s.uzawa.reason;
  return s;
}

fem::DirichletCondition prescribed(const std::string &side, const std::optional<ScalarField> &x,
                                   const std::optional<ScalarField> &y)
{
  return {side, side, {x, y, std::nullopt}};
}

/// |a - b|_2 / |b|_2
double distance(const MultiVector &a, const MultiVector &b)
{
  double square = 0, size = 0;
  for (std::size_t k = 0; k < a.getNumVectors(); ++k) {
    Vector difference(*a.getVector(k), Teuchos::Copy);
    difference.update(-1., *b.getVector(k), 1.);
    square += std::pow(difference.norm2(), 2);
    size += std::pow(b.getVector(k)->norm2(), 2);
  }
  return std::sqrt(square / size);
}

// A block that is pressed uniformly ---------------------------------------------------------------------------------------

constexpr double young = 100, poisson = 0.3;
/// Stress over strain where the sides slide [Pa].
constexpr double modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));

/// Sides that slide; the top goes down by `pressed`, and a flat foundation is below.
analysis::Model column(const Law &law, std::function<double(double)> pressed)
{
  analysis::Model model;
  model.materials = fem::Material{young, poisson};
  model.dirichlet = {
      prescribed("left", ScalarField(0.), std::nullopt), prescribed("right", ScalarField(0.), std::nullopt),
      prescribed("top", std::nullopt, in_time([pressed](const Point &, const double t) { return -pressed(t); }))};
  model.contact = {foundation("bottom", law)};
  return model;
}

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

/// Pressed and pushed aside by loads that follow `load`, held at the left, on a foundation that is uneven.
analysis::Model uneven(const Law &law, std::function<double(double)> load)
{
  analysis::Model model;
  model.materials = fem::Material{young, poisson};
  model.tractions.push_back({"top",
                             "top",
                             {in_time([load](const Point &, const double t) { return 0.2 * load(t); }),
                              in_time([load](const Point &x, const double t) { return -load(t) * (1 + x[0]); })}});
  model.dirichlet = {prescribed("left", ScalarField(0.), std::nullopt)};
  model.dirichlet.push_back(prescribed(
      "right", std::nullopt, in_time([load](const Point &x, const double t) { return -0.004 * load(t) * x[1]; })));
  auto below = foundation("bottom", law);
  below.gap = in_time([](const Point &x, double) { return 0.004 * x[0]; });
  model.contact = {below};
  return model;
}
double ramp(const double t)
{
  return 2.2 * t;
}
/// Up by t = 1, back by 2, up again by 3, on by 4.
double to_and_fro(const double t)
{
  return 2.2 * (t <= 1 ? t : t <= 2 ? 1 - 0.8 * (t - 1) : t <= 3 ? 0.2 + 0.8 * (t - 2) : 1 + 0.3 * (t - 3));
}

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

// A foundation that moves -------------------------------------------------------------------------------------------------

TEST(LoadHistory, AFoundationThatMovesIsABodyThatMovesTheOtherWay)
{
  const auto depth = [](const double t) { return t < 1.5 ? 0.05 : t < 2.5 ? 0.02 : 0.07; };
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    const auto tilted = [](const Point &x, const double d) { return -d * (1 + 0.5 * x[0]); };
    auto moving = column(law, depth), standing = moving;
    moving.dirichlet[2].displacement[1] =
        in_time([tilted](const Point &x, const double) { return tilted(x, 0.01) + 0.01; });
    standing.dirichlet[2].displacement[1] =
        in_time([tilted, depth](const Point &x, const double t) { return tilted(x, 0.01) + 0.01 - depth(t); });
    auto &plane = moving.contact[0].obstacle;
    plane.surface = contact::Plane{{0, 1, 0}};
    plane.path[0] = ScalarField(0.);
    plane.path[1] = in_time([depth](const Point &, const double t) { return depth(t); });
    standing.contact[0].obstacle = plane;
    standing.contact[0].obstacle.path[1] = ScalarField(0.);
    auto a = history_of(moving), b = history_of(standing);
    for (const double t : {1., 2., 3.}) {
      const StepSolution of_moving = advance(a, t), of_standing = advance(b, t);
      EXPECT_NEAR(of_moving.contact.total.force[1], of_standing.contact.total.force[1], 1e-8) << t;
      EXPECT_NEAR(of_moving.contact.total.max_dent, of_standing.contact.total.max_dent, 1e-10) << t;
      EXPECT_NEAR(of_moving.contact.total.max_penetration, of_standing.contact.total.max_penetration, 1e-10) << t;
      const analysis::Energies &x = a.last().energies, &y = b.last().energies;
      EXPECT_NEAR(x.strain, y.strain, 1e-9) << t;
      EXPECT_NEAR(x.dissipated, y.dissipated, 1e-9) << t;
      if (t > 1) {
        EXPECT_NEAR(x.work, y.work, 1e-9) << t;
      }
    }
  }
}

/// A ball below the block that moves along it: contact acts at other nodes and in other directions at each time.
analysis::Model over_a_ball(const contact::Normal normal, const double radius)
{
  auto model = column(laws[1], [](double) { return 0.02; });
  auto &ball = model.contact[0].obstacle;
  ball.surface = contact::Sphere{radius};
  ball.path[0] = in_time([](const Point &, const double t) { return 0.7 + 0.06 * t; });
  ball.path[1] = ScalarField(-radius);
  ball.point = {0.76, -radius, 0};
  model.contact[0].normal = normal;
  return model;
}

TEST(LoadHistory, AFoundationThatTurnsItsNormalsIsFollowed)
{
  auto history = history_of(over_a_ball(contact::Normal::foundation, 3));
  for (const double t : {1., 2.}) {
    const StepSolution s = advance(history, t);
    const auto normal = to_host(s.step.contact.normal);
    const auto node = to_host(s.step.contact.node);
    const auto coords = to_host(history.problem().discretization().mesh->coords);
    for (std::size_t i = 0; i < node.extent(0); ++i) {
      const double dx = coords(node(i), 0) - (0.7 + 0.06 * t), length = std::hypot(dx, 3.);
      EXPECT_NEAR(normal(i, 0), -dx / length, 1e-14);
    }
  }
}

/// Ten steps with one stiffness and one multigrid, or with new ones for each of them. With the body's normals only the nodes above
/// the ball are points.
TEST(LoadHistory, AFoundationThatTurnsItsNormalsNeedsNoOtherMatrixAndNoOtherMultigrid)
{
  for (const auto normal : {contact::Normal::foundation, contact::Normal::surface}) {
    for (const bool box : {true, false}) {
      solver::LinearSolverOptions linear;
      linear.multigrid = box ? "mesh" : "algebraic";
      const auto model = over_a_ball(normal, 0.5);
      const auto history = [&] {
        return LoadHistory(std::make_shared<Problem>(block(4), model, 1), close(), 0, linear);
      };
      LoadHistory one = history(), anew = history();
      int setups = 0;
      LO most = 0;
      for (int step = 1; step <= 10; ++step) {
        if (step > 1) anew.start_anew();
        const StepSolution s = advance(one, step);
        advance(anew, step);
        setups += one.last().preconditioner_setups;
        const LO points = sum_all(one.problem().discretization().mesh->comm(), s.step.contact.size());
        most = std::max(most, points);
        const analysis::Energies &x = one.last().energies, &y = anew.last().energies;
        EXPECT_GT(y.strain, 0);
        EXPECT_GT(y.dissipated, 0);
        EXPECT_NEAR(x.strain, y.strain, 1e-9 * y.strain) << step;
        EXPECT_NEAR(x.work, y.work, 1e-9 * std::abs(y.work)) << step;
        EXPECT_NEAR(x.dissipated, y.dissipated, 1e-9 * y.dissipated) << step;
      }
      EXPECT_EQ(one.problem().stiffness()->assemblies(), box ? 0 : 1);
      EXPECT_EQ(anew.problem().stiffness()->assemblies(), box ? 0 : 10);
      if (box) EXPECT_EQ(setups, 1);
      EXPECT_LE(setups, 2) << "corrections around the contact nodes may wear out once";
      if (normal == contact::Normal::surface) EXPECT_LT(most, 49) << "points among the 49 nodes of the side";
    }
  }
}

// What steps cost, and what becomes of those that fail --------------------------------------------------------------------

TEST(LoadHistory, OneSetUpServesAllStepsAndABoxNeedsNoMatrix)
{
  solver::LinearSolverOptions linear;
  linear.multigrid = "mesh"; // follows contact states in place
  LoadHistory history(std::make_shared<Problem>(block(4), uneven(laws[1], to_and_fro), 0.5), {}, 0, linear);
  advance(history, 0.5);
  EXPECT_GT(history.last().linear_iterations, 0);
  EXPECT_EQ(history.last().preconditioner_setups, 1);
  for (const double t : {1., 1.5, 2., 3., 4.}) {
    advance(history, t);
    EXPECT_EQ(history.last().preconditioner_setups, 0) << t;
    EXPECT_GT(history.last().linear_solves, 0) << t;
    EXPECT_EQ(history.last().parts, 1) << t;
  }
  EXPECT_EQ(history.problem().stiffness()->assemblies(), 0);
}

/// Options that give up early.
analysis::StepOptions impatient(const int newton)
{
  analysis::StepOptions options;
  options.prediction.enabled = false;
  options.newton.max_iterations = newton;
  options.uzawa.max_iterations = 1;
  return options;
}

/// Up to t = 1 in one stroke, where many points change their states.
analysis::Model stroke()
{
  auto model = uneven(laws[0], ramp);
  model.contact[0].gap = in_time([](const Point &x, double) { return 0.03 * x[0] * (2 - x[0]); });
  return model;
}

/// The least number of iterations with which the stroke is solved at once.
int iterations_needed()
{
  for (int newton = 1; newton < 30; ++newton) {
    auto history = history_of(stroke(), impatient(newton), 0, 1, 2);
    if (history.advance(1).uzawa.converged) return newton;
  }
  return 30;
}

TEST(LoadHistory, AStepThatDoesNotConvergeIsHalvedAsOftenAsAllowed)
{
  const int needed = iterations_needed();
  ASSERT_GT(needed, 2);
  ASSERT_LT(needed, 30);
  auto patient = history_of(stroke(), impatient(needed), 6, 1, 2);
  advance(patient, 1);
  EXPECT_EQ(patient.last().parts, 1);

  auto halved = history_of(stroke(), impatient(needed - 1), 8, 1, 2);
  std::vector<double> parts;
  const StepSolution s =
      halved.advance(1, {}, [&](const Problem &, const analysis::Step &step) { parts.push_back(step.time); });
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_EQ(halved.last().parts, static_cast<int>(parts.size()));
  ASSERT_GE(parts.size(), 3u);
  EXPECT_EQ(parts[0], 1);
  EXPECT_EQ(parts[1], 0.5);
  EXPECT_EQ(parts.back(), 1);
  EXPECT_EQ(halved.memory()->time, 1);
  EXPECT_EQ(halved.last().time, 1);
  EXPECT_TRUE(halved.last().converged);
  EXPECT_GT(halved.last().linear_solves, needed - 1); // those of all parts
  EXPECT_NEAR(halved.last().contact.force[1], patient.last().contact.force[1], 1e-6 * patient.last().contact.force[1]);
}

TEST(LoadHistory, AStepThatFailsIsNotRemembered)
{
  const int needed = iterations_needed();
  ASSERT_GT(needed, 2);
  auto history = history_of(stroke(), impatient(needed - 1), 0, 1, 2);
  EXPECT_FALSE(history.advance(1).uzawa.converged);
  EXPECT_EQ(history.memory(), nullptr);
  EXPECT_FALSE(history.last().converged);
  EXPECT_EQ(history.last().parts, 1);
  EXPECT_EQ(history.last().energies.work, 0);

  // From a state in between it fails again at a stroke that is twice as long, and that state stays.
  auto further = history_of(stroke(), impatient(needed - 1), 0, 1, 2);
  double begun = 0;
  for (double t = 0.5; t > 1e-3 && begun == 0; t /= 2)
    if (further.advance(t).uzawa.converged) begun = t;
  ASSERT_GT(begun, 0);
  const auto dent = further.memory()->dent;
  const auto energies = further.memory()->energies;
  double failed = 2 * begun;
  while (failed < 1e3 && further.advance(failed).uzawa.converged) failed *= 4;
  if (failed < 1e3) {
    EXPECT_LT(further.memory()->time, failed);
    EXPECT_FALSE(further.last().converged);
    if (further.memory()->time == begun) {
      EXPECT_EQ(further.memory()->dent, dent);
      EXPECT_EQ(further.memory()->energies.work, energies.work);
      EXPECT_EQ(further.last().energies.work, energies.work);
    }
  }
}

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
  EXPECT_NEAR(a.imbalance(), b.imbalance(), 1e-10 * b.work);
}

// Energies --------------------------------------------------------------------------------------------------------------

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
        const double now = history.last().energies.imbalance();
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
    double sum = 0, before = history.last().energies.imbalance();
    for (int k = 1; k <= steps; ++k) {
      advance(history, 1 + 1. * k / steps);
      const double now = history.last().energies.imbalance();
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
    EXPECT_NEAR(e.imbalance(), 0, 1e-10 * e.work) << t;
  }
}

// Other meshes, options -------------------------------------------------------------------------------------------------

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
