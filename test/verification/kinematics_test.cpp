// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/solve_step.hpp"
#include "rpc/core/error.hpp"
#include "rpc/fem/stress.hpp"
#include "rpc/mesh/box.hpp"
#include "run_scene.hpp"
#include "solved.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

// Plane stress and axisymmetric bodies against closed forms: Lame's tube and disc, bars and cylinders.

namespace kinematics_test
{
namespace
{

using namespace rpc;
using fem::Kinematics;

constexpr double pi = 3.14159265358979323846;
constexpr fem::Material steel{2000, 0.3};

using Map = std::function<Point(const Point &)>;

std::shared_ptr<const mesh::Mesh> mapped(const mesh::BoxOptions &box, const Map &map)
{
  auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
  const auto coords = Kokkos::create_mirror_view(mesh->coords);
  Kokkos::deep_copy(coords, mesh->coords);
  for (LO n = 0; n < mesh->num_local_nodes(); ++n) {
    const Point x = map({coords(n, 0), coords(n, 1), 0});
    for (int c = 0; c < 2; ++c) coords(n, c) = x[c];
  }
  Kokkos::deep_copy(mesh->coords, coords);
  mesh->box = nullptr;
  return mesh;
}

Point straight(const Point &x)
{
  return x;
}
/// (r, angle) -> (x, y).
Point polar(const Point &x)
{
  return {x[0] * std::cos(x[1]), x[0] * std::sin(x[1])};
}
/// The box (1, 2) x (0, 1) with its inside out of shape; angles differ by up to 40 degrees from right ones.
Point bulged(const Point &x)
{
  const double bubble = 16 * (x[0] - 1) * (2 - x[0]) * x[1] * (1 - x[1]);
  return {x[0] + 0.08 * bubble, x[1] - 0.1 * bubble * (x[0] - 0.5)};
}

fem::DirichletCondition hold(const std::string &side, const int component, const double value = 0)
{
  fem::DirichletCondition condition{side + std::to_string(component), side, {}};
  condition.displacement[component] = ScalarField(value);
  return condition;
}

ScalarField field(const std::function<double(const Point &)> &function)
{
  return ScalarField("exact", function);
}

struct Solved {
  std::shared_ptr<analysis::Problem> problem;
  analysis::StepSolution solution;

  const fem::Discretization &d() const { return problem->discretization(); }
};

Solved solved(const std::shared_ptr<const mesh::Mesh> &mesh, const analysis::Model &model)
{
  Solved s{std::make_shared<analysis::Problem>(mesh, model), {}};
  s.solution = test::solved(*s.problem, s.problem->step(1));
  EXPECT_TRUE(s.solution.uzawa.converged) << s.solution.uzawa.reason;
  return s;
}

const mesh::Element plane_elements[] = {{2, 1, mesh::Shape::simplex}, {2, 2, mesh::Shape::simplex}, {2, 1}, {2, 2}};

/// A ring with radii 1 and 2 under the pressure 1 inside: u_r = A r + B/r.
struct Ring {
  double A, B, rr, theta; // stresses are rr_at, theta_at = 1/3 -+ 4/3 / r^2

  /// Lame's solution, of the tube that cannot grow longer or of the thin disc.
  Ring(const fem::Material &material, const bool tube)
  {
    const double E = material.youngs_modulus, nu = material.poissons_ratio;
    A = (tube ? (1 + nu) * (1 - 2 * nu) : 1 - nu) / E / 3;
    B = (1 + nu) / E * 4 / 3;
    rr = 1. / 3;
    theta = 4. / 3;
  }
  double u(const double r) const { return A * r + B / r; }
  double hoop_stress(const double r) const { return rr + theta / (r * r); }
};

/// Relative errors of J (half the square of the energy norm's), and root mean squares over the nodes of those of displacements and
/// recovered stresses.
struct Errors {
  double energy = 0, displacement = 0, stress = 0;
  int nodes = 0;

