#include "rpc/solver/exact_line_search.hpp"

#include "rpc/solver/newton_group.hpp"

#include <NOX_Solver_Generic.H>
#include <cmath>
#include <limits>

namespace rpc::solver
{

double exact_step(const LineFunction &line)
{
  const double start = line.at(0).slope;
  if (!(start < 0)) return 0;
  const double zero = 1e-12 * -start; // below, the sums' rounding decides
  double low = 0, high = std::numeric_limits<double>::infinity();
  double t = 1, previous_width = high;
  for (int trial = 0; trial < 200; ++trial) { // 53 halvings of any bracket, and its search by doubling
    const auto value = line.at(t);
    if (!std::isfinite(value.slope)) return 0;
    if (std::abs(value.slope) <= zero) return t;
    (value.slope < 0 ? low : high) = t;
    const double width = high - low;
    if (width <= 4 * std::numeric_limits<double>::epsilon() * t) return t;
    const double newton = t - value.slope / value.curvature;
    const bool inside = newton > low && newton < high; // false for a NaN as well
    const bool shrinks = !(width > 0.5 * previous_width) || std::isinf(high);
    previous_width = width;
    if (inside && shrinks)
      t = newton;
    else
      t = std::isinf(high) ? 2 * t : 0.5 * (low + high);
  }
  return t;
}

bool ExactLineSearch::compute(NOX::Abstract::Group &group, double &step, const NOX::Abstract::Vector &direction,
                              const NOX::Solver::Generic &solver)
{
  const auto &from = dynamic_cast<const NewtonGroup &>(solver.getPreviousSolutionGroup());
  NewtonContext &context = from.context();
  if (context.full_step) {
    step = 1;
  } else {
    step = exact_step(*context.functional.along(tpetra(from.getX()), tpetra(direction), tpetra(from.getF())));
    context.functional.step_taken(step);
  }
  context.step_length = step;
  group.computeX(from, direction, step);
  if (!(step > 0) && context.failure.empty())
    context.failure = "the functional does not fall along the Newton direction";
  return step > 0;
}

Teuchos::RCP<NOX::LineSearch::Generic> ExactLineSearchFactory::buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &,
                                                                               Teuchos::ParameterList &) const
{
  return Teuchos::rcp(new ExactLineSearch);
}

} // namespace rpc::solver
