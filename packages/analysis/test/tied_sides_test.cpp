// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/problem.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "rpc/analysis/solver_state.hpp"
#include "rpc/contact/iterate.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

namespace tied_sides_test
{
namespace
{

using namespace rpc;

/// A block whose top is pressed by a force, on a foundation with a round gap.
struct Pressed {
  analysis::Model model;
  std::shared_ptr<analysis::Problem> problem;

  Pressed(const mesh::Element &element, const double force, const double yield = 30,
          const fem::Kinematics kinematics = fem::Kinematics::plane_strain)
  {
    mesh::BoxOptions box{{0, 0}, {2, 1}, {8, 4}, element};
    if (element.dim == 3) box = {{0, 0, 0}, {2, 1, 1}, {6, 3, 3}, element};
    fem::DirichletCondition top{"top", "top", {ScalarField(0.)}};
    if (element.dim == 3) top.displacement[2] = ScalarField(0.);
    top.force[1] = ScalarField(force);
    model.kinematics = kinematics;
    model.materials = fem::Material{1000, 0.3};
    model.dirichlet = {top};
    contact::ContactOptions foundation;
    foundation.side = "bottom";
    foundation.gap = ScalarField("gap", [](const Point &x) { return 0.01 * std::pow(x[0] - 0.9, 2); });
    foundation.yield_stress = ScalarField(yield);
    model.contact = {foundation};
    problem = std::make_shared<analysis::Problem>(
        std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())), model);
  }
  const fem::Discretization &d() const { return problem->discretization(); }

  /// An admissible displacement without order, of a size. It does not depend on the ranks.
  Vector displacement(const analysis::Step &step, const double phase, const double size) const
  {
    Vector v(d().owned_dofs);
    const auto id = d().mesh->node_id;
    for (LO i = 0; i < num_local(*d().owned_dofs); ++i) {
      const double number = static_cast<double>(dof(d().dim(), id(node_of(d().dim(), i)), component_of(d().dim(), i)));
      v.replaceLocalValue(i, size * std::sin(phase + 12.9898 * number * (1 + 1e-3 * number)));
    }
    fem::clear_prescribed(step.elastic.dirichlet, v);
    return v;
  }
};

std::vector<Pressed> bodies(const double yield = 30)
{
  return {Pressed({2, 1}, -20, yield), Pressed({2, 2}, -20, yield),
          Pressed({2, 1}, -20, yield, fem::Kinematics::axisymmetric), Pressed({3, 1}, -10, yield)};
}

TEST(TiedSides, TheStiffnessIsThatOfTheWholeBodyWhoseSideMovesAsOne)
{
  for (const Pressed &pressed : bodies()) {
    const auto step = pressed.problem->step(1);
    const Vector u = pressed.displacement(step, 1, 1);
    Vector Au(u.getMap());
    step.elastic.stiffness_of_tied->apply(u, Au);
    const auto work = fem::internal_work(pressed.d(), pressed.model.materials, u);
    EXPECT_NEAR(Au.dot(u) / work.energy_norm_squared, 1, 1e-12);
    Vector forces(*work.forces, Teuchos::Copy);
    fem::clear_prescribed(step.elastic.dirichlet, forces);
    const double size = forces.norm2();
    forces.update(-1., Au, 1.);
    EXPECT_LT(forces.norm2(), 1e-12 * size);
  }
}

TEST(TiedSides, TheGradientIsTheDerivativeAndTheSolverInvertsTheTangent)
{
  for (const Pressed &pressed : bodies(1e8)) { // points that are pressed in are closed
    const auto step = pressed.problem->step(1);
    analysis::SolverState state(*pressed.problem);
    contact::Iterate iterate(step.elastic, step.contact, state.hessian());
    Vector u = pressed.displacement(step, 2, 1e-3);
    const auto group = step.elastic.dirichlet.tied;
    ASSERT_TRUE(group);
    set_members(*group, {-0.01}, u);
    Vector F(u.getMap());
    iterate.gradient(u, F);
    iterate.update_hessian(u);
    const Vector b = pressed.displacement(step, 3, 1);
    Vector x(u.getMap());
    const auto solved = state.linear().solve(b, x, 1e-10);
    ASSERT_TRUE(solved.converged) << solved.reason;
    const auto moved = [&](const double t) {
      Vector v(u, Teuchos::Copy);
      v.update(t, x, 1.);
      return v;
    };
    double t = 1e-6 / x.normInf(); // no point changes its state
    Vector change(u.getMap());
    iterate.gradient(moved(t), change);
    change.update(-1., F, 1.);
    change.scale(1 / t);
    change.update(-1., b, 1.);
    EXPECT_LT(change.norm2() / b.norm2(), 1e-6); // differences round
    const double slope = F.dot(x), curvature = b.dot(x), at_u = iterate.value(u);
    double before = 0;
    for (int halving = 0; halving < 3; ++halving, t /= 2) { // first order: half the error at half the step
      const double error = (iterate.value(moved(t)) - at_u) / t - slope;
      EXPECT_NEAR(error / (0.5 * t * curvature), 1, 1e-3) << halving;
      if (halving > 0) {
        EXPECT_NEAR(before / error, 2, 1e-2);
      }
      before = error;
    }
  }
}

TEST(TiedSides, AForceThatIsTheReactionLeadsToTheDisplacementThatItCameFrom)
{
  for (Pressed pressed : bodies()) {
    auto &top = pressed.model.dirichlet[0];
    top.force[1].reset();
    top.displacement[1] = ScalarField(-0.015);
    analysis::StepOptions options;
    options.uzawa.tolerance = 1e-12;
    const auto solved = [&] {
      const analysis::Problem problem(pressed.d().mesh, pressed.model);
      analysis::SolverState state(problem);
      return analysis::solve_step(problem, problem.step(1), state, options);
    };
    const auto given = solved();
    ASSERT_TRUE(given.uzawa.converged) << given.uzawa.reason;
    top.displacement[1].reset();
    top.force[1] = ScalarField(given.reactions[0][1]);
    const auto found = solved();
    ASSERT_TRUE(found.uzawa.converged) << found.uzawa.reason;
    EXPECT_NEAR(found.displacements[0][1] / -0.015, 1, 1e-10);
    EXPECT_NEAR(found.reactions[0][1] / given.reactions[0][1], 1, 1e-10);
  }
}

} // namespace
} // namespace tied_sides_test