  void add(const double of_displacement, const double of_stress)
  {
    displacement += of_displacement * of_displacement;
    stress += of_stress * of_stress;
    ++nodes;
  }
  void finish()
  {
    displacement = std::sqrt(displacement / nodes);
    stress = std::sqrt(stress / nodes);
  }
};

/// The tube, an axisymmetric body of height 1.
Errors tube_errors(const mesh::Element &element, const fem::Material &material, const int n, const Map &map)
{
  const Ring exact(material, true);
  analysis::Model model;
  model.kinematics = Kinematics::axisymmetric;
  model.materials = material;
  model.dirichlet = {hold("bottom", 1), hold("top", 1)};
  model.tractions = {{"left", "left", {ScalarField(1.), ScalarField(0.), ScalarField(0.)}}};
  const Solved s = solved(mapped({{1, 0}, {2, 1}, {n, n}, element}, map), model);
  const double J = -0.5 * exact.u(1) * 2 * pi;
  EXPECT_GT(s.solution.energy, J - 1e-12 * std::abs(J));
  const auto coords = to_host(s.d().mesh->coords);
  const auto u = s.solution.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto stress = fem::RecoveredStress(s.d(), material, *s.solution.u).at_nodes();
  const auto sigma = stress->getLocalViewHost(Tpetra::Access::ReadOnly);
  Errors errors;
  errors.energy = (s.solution.energy - J) / std::abs(J);
  for (LO node = 0; node < s.d().mesh->num_owned_nodes(); ++node) {
    const double r = coords(node, 0), hoop = exact.hoop_stress(r), radial = 2 * exact.rr - hoop;
    const double along = material.poissons_ratio * 2 * exact.rr, difference[2] = {hoop - along, radial - along};
    const double von_mises = std::hypot(difference[0] - difference[1] / 2, std::sqrt(0.75) * difference[1]);
    errors.add(std::hypot(u(2 * node, 0) - exact.u(r), u(2 * node + 1, 0)) / exact.u(1),
               std::hypot(sigma(node, 0) - radial, sigma(node, 1) - along, sigma(node, 3) - hoop));
    errors.add(0, sigma(node, 4) - von_mises);
  }
  errors.finish();
  return errors;
}

/// A quarter of the disc in plane stress.
Errors disc_errors(const mesh::Element &element, const fem::Material &material, const int n)
{
  const Ring exact(material, false);
  analysis::Model model;
  model.kinematics = Kinematics::plane_stress;
  model.materials = material;
  model.dirichlet = {hold("bottom", 1), hold("top", 0)};
  model.tractions = {{"left",
                      "left",
                      {field([](const Point &x) { return x[0] / std::hypot(x[0], x[1]); }),
                       field([](const Point &x) { return x[1] / std::hypot(x[0], x[1]); }), ScalarField(0.)}}};
  const Solved s = solved(mapped({{1, 0}, {2, pi / 2}, {n, 2 * n}, element}, polar), model);
  const double J = -0.5 * exact.u(1) * pi / 2;
  const auto coords = to_host(s.d().mesh->coords);
  const auto u = s.solution.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto stress = fem::RecoveredStress(s.d(), material, *s.solution.u).at_nodes();
  const auto sigma = stress->getLocalViewHost(Tpetra::Access::ReadOnly);
  Errors errors;
  errors.energy = std::abs(s.solution.energy - J) / std::abs(J);
  for (LO node = 0; node < s.d().mesh->num_owned_nodes(); ++node) {
    const double r = std::hypot(coords(node, 0), coords(node, 1)), c = coords(node, 0) / r, q = coords(node, 1) / r;
    const double hoop = exact.hoop_stress(r), radial = 2 * exact.rr - hoop;
    const double von_mises = std::sqrt(hoop * hoop + radial * radial - hoop * radial);
    const double xx = c * c * radial + q * q * hoop, yy = q * q * radial + c * c * hoop, xy = q * c * (radial - hoop);
    errors.add(std::hypot(u(2 * node, 0) - c * exact.u(r), u(2 * node + 1, 0) - q * exact.u(r)) / exact.u(1),
               std::hypot(sigma(node, 0) - xx, sigma(node, 1) - yy, sigma(node, 2) - xy));
    errors.add(0, sigma(node, 3) - von_mises);
  }
  errors.finish();
  return errors;
}

double order(const double coarse, const double fine)
{
  return std::log2(coarse / fine);
}

/// J converges with twice the order of the energy norm, displacements and recovered stresses with one more than that.
void expect_orders(const mesh::Element &element, const Errors &coarse, const Errors &fine)
{
  SCOPED_TRACE(element.name());
  const int p = element.order;
  EXPECT_GT(order(coarse.energy, fine.energy), 2 * p - 0.25) << fine.energy;
  EXPECT_GT(order(coarse.displacement, fine.displacement), p + 1 - 0.3) << fine.displacement;
  EXPECT_GT(order(coarse.stress, fine.stress), p + 1 - 0.3) << fine.stress;
  EXPECT_LT(fine.displacement, 0.01);
}

TEST(Tube, ConvergesToLamesSolution)
{
  for (const auto &element : plane_elements)
    for (const Map &map : {Map(straight), Map(bulged)})
      expect_orders(element, tube_errors(element, steel, 8, map), tube_errors(element, steel, 16, map));
}

TEST(Tube, DoesNotLockWhereTheDilatationIsProjected)
{
  for (const auto &element : plane_elements) {
    if (element.shape == mesh::Shape::simplex && element.order == 1) continue; // P1 locks
    SCOPED_TRACE(element.name());
    const Errors compressible = tube_errors(element, {2000, 0.3, fem::Dilatation::projected}, 8, bulged);
    const Errors rubber = tube_errors(element, {2000, 0.49999, fem::Dilatation::projected}, 8, bulged);
    EXPECT_LT(rubber.displacement, 3 * compressible.displacement);
    EXPECT_LT(rubber.stress, 0.05);
  }
}

TEST(Tube, MayBeWidenedByAPrescribedDisplacement)
{
  const Ring exact(steel, true);
  analysis::Model model;
  model.kinematics = Kinematics::axisymmetric;
  model.materials = steel;
  model.dirichlet = {hold("bottom", 1), hold("top", 1), hold("left", 0, exact.u(1))};
  const Solved s = solved(mapped({{1, 0}, {2, 1}, {16, 4}, {2, 2}}, straight), model);
  EXPECT_NEAR(s.solution.energy_norm_squared, 2 * pi * exact.u(1), 1e-6 * 2 * pi * exact.u(1));
  for (const auto &reaction : s.solution.reactions) EXPECT_EQ(reaction[0], 0); // around the axis they cancel
  // sigma_yy = nu (rr + theta) = 2 nu/3 over the area 3 pi
  EXPECT_NEAR(s.solution.reactions[1][1], 2 * pi * steel.poissons_ratio, 1e-5);
}

TEST(Disc, ConvergesToLamesSolutionInPlaneStress)
{
  for (const auto &element : plane_elements)
    expect_orders(element, disc_errors(element, steel, 8), disc_errors(element, steel, 16));
}

TEST(Disc, DoesNotLockInPlaneStressWithoutAProjection)
{
  const Errors compressible = disc_errors({2, 1}, steel, 8), rubber = disc_errors({2, 1}, {2000, 0.49999}, 8);
  EXPECT_LT(rubber.displacement, 2 * compressible.displacement);
}

TEST(Bar, InPlaneStressStretchesAndThinsFreely)
{
  for (const auto &element : plane_elements) {
    SCOPED_TRACE(element.name());
    analysis::Model model;
    model.kinematics = Kinematics::plane_stress;
    model.materials = steel;
    model.dirichlet = {hold("left", 0), hold("bottom", 1)};
    model.tractions = {{"right", "right", {ScalarField(10.), ScalarField(0.), ScalarField(0.)}}};
    const Solved s = solved(mapped({{1, 0}, {2, 1}, {4, 4}, element}, bulged), model);
    const auto coords = to_host(s.d().mesh->coords);
    const auto u = s.solution.u->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO n = 0; n < s.d().mesh->num_owned_nodes(); ++n) {
      EXPECT_NEAR(u(2 * n, 0), 10 / steel.youngs_modulus * (coords(n, 0) - 1), 1e-11);
      EXPECT_NEAR(u(2 * n + 1, 0), -10 * steel.poissons_ratio / steel.youngs_modulus * coords(n, 1), 1e-11);
    }
    EXPECT_NEAR(s.solution.energy_norm_squared, 100 / steel.youngs_modulus, 1e-11);
    EXPECT_NEAR(s.solution.reactions[0][0], -10, 1e-8);
  }
}

/// A cylinder with radius 1 and height 1 on a foundation, pressed from above.
analysis::Model cylinder(const double pressure, const double yield_stress)
{
  analysis::Model model;
  model.kinematics = Kinematics::axisymmetric;
  model.materials = steel;
  model.tractions = {{"top", "top", {ScalarField(0.), ScalarField(-pressure), ScalarField(0.)}}};
  contact::ContactOptions foundation;
  foundation.path = "Contact";
  foundation.side = "bottom";
  foundation.yield_stress = ScalarField(yield_stress);
  model.contact = {foundation};
  return model;
}
std::shared_ptr<const mesh::Mesh> from_the_axis(const mesh::Element &element)
{
  return mapped({{0, 0}, {1, 1}, {5, 4}, element}, straight);
}

TEST(Cylinder, PressedOnAFoundationHasUniformStressesAndIsHeldByIt)
{
  for (const auto &element : plane_elements) {
    SCOPED_TRACE(element.name());
    const Solved s = solved(from_the_axis(element), cylinder(10, 12));
    EXPECT_TRUE(s.solution.step.support.by_contact_only);
    const auto p = to_host(s.solution.contact.pressure);
    for (std::size_t i = 0; i < p.extent(0); ++i) EXPECT_NEAR(p(i), 10, 1e-7);
    const auto &sums = s.solution.contact.total;
    EXPECT_NEAR(sums.force[0], 0, 0);
    EXPECT_NEAR(sums.force[1], 10 * pi, 1e-7);
    EXPECT_NEAR(sums.contact_length, pi, 1e-12);
    EXPECT_NEAR(s.solution.energy, -0.5 * 100 / steel.youngs_modulus * pi, 1e-9);
    const auto coords = to_host(s.d().mesh->coords);
    const auto u = s.solution.u->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO n = 0; n < s.d().mesh->num_owned_nodes(); ++n) {
      EXPECT_NEAR(u(2 * n, 0), 10 * steel.poissons_ratio / steel.youngs_modulus * coords(n, 0), 1e-9);
      EXPECT_NEAR(u(2 * n + 1, 0), -10 / steel.youngs_modulus * coords(n, 1), 1e-9);
    }
  }
}

