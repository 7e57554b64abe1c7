// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/kinematics.hpp"

#include "bodies.hpp"
#include "drawn_mesh.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/fem/hinges.hpp"
#include "rpc/fem/rigid_motion.hpp"
#include "rpc/fem/stress.hpp"
#include "rpc/fem/surface.hpp"

#include <algorithm>

namespace kinematics_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::Kinematics;

constexpr fem::Material steel{2000, 0.3};

std::vector<mesh::Element> plane_elements()
{
  std::vector<mesh::Element> plane;
  for (const auto &element : elements())
    if (element.dim == 2) plane.push_back(element);
  return plane;
}

fem::Discretization bulged(const mesh::Element &element, const Kinematics kinematics)
{
  const auto box = small_box(element);
  return body(box, world(), bulge(box), kinematics);
}

/// Stresses of all nodes by node id, a row per node.
std::vector<double> stresses(const fem::Discretization &d, const fem::Material &material, const Vector &u)
{
  const auto stress = fem::RecoveredStress(d, material, u).at_nodes();
  const auto values = stress->getLocalViewHost(Tpetra::Access::ReadOnly);
  return by_node_id(*d.mesh, static_cast<int>(values.extent(1)), [&](const LO n, const int k) { return values(n, k); });
}

std::vector<double> repeated(const std::vector<double> &row, const std::size_t size)
{
  std::vector<double> all;
  while (all.size() < size) all.insert(all.end(), row.begin(), row.end());
  return all;
}

/// Sum over the nodes where `there` of a force.
template <class Where>
Point resultant_where(const fem::Discretization &d, const Vector &force, const Where &there)
{
  Vector part(force, Teuchos::Copy);
  {
    const auto values = part.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
      for (int c = 0; c < d.dim(); ++c)
        if (!there(point_of(d, n))) values(d.dim() * n + c, 0) = 0;
  }
  return resultant(d, part);
}

TEST(KinematicsOption, ReadsWhatItWritesAndRefusesTheRest)
{
  for (const auto kinematics : {Kinematics::plane_strain, Kinematics::plane_stress, Kinematics::axisymmetric})
    EXPECT_EQ(fem::kinematics_option(fem::name_of(kinematics), 2), kinematics);
  EXPECT_EQ(fem::kinematics_option("plane strain", 3), Kinematics::plane_strain);
  expect_error(ExitCode::bad_input, {"\"Kinematics\"", "plane stress", "got \"plane\""},
               [] { fem::kinematics_option("plane", 2); });
  expect_error(ExitCode::bad_input, {"\"Kinematics\" = plane stress", "in space", "Remove it"},
               [] { fem::kinematics_option("plane stress", 3); });
}

/// E/(1 - nu^2) ((1 - nu) eps_ij + nu tr eps delta_ij) of the linear displacement, nothing across the plane.
std::array<double, 3> plane_stress(const fem::Material &material)
{
  const double nu = material.poissons_ratio, factor = material.youngs_modulus / (1 - nu * nu);
  const double xx = slope[0][0], yy = slope[1][1], xy = (slope[0][1] + slope[1][0]) / 2;
  return {factor * (xx + nu * yy), factor * (yy + nu * xx), factor * (1 - nu) * xy};
}

TEST(PlaneStress, OfALinearDisplacementIsHookesLawWithoutStressAcross)
{
  for (const double nu : {0.3, 0.4999}) { // nothing locks, and nothing is projected
    for (const auto &element : plane_elements()) {
      SCOPED_TRACE(text_of(element));
      const fem::Material material{2000, nu};
      const auto d = bulged(element, Kinematics::plane_stress);
      const auto u = interpolate(d, [](const Point &x) { return linear(x, 2); });
      const auto s = plane_stress(material);
      const double von_mises = std::sqrt(s[0] * s[0] + s[1] * s[1] - s[0] * s[1] + 3 * s[2] * s[2]);
      const auto found = stresses(d, material, *u);
      EXPECT_LT(difference(found, repeated({s[0], s[1], s[2], von_mises}, found.size())), 1e-11);
    }
  }
}

