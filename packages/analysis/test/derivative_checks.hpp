// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/problem.hpp"
#include "rpc/analysis/solver_state.hpp"
#include "rpc/contact/iterate.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace rpc
{

/// An irregular displacement that may be added to an admissible one. It does not depend on the ranks.
/// @param[in] size  bound on its components  [m]
inline Vector irregular_displacement(const analysis::Problem &problem, const analysis::Step &step, const double phase,
                                     const double size)
{
  const fem::Discretization &d = problem.discretization();
  Vector v(d.owned_dofs);
  const auto id = d.mesh->node_id;
  for (LO i = 0; i < num_local(*d.owned_dofs); ++i) {
    const double number = static_cast<double>(dof(d.dim(), id(node_of(d.dim(), i)), component_of(d.dim(), i)));
    v.replaceLocalValue(i, size * std::sin(phase + 12.9898 * number * (1 + 1e-3 * number)));
  }
  fem::clear_prescribed(step.elastic.dirichlet, v);
  return v;
}

/// Checks at u that the gradient is the derivative of the functional and that the linear solver inverts the tangent.
/// @param[in] length  largest change of the first difference: no point may change its state within it  [m]
inline void expect_derivatives(const analysis::Problem &problem, const analysis::Step &step, const Vector &u,
                               const double length)
{
  analysis::SolverState state(problem);
  contact::Iterate iterate(step.elastic, step.contact, state.hessian());
  Vector F(u.getMap());
  iterate.gradient(u, F);
  iterate.update_hessian(u);
  const Vector b = irregular_displacement(problem, step, 3, 1);
  Vector x(u.getMap());
  const auto solved = state.linear().solve(b, x, 1e-10);
  ASSERT_TRUE(solved.converged) << solved.reason;
  const auto moved = [&](const double t) {
    Vector v(u, Teuchos::Copy);
    v.update(t, x, 1.);
    return v;
  };
  double t = length / x.normInf();
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

/// A foundation under the side "bottom" with a round gap, deepest at x = 0.9.
inline contact::ContactOptions round_gap(const double yield)
{
  contact::ContactOptions foundation;
  foundation.side = "bottom";
  foundation.gap = ScalarField("gap", [](const Point &x) { return 0.01 * std::pow(x[0] - 0.9, 2); });
  foundation.yield_stress = ScalarField(yield);
  return foundation;
}

} // namespace rpc