/// The message of the error with which a step is refused.
std::string refusal(const mesh::Element &element, const analysis::Model &model)
{
  const analysis::Problem problem(from_the_axis(element), model);
  try {
    problem.step(1);
  } catch (const Error &error) {
    EXPECT_EQ(error.code(), ExitCode::no_solution);
    return error.what();
  }
  return "none";
}

TEST(Cylinder, IsRefusedWhereTheFoundationCannotHoldItsLoad)
{
  for (const auto &element : plane_elements) {
    SCOPED_TRACE(element.name());
    const std::string heavy = refusal(element, cylinder(12.001, 12)), lifted = refusal(element, cylinder(-1, 12));
    EXPECT_NE(heavy.find("with a resultant of 37.7"), std::string::npos) << heavy;
    EXPECT_NE(heavy.find("[N] along (0, -1)"), std::string::npos) << heavy;
    EXPECT_NE(heavy.find("carries at most 37.69"), std::string::npos) << heavy;
    EXPECT_NE(lifted.find("pulls the body away"), std::string::npos) << lifted;
    EXPECT_EQ(refusal(element, cylinder(11.999, 12)), "none");
    analysis::Model nothing = cylinder(1, 12);
    nothing.contact = {};
    EXPECT_NE(refusal(element, nothing).find("against translation along (0, 1)"), std::string::npos);
    nothing.dirichlet = {hold("bottom", 1)};
    EXPECT_EQ(refusal(element, nothing), "none");
  }
}

