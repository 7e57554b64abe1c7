// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/exact_line_search.hpp"

#include "rpc/core/causes.hpp"
#include "rpc/solver/newton_group.hpp"
#include "rpc/solver/rules.hpp"

#include <NOX_Solver_Generic.H>
#include <Teuchos_LAPACK.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace rpc::solver
{
namespace
{

/// -H^-1 g; empty where rounding leaves H indefinite. Directions may be as good as dependent: with the rounding of H on its
/// diagonal, scaled to 1, the result still leads down.
std::vector<double> newton_direction(const SubspaceFunction::Value &value)
{
  const std::size_t n = value.gradient.size();
  std::vector<double> scale(n), H(n * n), d(n);
  for (std::size_t k = 0; k < n; ++k) scale[k] = 1 / std::sqrt(value.curvature[n * k + k]);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t l = 0; l < n; ++l) H[n * k + l] = scale[k] * value.curvature[n * k + l] * scale[l];
    H[n * k + k] += rounding.sum;
    d[k] = -scale[k] * value.gradient[k];
  }
  const int size = static_cast<int>(n);
  int info = 0;
  Teuchos::LAPACK<int, double>().POSV('L', size, 1, H.data(), size, d.data(), size, &info);
  if (info != 0) return {};
  for (std::size_t k = 0; k < n; ++k) d[k] *= scale[k];
  return d;
}

} // namespace

double exact_step(const LineFunction &line)
{
  const double start = line.at(0).slope;
  if (!(start < 0)) return 0;
  const double zero = rounding.sum * -start;
  const double infinity = std::numeric_limits<double>::infinity();
  double low = 0, high = infinity;
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
  return std::isinf(high) ? infinity : t;
}

std::vector<double> least_within(const SubspaceFunction &function, std::vector<double> a)
{
  double first = 0;
  for (int step = 0; step < newton_rules.most_inner_steps; ++step) {
    const auto value = function.at(a);
    const auto d = newton_direction(value);
    double slope = 0;
    for (std::size_t k = 0; k < d.size(); ++k) slope += value.gradient[k] * d[k];
    if (step == 0) first = slope;
    if (!(slope < rounding.sum * first)) break;
    const double t = exact_step(*function.along(a, value, d));
    if (!std::isfinite(t)) break;
    for (std::size_t k = 0; k < a.size(); ++k) a[k] += t * d[k];
  }
  return a;
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
    if (std::isinf(step)) { // but for rounding the functional of a body that is held has such a direction nowhere
      context.failure = because(causes::breakdown, "the functional falls without end along Newton's direction");
      step = 0;
    }
    context.functional.step_taken(step);
  }
  context.step_length = step;
  group.computeX(from, direction, step);
  if (most_earlier_ > 0 && !context.full_step && step > 0) {
    auto directions = earlier_;
    directions.push_back(rcp(new rpc::Vector(tpetra(direction), Teuchos::Copy)));
    if (!earlier_.empty() && std::abs(step - 1) > newton_rules.to_the_minimum) {
      std::vector<double> a(directions.size());
      a.back() = step;
      a = least_within(*context.functional.within(tpetra(from.getX()), directions, tpetra(from.getF())), std::move(a));
      NoxVector moved(dynamic_cast<const NoxVector &>(from.getX()), NOX::DeepCopy);
      for (std::size_t k = 0; k < a.size(); ++k) moved.data().update(a[k], *directions[k], 1.);
      group.setX(moved);
    }
    if (directions.size() > most_earlier_) directions.erase(directions.begin());
    earlier_ = std::move(directions);
  }
  if (!(step > 0) && context.failure.empty()) context.failure = because(causes::no_descent);
  return step > 0;
}

Teuchos::RCP<NOX::LineSearch::Generic> ExactLineSearchFactory::buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &,
                                                                               Teuchos::ParameterList &) const
{
  return Teuchos::rcp(new ExactLineSearch(most_earlier_));
}

} // namespace rpc::solver
