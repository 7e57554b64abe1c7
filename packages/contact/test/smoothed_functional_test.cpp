#include "rpc/contact/result.hpp"
#include "rpc/contact/smoothed_functional.hpp"
#include "rpc/core/error.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

namespace
{

using namespace rpc;
using contact::SmoothedFunctional;

ScalarField field(std::function<double(const Point &)> f)
{
  return ScalarField("test", std::move(f));
}

/// A block of 6 x 3 cells on a foundation, held at its top or at its sides, with a yield limit and a gap that vary.
struct Scene {
  fem::Discretization d;
  std::shared_ptr<SmoothedFunctional> functional;

  explicit Scene(const double penalty = 40, const bool hold_sides = false, const double top = 0)
  {
    mesh::BoxOptions box{{0, 0}, {2, 1}, {6, 3}, {2, 1}};
    d = fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
    std::vector<fem::DirichletCondition> held{{"top", "top", {ScalarField(0.), ScalarField(top)}}};
    if (hold_sides) held.push_back({"left", "left", {ScalarField(0.), {}}});
    const auto load = rcp(new Vector(d.owned_dofs));
    fem::add_body_force(d, {ScalarField(0.3), ScalarField(-2.), ScalarField(0.)}, "Body Force", *load);
    auto problem =
        fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, {10, 0.3}), load, fem::dirichlet_dofs(d, held));
    contact::ContactOptions options;
    options.side = "bottom";
    options.yield_stress = field([](const Point &x) { return 1 + x[0]; });
    options.gap = field([](const Point &x) { return 0.02 * (x[0] - 1); });
    options.penalty = penalty;
    auto nodes = contact::contact_nodes(d, options, problem.dirichlet);
    functional =
        std::make_shared<SmoothedFunctional>(d.mesh->owned_nodes->getComm(), std::move(problem), std::move(nodes));
  }

  /// A vector that depends on the node's place alone, so that every number of ranks gets the same one; 0 where
  /// prescribed.
  RCP<Vector> vector(const double scale, const double phase) const
  {
    const auto v = rcp(new Vector(d.owned_dofs));
    const auto to = v->getLocalViewHost(Tpetra::Access::OverwriteAll);
    const auto coords = to_host(d.mesh->coords);
    const auto fixed = to_host(functional->problem().dirichlet.fixed);
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
      for (int c = 0; c < 2; ++c)
        to(2 * n + c, 0) = fixed(2 * n + c) ? 0 : scale * std::sin(phase + 5 * coords(n, 0) + 3 * coords(n, 1) + 2 * c);
    return v;
  }
};

RCP<Vector> plus(const Vector &u, const double t, const Vector &d)
{
  const auto sum = rcp(new Vector(u, Teuchos::Copy));
  sum->update(t, d, 1.);
  return sum;
}

TEST(SmoothedFunctional, GradientIsTheDerivativeOfTheValue)
{
  const Scene scene;
  const auto u = scene.vector(0.05, 0.4), d = scene.vector(1, 2);
  const auto states = scene.functional->count_states(*u);
  ASSERT_GT(states.open, 0); // all three pieces take part
  ASSERT_GT(states.stuck, 0);
  ASSERT_GT(states.yielded, 0);
  Vector F(u->getMap());
  scene.functional->gradient(*u, F);
  const double exact = F.dot(*d), scale = F.norm2() * d->norm2();
  const double h = 1e-5; // keeps each node on its piece, where differences of a quadratic are exact
  const double difference =
      (scene.functional->value(*plus(*u, h, *d)) - scene.functional->value(*plus(*u, -h, *d))) / (2 * h);
  EXPECT_NEAR(difference, exact, 1e-9 * scale);
}

TEST(SmoothedFunctional, HessianIsTheDerivativeOfTheGradientOnEachPiece)
{
  const Scene scene;
  auto &functional = *scene.functional;
  const auto u = scene.vector(0.05, 0.4), d = scene.vector(1, 2);
  EXPECT_GT(functional.update_hessian(*u), 0);
  EXPECT_EQ(functional.update_hessian(*u), 0); // nothing changes twice
  Vector Hd(u->getMap()), up(u->getMap()), down(u->getMap());
  functional.hessian()->apply(*d, Hd);
  const double h = 1e-5;
  functional.gradient(*plus(*u, h, *d), up);
  functional.gradient(*plus(*u, -h, *d), down);
  up.update(-1., down, 1.);
  up.scale(1 / (2 * h));
  up.update(-1., Hd, 1.);
  EXPECT_LT(up.norm2(), 1e-9 * Hd.norm2());
}

TEST(SmoothedFunctional, AcrossKinksTheGradientIsContinuousAndDifferencesConvergeAtFirstOrder)
{
  // v crosses the kink of one node within the difference: the error of a one-sided Taylor step is O(h), not O(h^2).
  const Scene scene;
  auto &functional = *scene.functional;
  const auto u = scene.vector(0.05, 0.4), d = scene.vector(1, 2);
  Vector F(u->getMap()), G(u->getMap());
  functional.gradient(*u, F);
  double previous = 0;
  for (const double h : {0.02, 0.01, 0.005}) {
    functional.gradient(*plus(*u, h, *d), G);
    G.update(-1., F, 1.);
    const double jump = G.norm2();
    if (previous > 0) {
      EXPECT_LT(jump, 0.7 * previous); // goes to 0 with h
    }
    previous = jump;
  }
}

TEST(SmoothedFunctional, ValueDoesNotSeeWhichContactBlocksAreInTheMatrix)
{
  const Scene scene(1e8);
  auto &functional = *scene.functional;
  const auto u = scene.vector(1e-9, 0.4);
  const double before = functional.value(*u);
  ASSERT_GT(functional.update_hessian(*scene.vector(0, 0)), 0);
  EXPECT_NEAR(functional.value(*u), before, 1e-9 * std::abs(before));
  EXPECT_GT(functional.update_hessian(*scene.vector(1, 0.4)), 0);
}