TEST(PlaneStress, ForcesOfALinearDisplacementAreTheStressOnTheBoundary)
{
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = bulged(element, Kinematics::plane_stress);
    const auto u = interpolate(d, [](const Point &x) { return linear(x, 2); });
    const auto s = plane_stress(steel);
    const auto work = fem::internal_work(d, steel, *u);
    const double height = box.upper[1] - box.lower[1], width = box.upper[0] - box.lower[0];
    const auto inside = [&](const double x, const int i) { return x > box.lower[i] + 1e-9 && x < box.upper[i] - 1e-9; };
    // Corners have a share of the sides that meet there, which turns round between right and left, top and bottom.
    Point right = resultant_where(d, *work.forces, [&](const Point &x) { return x[0] > box.upper[0] - 1e-9; });
    const Point top = resultant_where(d, *work.forces, [&](const Point &x) { return x[1] > box.upper[1] - 1e-9; });
    const Point middle =
        resultant_where(d, *work.forces, [&](const Point &x) { return inside(x[0], 0) && inside(x[1], 1); });
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(right[i], s[i == 0 ? 0 : 2] * height, 1e-11 * steel.youngs_modulus);
      EXPECT_NEAR(top[i], s[i == 0 ? 2 : 1] * width, 1e-11 * steel.youngs_modulus);
      EXPECT_NEAR(middle[i], 0, 1e-11 * steel.youngs_modulus);
    }
    const double density = s[0] * slope[0][0] + s[1] * slope[1][1] + s[2] * (slope[0][1] + slope[1][0]);
    EXPECT_NEAR(work.energy_norm_squared, density * width * height, 1e-11 * steel.youngs_modulus);
  }
}

/// Largest |K u - f(u)| over the largest force, of a displacement without any symmetry: the matrix against sums over cells.
double tangent_error(const fem::Discretization &d, const fem::Material &material)
{
  const auto u = interpolate(d, wild);
  Vector force(d.owned_dofs);
  fem::assemble_stiffness(d, material)->apply(*u, force);
  return difference(by_node_id(d, force), by_node_id(d, *fem::internal_work(d, material, *u).forces));
}

TEST(PlaneStress, TheMatrixIsTheTangentOfTheInternalForces)
{
  for (const auto &element : plane_elements())
    EXPECT_LT(tangent_error(bulged(element, Kinematics::plane_stress), steel), 1e-13) << text_of(element);
}

/// From the axis to r = 2.5, 1 m high, its inside out of shape.
mesh::BoxOptions at_the_axis(const mesh::Element &element)
{
  auto box = small_box(element);
  box.upper[0] -= box.lower[0];
  box.lower[0] = 0;
  return box;
}
fem::Discretization solid(const mesh::Element &element)
{
  const auto box = at_the_axis(element);
  return body(box, world(), bulge(box), Kinematics::axisymmetric);
}

constexpr double pi = 3.14159265358979323846;
constexpr fem::Material whole{2000, 0.3, fem::Dilatation::full}, projected{2000, 0.49, fem::Dilatation::projected};

TEST(Axisymmetry, TheMatrixIsTheTangentOfTheInternalForces)
{
  for (const auto &element : plane_elements())
    for (const auto &material : {whole, projected})
      EXPECT_LT(tangent_error(solid(element), material), 1e-13) << text_of(element);
}

TEST(Axisymmetry, ForcesAreTheSlopeOfTheEnergyByCentralDifferences)
{
  for (const auto &element : plane_elements()) {
    for (const auto &material : {whole, projected}) {
      SCOPED_TRACE(text_of(element));
      const auto d = solid(element);
      const auto u = interpolate(d, wild), w = interpolate(d, [](const Point &x) { return wild({x[1], x[0] + 1, 2}); });
      const auto energy_at = [&](const double t) {
        Vector at(*u, Teuchos::Copy);
        at.update(t, *w, 1);
        return fem::internal_work(d, material, at).energy_norm_squared / 2;
      };
      const double slope = fem::internal_work(d, material, *u).forces->dot(*w);
      EXPECT_NEAR((energy_at(1) - energy_at(-1)) / 2, slope, 1e-12 * energy_at(1)); // exact: the energy is quadratic
    }
  }
}