// The ball of Hertz (1881), whole half ball: an independent axisymmetric program on graded quadratic triangles, last digits
// converged.
struct Reference {
  std::string yield_stress;
  double force, max_pressure, contact_radius, yielded_radius, energy_norm_squared, energy, max_penetration;
};
const Reference references[] = {{"inf", 9.22776, 204.741, 0.146347, 0, 0.144824, 0.072412, 0},
                                {"100", 7.65925, 100, 0.157166, 0.154045, 0.0829375, 0.0650233, 0.00702}};

const std::string ball_deck = std::string(RPC_TEST_DECKS) + "/../../../input/ball_axisymmetric.xml";

/// Of a cap with this area of the undeformed unit ball.
double radius_of_cap(const double area)
{
  const double height = area / (2 * pi);
  return std::sqrt(height * (2 - height));
}

TEST(Ball, AgreesWithIndependentCode)
{
  for (const Reference &reference : references) {
    SCOPED_TRACE("xi = " + reference.yield_stress);
    const Solution s = run_scene(ball_deck, {"Contact->Yield Stress=" + reference.yield_stress});
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    EXPECT_LE(s.discretization.owned_dofs->getGlobalNumElements(), 20000u);
    const auto &c = s.contact.total;
    EXPECT_NEAR(c.force[1] / reference.force, 1, 1e-4);
    EXPECT_NEAR(c.max_pressure / reference.max_pressure, 1, 1e-3);
    EXPECT_NEAR(radius_of_cap(c.contact_length) / reference.contact_radius, 1, 1e-3);
    EXPECT_NEAR(radius_of_cap(c.yielded_length), reference.yielded_radius, 1e-3 * reference.contact_radius);
    EXPECT_NEAR(s.energy_norm_squared / reference.energy_norm_squared, 1, 2e-4);
    EXPECT_NEAR(s.energy / reference.energy, 1, 1e-4);
    EXPECT_NEAR(c.max_penetration, reference.max_penetration, 1e-5);
    // The foundation balances what holds the top; around the axis radial forces cancel.
    EXPECT_NEAR(s.reactions[0][1], -c.force[1], 1e-8 * c.force[1]);
    EXPECT_EQ(s.reactions[0][0], 0);
    EXPECT_EQ(c.force[0], 0);
    EXPECT_LE(s.uzawa.iterations, 2);
    EXPECT_LE(s.linear.preconditioner_setups, 2);
  }
}

