// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/same_active_set.hpp"

#include "rpc/analysis/rules.hpp"

#include <utility>

namespace rpc::analysis
{

SameActiveSet::Verdict SameActiveSet::judge(const solver::NewtonGroup &at)
{
  if (at.getNormF() <= at.context().target_residual) return Verdict::over;
  if (!proposed_) return Verdict::go_on;
  const Vector &F = solver::tpetra(at.getF());
  Vector G(F.getMap());
  iterate_.active_set_gradient(solver::tpetra(at.getX()), F, G); // (5.6)
  G.update(-1., F, 1.);
  const bool is_enough = at.getNormF() <= choice_rules.ended_by_rounding * norm_before_ &&
                         G.norm2() <= choice_rules.same_residual * at.getNormF();
  return is_enough ? Verdict::converged : Verdict::over;
}

SameActiveSet::Step SameActiveSet::propose(solver::NewtonGroup &group, Vector &direction)
{
  if (std::exchange(proposed_, true)) return Step::none;
  const Vector &F = solver::tpetra(group.getF());
  Vector G(F.getMap());
  iterate_.active_set_gradient(solver::tpetra(group.getX()), F, G); // (5.6)
  norm_before_ = G.norm2();
  const auto solved = solver::solve_for_direction(
      group.context(), G, direction, choice_rules.beside_target * group.context().target_residual / norm_before_);
  if (!solved.converged || !(direction.dot(F) > 0)) return Step::none;
  direction.scale(-1.);
  ++group.context().steps;
  ++steps_;
  return Step::search;
}

} // namespace rpc::analysis
