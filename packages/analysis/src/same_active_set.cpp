#include "rpc/analysis/same_active_set.hpp"

#include <utility>

namespace rpc::analysis
{

SameActiveSet::Verdict SameActiveSet::judge(const solver::NewtonGroup &at)
{
  return proposed_ || at.getNormF() <= at.context().target_residual ? Verdict::over : Verdict::go_on;
}

SameActiveSet::Step SameActiveSet::propose(solver::NewtonGroup &group, Vector &direction)
{
  if (std::exchange(proposed_, true)) return Step::none;
  const Vector &F = solver::tpetra(group.getF());
  Vector G(F.getMap());
  iterate_.active_set_gradient(solver::tpetra(group.getX()), F, G); // (5.6)
  const auto solved =
      solver::solve_for_direction(group.context(), G, direction, 0.1 * group.context().target_residual / G.norm2());
  if (!solved.converged || !(direction.dot(F) > 0)) return Step::none;
  direction.scale(-1.);
  ++group.context().steps;
  return Step::search;
}

} // namespace rpc::analysis