TEST(SmoothedFunctional, LineModelGivesTheSlopeOfTheFunctional)
{
  const Scene scene;
  auto &functional = *scene.functional;
  const auto u = scene.vector(0.05, 0.4), d = scene.vector(0.1, 2);
  Vector F(u->getMap());
  functional.gradient(*u, F);
  const auto line = functional.along(*u, *d, F);
  for (const double t : {0., 0.3, 0.77, 1.9, -0.6}) {
    Vector G(u->getMap());
    functional.gradient(*plus(*u, t, *d), G);
    EXPECT_NEAR(line.at(t).slope, G.dot(*d), 1e-12 * G.norm2() * d->norm2()) << t;
    const double h = 1e-7;
    const double bend = (line.at(t + h).slope - line.at(t - h).slope) / (2 * h);
    EXPECT_NEAR(line.at(t).curvature, bend, 1e-5 * std::abs(bend)) << t;
  }
}

TEST(SmoothedFunctional, PieceGradientIsTheGradientOnThePieceOfTheHessian)
{
  const Scene scene;
  auto &functional = *scene.functional;
  const auto u = scene.vector(0.05, 0.4), far = scene.vector(0.08, 1.1);
  functional.update_hessian(*u);
  Vector F(u->getMap()), G(u->getMap()), step(u->getMap());
  functional.gradient(*u, F);
  functional.piece_gradient(*u, G);
  G.update(-1., F, 1.);
  EXPECT_LT(G.norm2(), 1e-13 * F.norm2()); // the piece at u is the Hessian's own
  functional.piece_gradient(*far, G);
  functional.gradient(*far, F);
  G.update(-1., F, 1.);
  EXPECT_GT(G.norm2(), 1e-3 * F.norm2()); // elsewhere it is another one
}

TEST(SmoothedFunctional, MultiplierUpdateIsTheSmoothedPressureAndStaysWithinLimits)
{
  const Scene scene;
  auto &functional = *scene.functional;
  const auto u = scene.vector(0.05, 0.4);
  const auto before = to_host(functional.multipliers());
  HostView<double *> old("old", before.extent(0));
  Kokkos::deep_copy(old, before);
  const double change = functional.update_multipliers(*u);
  EXPECT_GT(change, 0);
  EXPECT_LE(change, 1);
  const auto now = to_host(functional.multipliers());
  const auto &c = functional.contact();
  const auto yield = to_host(c.yield), gap = to_host(c.gap);
  const auto node = to_host(c.node);
  const auto x = u->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO i = 0; i < c.size(); ++i) {
    const double v = -x(2 * node(i) + 1, 0) - gap(i);
    EXPECT_NEAR(now(i), std::min(std::max(old(i) + 40 * v, 0.), yield(i)), 1e-14);
  }
}

TEST(SmoothedFunctional, EnergiesAndResidualsDoNotDependOnTheNumberOfRanks)
{
  const Scene scene;
  auto &functional = *scene.functional;
  const auto u = scene.vector(0.05, 0.4);
  functional.update_multipliers(*u);
  // Values of one rank, to be met by all.
  EXPECT_NEAR(functional.value(*u), 0.40449452585322238, 1e-13);
  EXPECT_NEAR(functional.energy(*u), 0.40259702781371176, 1e-13);
  EXPECT_NEAR(functional.equilibrium_residual(*u), 3.3726049261830227, 1e-12);
  const auto states = functional.count_states(*u);
  EXPECT_EQ(states.open + states.stuck + states.yielded, 7);
}

TEST(SmoothedFunctional, ContactLawResidualVanishesExactlyForPairsThatObeyTheLaw)
{
  const Scene scene;
  auto &functional = *scene.functional;
  const auto u = scene.vector(0.05, 0.4);
  for (int k = 0; k < 200; ++k)
    functional.update_multipliers(*u); // at a fixed u: lambda goes to 0 or xi, where v says so
  EXPECT_LT(functional.contact_law_residual(*u, 5), 1e-14);
  functional.update_multipliers(*scene.vector(0.05, 3.4));
  EXPECT_GT(functional.contact_law_residual(*u, 5), 1e-3);
}

TEST(ContactNodes, PrescribedNormalDisplacementTakesANodeOutOfTheSolution)
{
  mesh::BoxOptions box{{0, 0}, {2, 1}, {6, 3}, {2, 1}};
  const auto d = fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
  const auto held = fem::dirichlet_dofs(d, {{"left", "left", {ScalarField(0.), ScalarField(-0.1)}}});
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = ScalarField(3.);
  const auto nodes = contact::contact_nodes(d, options, held);
  EXPECT_EQ(nodes.num_total, 7);
  EXPECT_EQ(nodes.num_fixed, 1);
  options.yield_stress = ScalarField(std::numeric_limits<double>::infinity());
  try { // pressed by 0.1 into what cannot give way
    contact::contact_nodes(d, options, held);
    FAIL();
  } catch (const Error &error) {
    EXPECT_EQ(error.code(), ExitCode::no_solution);
    EXPECT_NE(std::string(error.what()).find("0.1"), std::string::npos);
  }
}

TEST(ContactNodes, RefuseAYieldLimitThatIsNotPositiveSayingWhere)
{
  const Scene scene;
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = ScalarField("x-1", [](const Point &x) { return x[0] - 1; });
  try {
    contact::contact_nodes(scene.d, options, scene.functional->problem().dirichlet);
    FAIL();
  } catch (const Error &error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("x-1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("(0, 0)"), std::string::npos) << error.what();
  }
}

} // namespace
