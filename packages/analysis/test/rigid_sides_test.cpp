// SPDX-License-Identifier: BSD-3-Clause
#include "derivative_checks.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

namespace rigid_sides_test
{
namespace
{

using namespace rpc;

/// A block whose top is rigid, on a foundation with a gap that is not the same on both sides of its middle.
struct Pressed {
  analysis::Model model;
  std::shared_ptr<analysis::Problem> problem;

  explicit Pressed(const mesh::Element &element, const double yield = 30, const bool springs = true)
  {
    const bool space = element.dim == 3;
    mesh::BoxOptions box{{0, 0}, {2, 1}, {8, 4}, element};
    if (space) box = {{0, 0, 0}, {2, 1, 1}, {6, 3, 3}, element};
    fem::RigidMotions top;
    top.motions = space ? std::vector<int>{0, 1, 2, 3, 4, 5} : std::vector<int>{0, 1, 5};
    top.point = Point{0.7, 1.2, space ? 0.3 : 0};
    top.displacement[0] = ScalarField(2e-3);
    if (space) top.displacement[4] = ScalarField(1e-3);
    top.force[1] = ScalarField(space ? -10. : -20.);
    top.force[5] = ScalarField(1.5);
    if (springs) top.stiffness = {0, 70, space ? 150. : 0, space ? 40. : 0, 0, 90};
    model.materials = fem::Material{1000, 0.3};
    fem::DirichletCondition condition{"top", "top", {}};
    condition.rigid = top;
    model.dirichlet = {condition};
    if (space && !springs) model.dirichlet[0].rigid->displacement[2] = ScalarField(0.);
    model.contact = {round_gap(yield)};
    problem = std::make_shared<analysis::Problem>(
        std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())), model);
  }
  const fem::Discretization &d() const { return problem->discretization(); }
  fem::RigidMotions &top() { return *model.dirichlet[0].rigid; }
};

std::vector<Pressed> bodies(const double yield = 30, const bool springs = true)
{
  return {Pressed({2, 1}, yield, springs), Pressed({2, 2, mesh::Shape::simplex}, yield, springs),
          Pressed({3, 1}, yield, springs), Pressed({3, 1, mesh::Shape::simplex}, yield, springs)};
}

/// J(u) by the cells' energies, the loads and the springs, without the matrix.
double energy_of(const Pressed &pressed, const analysis::Step &step, const Vector &u)
{
  const auto work = fem::internal_work(pressed.d(), pressed.model.materials, u);
  return 0.5 * work.energy_norm_squared - step.elastic.applied_load->dot(u) +
         fem::spring_energy(step.elastic.dirichlet.rigid, u);
}

TEST(RigidSides, TheFunctionalIsTheEnergyOfBodyLoadsAndSpringsAndMovesTheSideAsOnePiece)
{
  for (Pressed pressed : bodies()) {
    pressed.model.contact.clear();
    pressed.model.dirichlet.push_back({"bottom", "bottom", {ScalarField(0.), ScalarField(0.), ScalarField(0.)}});
    const analysis::Problem problem(pressed.d().mesh, pressed.model);
    const auto step = problem.step(1);
    analysis::SolverState state(problem);
    contact::Iterate iterate(step.elastic, step.contact, state.hessian());
    Vector u = irregular_displacement(*pressed.problem, step, 1, 1e-3);
    u.update(1., *step.elastic.dirichlet.value, 1.);
    const double energy = energy_of(pressed, step, u);
    EXPECT_NEAR(iterate.value(u) / energy, 1, 1e-12);
    const fem::RigidSide &side = step.elastic.dirichlet.rigid[0];
    const auto q = fem::motions_of(side, u);
    EXPECT_NEAR(q[0], 2e-3, 1e-15);
    if (problem.discretization().dim() == 3) {
      EXPECT_NEAR(q[4], 1e-3, 1e-15);
    }
    // A force and a moment do the work that they should.
    Vector force(u.getMap());
    fem::add_resultants(side, {0, 3, 0, 0, 0, 5}, force);
    EXPECT_NEAR(force.dot(u), 3 * q[1] + 5 * q[5], 1e-14);
    // The nodes are where their motion has them.
    const auto node = to_host(side.node);
    const auto arm = to_host(side.arm);
    const auto x = u.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t i = 0; i < node.extent(0); ++i)
      for (int c = 0; c < side.num_components; ++c) {
        double moved = 0;
        for (int k = 0; k < 6; ++k) moved += q[k] * fem::along_motion(k, &arm(3 * i), c);
        EXPECT_NEAR(x(dof(side.num_components, node(i), c), 0), moved, 1e-15);
      }
  }
}

TEST(RigidSides, TheGradientIsTheDerivativeAndTheSolverInvertsTheTangent)
{
  for (const Pressed &pressed : bodies(1e8)) { // points that are pressed in are closed
    const auto step = pressed.problem->step(1);
    Vector u = irregular_displacement(*pressed.problem, step, 2, 1e-3);
    u.update(1., *step.elastic.dirichlet.value, 1.);
    Vector press(u.getMap());
    fem::add_resultants(step.elastic.dirichlet.rigid[0], {0, -0.01, 0, 0, 0, 0.003}, press);
    fem::clear_prescribed(step.elastic.dirichlet, press);
    u.update(1., press, 1.);
    expect_derivatives(*pressed.problem, step, u, 5e-6);
  }
}

TEST(RigidSides, ForcesAndMomentsLeadToTheMotionThatTheyCameFrom)
{
  for (Pressed pressed : bodies(30, false)) {
    const bool space = pressed.d().dim() == 3;
    fem::RigidMotions &top = pressed.top();
    const fem::SixNumbers motion{2e-3, -0.015, 0, space ? 1e-3 : 0, space ? 1e-3 : 0, 2e-3};
    for (const int k : top.motions) {
      top.displacement[k] = ScalarField(motion[k]);
      top.force[k].reset();
    }
    analysis::StepOptions options;
    options.uzawa.tolerance = 1e-12;
    const auto solved = [&] {
      const analysis::Problem problem(pressed.d().mesh, pressed.model);
      analysis::SolverState state(problem);
      return analysis::solve_step(problem, problem.step(1), state, options);
    };
    const auto given = solved();
    ASSERT_TRUE(given.uzawa.converged) << given.uzawa.reason;
    for (const int k : {1, 3, 5}) {
      top.displacement[k].reset();
      top.force[k] = ScalarField(given.rigid_forces[0][k]);
    }
    if (!space) top.force[3].reset();
    const auto found = solved();
    ASSERT_TRUE(found.uzawa.converged) << found.uzawa.reason;
    for (const int k : top.motions) {
      EXPECT_NEAR(found.rigid_motions[0][k], motion[k], 1e-10 * 0.015) << k;
      EXPECT_NEAR(found.rigid_forces[0][k], given.rigid_forces[0][k], 1e-10 * std::abs(given.rigid_forces[0][1])) << k;
    }
    // J differs by what the forces do alone.
    double work = 0;
    for (const int k : {1, 3, 5}) work += given.rigid_forces[0][k] * motion[k];
    EXPECT_NEAR(found.energy + work, given.energy, 1e-10 * std::abs(work));
  }
}

} // namespace
} // namespace rigid_sides_test