TEST(Axisymmetry, OnlyATranslationAlongTheAxisCostsNoEnergy)
{
  for (const auto &element : plane_elements()) {
    for (const auto &material : {whole, projected}) {
      SCOPED_TRACE(text_of(element));
      const auto d = solid(element);
      const auto energy = [&](const Deformation &u) {
        return fem::internal_work(d, material, *interpolate(d, u)).energy_norm_squared;
      };
      const auto up = fem::internal_work(d, material, *interpolate(d, [](const Point &) { return Point{0, 1}; }));
      EXPECT_EQ(up.energy_norm_squared, 0);
      EXPECT_EQ(up.forces->normInf(), 0);
      EXPECT_GT(energy([](const Point &) { return Point{1, 0}; }), steel.mu());
      EXPECT_GT(energy([](const Point &x) { return Point{-x[1], x[0]}; }), steel.mu());
    }
  }
}

/// u_r = 0.01 r, u_y = -0.03 y + 0.01 r: uniform stresses rr = theta, yy, ry.
Point uniform(const Point &x)
{
  return {0.01 * x[0], -0.03 * x[1] + 0.01 * x[0]};
}
std::array<double, 3> uniform_stress(const fem::Material &material)
{
  const double pressure = material.lambda() * (0.02 - 0.03);
  return {pressure + 0.02 * material.mu(), pressure - 0.06 * material.mu(), 0.01 * material.mu()};
}

TEST(Axisymmetry, UniformStressesAreMetExactlyByForcesEnergyAndRecovery)
{
  for (const auto &element : plane_elements()) {
    for (const auto &material : {whole, projected}) {
      SCOPED_TRACE(text_of(element));
      const auto box = at_the_axis(element);
      const auto d = solid(element);
      const auto u = interpolate(d, uniform);
      const auto s = uniform_stress(material);
      const auto found = stresses(d, material, *u);
      const double spread = s[1] - s[0], von_mises = std::sqrt(spread * spread + 3 * s[2] * s[2]);
      EXPECT_LT(difference(found, repeated({s[0], s[1], s[2], s[0], von_mises}, found.size())), 1e-10);

      // The tractions of this stress, and the body force mu eps_ry / r that holds its shear.
      const auto work = fem::internal_work(d, material, *u);
      Vector load(d.owned_dofs);
      const auto pull = [&](const std::string &side, const double x, const double y) {
        fem::add_traction(d, d.mesh->side(side, "test"), {ScalarField(x), ScalarField(y), ScalarField(0.)}, side, load);
      };
      pull("right", s[0], s[2]);
      pull("top", s[2], s[1]);
      pull("bottom", -s[2], -s[1]);
      fem::add_body_force(d, {ScalarField(0.), field([&](const Point &x) { return -s[2] / x[0]; }), ScalarField(0.)},
                          "Body Force", load);
      load.update(-1, *work.forces, 1);
      EXPECT_LT(load.normInf(), 1e-12 * material.youngs_modulus);

      const double volume = pi * box.upper[0] * box.upper[0] * (box.upper[1] - box.lower[1]);
      const double energy = volume * (0.02 * s[0] - 0.03 * s[1] + 0.01 * s[2]);
      EXPECT_NEAR(work.energy_norm_squared, energy, 1e-12 * energy);
      const auto squared = to_host(fem::RecoveredStress(d, material, *u).squared_difference());
      for (std::size_t cell = 0; cell < squared.extent(0); ++cell) EXPECT_LT(squared(cell), 1e-20 * energy);
    }
  }
}

