// SPDX-License-Identifier: BSD-3-Clause
#include "derivative_checks.hpp"
#include "rpc/analysis/solve_step.hpp"
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
    model.contact = {round_gap(yield)};
    problem = std::make_shared<analysis::Problem>(
        std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())), model);
  }
  const fem::Discretization &d() const { return problem->discretization(); }
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
    const Vector u = irregular_displacement(*pressed.problem, step, 1, 1);
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
    Vector u = irregular_displacement(*pressed.problem, step, 2, 1e-3);
    const auto group = step.elastic.dirichlet.tied;
    ASSERT_TRUE(group);
    set_members(*group, {-0.01}, u);
    expect_derivatives(*pressed.problem, step, u, 1e-6);
  }
}

TEST(TiedSides, HowSoftTheBodyIsIsNotToldBeforeASolveHasShownIt)
{
  for (const Pressed &pressed : bodies()) {
    analysis::SolverState first(*pressed.problem), second(*pressed.problem);
    const auto step = pressed.problem->step(1);
    const auto found = analysis::solve_step(*pressed.problem, step, first, {});
    ASSERT_TRUE(found.uzawa.converged) << found.uzawa.reason;
    EXPECT_GT(found.softness.displacement[0], 0);
    EXPECT_TRUE(std::isfinite(found.softness.displacement[0]));
    const auto again = analysis::solve_step(*pressed.problem, step, second, {}, {{found.state}, {}});
    ASSERT_TRUE(again.uzawa.converged) << again.uzawa.reason;
    EXPECT_EQ(std::isinf(again.softness.displacement[0]), again.linear.iterations.empty());
    if (!again.linear.iterations.empty()) {
      EXPECT_NEAR(again.softness.displacement[0] / found.softness.displacement[0], 1, 1e-6);
    }
    analysis::SolverState untouched(*pressed.problem);
    EXPECT_TRUE(untouched.linear().softness_of_tied().empty());
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
