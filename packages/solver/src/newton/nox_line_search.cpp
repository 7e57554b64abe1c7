// SPDX-License-Identifier: BSD-3-Clause
#include "newton/nox_line_search.hpp"

#include "rpc/solver/rules.hpp"

#include <NOX_LineSearch_Factory.H>
#include <NOX_Solver_Generic.H>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rpc::solver
{
namespace
{

/// int_a^b of the slope, known at both ends. @param halvings  that are left
double rise_between(const LineFunction &line, const double a, const LineFunction::Value &at_a, const double b,
                    const LineFunction::Value &at_b, const int halvings)
{
  const double width = b - a, of_piece = at_a.curvature * width, risen = at_b.slope - at_a.slope;
  const bool one_piece =
      std::abs(risen - of_piece) <= rounding.sum * std::max(std::abs(at_a.slope), std::abs(at_b.slope));
  if (one_piece || !std::isfinite(risen)) return 0.5 * (at_a.slope + at_b.slope) * width;
  if (halvings == 0) { // two pieces, which meet at a + x
    const double x = (risen - at_b.curvature * width) / (at_a.curvature - at_b.curvature);
    if (!(x > 0 && x < width)) return 0.5 * (at_a.slope + at_b.slope) * width;
    return (at_a.slope + 0.5 * at_a.curvature * x) * x +
           (at_b.slope - 0.5 * at_b.curvature * (width - x)) * (width - x);
  }
  const double middle = 0.5 * (a + b);
  const auto between = line.at(middle);
  return rise_between(line, a, at_a, middle, between, halvings - 1) +
         rise_between(line, middle, between, b, at_b, halvings - 1);
}

const NewtonGroup &newton_group(const NOX::Abstract::Group &group)
{
  return dynamic_cast<const NewtonGroup &>(group);
}

} // namespace

double rise(const LineFunction &line, const double a, const double b)
{
  return rise_between(line, a, line.at(a), b, line.at(b), newton_rules.most_halvings);
}

double FunctionalMerit::computef(const NOX::Abstract::Group &group) const
{
  const auto &at = newton_group(group);
  const NewtonContext &context = at.context();
  if (!context.searched) return context.functional.value(tpetra(at.getX()));
  return at.step() == 0 ? 0 : rise(*context.searched, 0, at.step());
}

void FunctionalMerit::computeGradient(const NOX::Abstract::Group &group, NOX::Abstract::Vector &result) const
{
  result = group.getF();
}

double FunctionalMerit::computeSlope(const NOX::Abstract::Vector &direction, const NOX::Abstract::Group &group) const
{
  return direction.innerProduct(group.getF());
}

double FunctionalMerit::computeQuadraticModel(const NOX::Abstract::Vector &, const NOX::Abstract::Group &) const
{
  throw std::logic_error("the functional has no model for trust regions");
}

void FunctionalMerit::computeQuadraticMinimizer(const NOX::Abstract::Group &, NOX::Abstract::Vector &) const
{
  throw std::logic_error("the functional has no model for trust regions");
}

bool NoxLineSearch::compute(NOX::Abstract::Group &group, double &step, const NOX::Abstract::Vector &direction,
                            const NOX::Solver::Generic &solver)
{
  const auto &from = newton_group(solver.getPreviousSolutionGroup());
  NewtonContext &context = from.context();
  if (context.full_step) {
    step = 1;
    group.computeX(from, direction, step);
    return true;
  }
  context.searched = context.functional.along(tpetra(from.getX()), tpetra(direction), tpetra(from.getF()));
  const bool found = search_->compute(group, step, direction, solver);
  context.searched.reset();
  ++context.searches;
  if (!found) ++context.failed_searches;
  return found;
}

Teuchos::RCP<NOX::LineSearch::Generic> NoxLineSearchFactory::buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &data,
                                                                             Teuchos::ParameterList &) const
{
  return Teuchos::rcp(new NoxLineSearch(NOX::LineSearch::buildLineSearch(data, *list_)));
}

} // namespace rpc::solver