TEST(Ball, ObeysHertzFormulasBetweenForceRadiusAndPressure)
{
  for (const double d : {0.005, 0.02}) {
    const Solution s = run_scene(ball_deck, {"Dirichlet->top->Y=" + std::to_string(-d)});
    const double modulus = 2000 / (1 - 0.3 * 0.3), force = s.contact.total.force[1];
    const double a = std::cbrt(3 * force / (4 * modulus)), peak = 3 * force / (2 * pi * a * a);
    EXPECT_NEAR(radius_of_cap(s.contact.total.contact_length) / a, 1, 0.01) << d;
    EXPECT_NEAR(s.contact.total.max_pressure / peak, 1, 0.01) << d;
  }
}

TEST(Ball, ErrorEstimateFollowsTheErrorOfTheEnergy)
{
  double before = 0;
  for (const std::string factor : {"8", "4", "2"}) {
    const Solution s = run_scene(ball_deck, {"Adapt->Estimate Error=true", "Mesh->Size Factor=" + factor});
    ASSERT_TRUE(s.estimate);
    const double error = std::sqrt(2 * std::abs(s.energy - 0.072412)), estimate = std::sqrt(s.estimate->total());
    EXPECT_LT(estimate, before == 0 ? 1. : 0.6 * before) << factor;
    if (factor != "2") { // the reference has six digits
      EXPECT_GT(estimate, 0.5 * error) << factor;
      EXPECT_LT(estimate, 4 * error) << factor;
    }
    before = estimate;
  }
}

TEST(Ball, AdaptsItsMesh)
{
  const Solution s = run_scene(ball_deck, {"Mesh->Size Factor=20", "Adapt->Target Relative Error=0.01"});
  ASSERT_TRUE(s.adaptation);
  EXPECT_TRUE(s.adaptation->reached) << s.adaptation->reason;
  EXPECT_NEAR(s.contact.total.force[1] / references[0].force, 1, 5e-4);
  EXPECT_NEAR(s.energy / references[0].energy, 1, 1e-4);
}

} // namespace
} // namespace kinematics_test