TEST(Axisymmetry, SurfaceWeightsMeetAUniformPressureAndTheAxisHasOneAtOrderOneOnly)
{
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = at_the_axis(element);
    const auto d = solid(element);
    const double width = box.upper[0] / box.cells[0];
    for (const std::string name : {"bottom", "right"}) {
      const mesh::Side &side = d.mesh->side(name, "test");
      const auto surface = fem::surface_nodes(d, side);
      const auto node = to_host(surface.node);
      const auto weight = to_host(surface.weight);
      const auto normal = to_host(surface.normal);
      Vector by_weights(d.owned_dofs), consistent(d.owned_dofs);
      double sum = 0, on_axis = 0;
      int weightless = 0;
      {
        const auto force = by_weights.getLocalViewHost(Tpetra::Access::ReadWrite);
        for (std::size_t i = 0; i < node.extent(0); ++i) {
          EXPECT_GE(weight(i), 0);
          weightless += weight(i) == 0;
          sum += weight(i);
          if (point_of(d, node(i))[0] == 0) on_axis += weight(i);
          for (int c = 0; c < 2; ++c) force(2 * node(i) + c, 0) = -weight(i) * normal(i, c);
        }
      }
      const bool right = name == "right";
      fem::add_traction(d, side, {ScalarField(right ? -1. : 0.), ScalarField(right ? 0. : 1.), ScalarField(0.)}, name,
                        consistent);
      EXPECT_LT(difference(by_node_id(d, by_weights), by_node_id(d, consistent)), 1e-13);
      const double r = box.upper[0], area = right ? 2 * pi * r * (box.upper[1] - box.lower[1]) : pi * r * r;
      EXPECT_NEAR(sum_all(*world(), sum), area, 1e-13 * area);
      EXPECT_NEAR(sum_all(*world(), on_axis), right || element.order == 2 ? 0 : pi * width * width / 3, 1e-13 * area);
      EXPECT_EQ(sum_all(*world(), GO(weightless)), !right && element.order == 2 ? 1 : 0);
    }
    expect_error(ExitCode::bad_mesh, {"\"left\"", "on the axis, which is no surface"},
                 [&] { fem::surface_nodes(d, d.mesh->side("left", "test")); });
  }
}

TEST(Axisymmetry, NodesBeyondTheAxisAreRefused)
{
  auto box = at_the_axis({2, 1});
  box.lower[0] = -0.25;
  expect_error(ExitCode::bad_mesh, {"node at (-0.25, ", "beyond the axis", "axisymmetric", "x >= 0"},
               [&] { body(box, world(), {}, Kinematics::axisymmetric); });
  box.lower[0] = -1e-14; // rounding
  EXPECT_EQ(body(box, world(), {}, Kinematics::axisymmetric).dim(), 2);
}

fem::DirichletCondition hold(const std::string &side, const int component, const ScalarField &value)
{
  fem::DirichletCondition condition{side, side, {}};
  condition.displacement[component] = value;
  return condition;
}

TEST(Axisymmetry, HoldsItsAxisWithoutACondition)
{
  const auto d = solid({2, 2});
  const auto box = at_the_axis({2, 2});
  const GO nodes_on_axis = 2 * box.cells[1] + 1;
  EXPECT_EQ(fem::dirichlet_dofs(d, {}).num_fixed, nodes_on_axis);
  const ScalarField stretch = field([](const Point &x) { return 0.1 * x[0]; });
  const auto dirichlet = fem::dirichlet_dofs(d, {hold("top", 0, stretch)});
  EXPECT_EQ(dirichlet.num_fixed, nodes_on_axis + 2 * box.cells[0]);
  expect_error(ExitCode::bad_input, {"\"Dirichlet->top->X\" must be 0 on the axis", "got 0.1", "(0, 3)"},
               [&] { fem::dirichlet_dofs(d, {hold("top", 0, ScalarField(0.1))}); });
}

TEST(Axisymmetry, ABodyMovesFreelyAlongItsAxisOnly)
{
  const auto d = solid({2, 1});
  const auto parts = fem::connected_parts(d);
  const auto free = [&](const std::vector<fem::DirichletCondition> &conditions) {
    return fem::free_motions(d, parts, fem::dirichlet_dofs(d, conditions))[0];
  };
  for (const auto &conditions : {std::vector<fem::DirichletCondition>{}, {hold("right", 0, ScalarField(0.))}}) {
    const auto motions = free(conditions);
    ASSERT_EQ(motions.size(), 1u);
    EXPECT_EQ(fem::in_words(motions[0], parts.part[0], 2).text(), "translation along (0, 1)");
  }
  EXPECT_EQ(free({hold("top", 1, ScalarField(0.))}).size(), 0u);
}

TEST(Axisymmetry, PiecesJoinedInACircleAreStiff)
{
  const auto d = fem::discretize(distributed(drawn({"aa..", "..bb"})), Kinematics::axisymmetric);
  EXPECT_NO_THROW(fem::require_stiff_joints(d, fem::dirichlet_dofs(d, {hold("a left", 1, ScalarField(0.))})));
}

} // namespace
} // namespace kinematics_test
