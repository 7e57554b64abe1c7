#pragma once

#include "rpc/core/convex_functional.hpp"

#include <NOX_LineSearch_Generic.H>
#include <NOX_LineSearch_UserDefinedFactory.H>

namespace rpc::solver
{

/// The t > 0 where the slope of a piecewise quadratic functional vanishes, to rounding. doc/theory.md (4.4)
///
/// The slope is continuous, nondecreasing and piecewise linear: Newton's method, kept inside a bracket and helped by
/// bisection, ends on the piece that holds the root and is then exact. Each trial evaluates the slope once.
/// @return 0 if slope(0) >= 0: no descent; collective
double exact_step(const LineFunction &line);

/// Exact minimization of the functional along the direction, as a NOX line search for NewtonGroup; steps that the context marks
/// as full are taken as they are. Without it full Newton steps cycle between pieces of the functional.
class ExactLineSearch : public NOX::LineSearch::Generic
{
public:
  bool compute(NOX::Abstract::Group &group, double &step, const NOX::Abstract::Vector &direction,
               const NOX::Solver::Generic &solver) override;
};

/// Hands ExactLineSearch to NOX ("Line Search" -> "Method" = "User Defined").
class ExactLineSearchFactory : public NOX::LineSearch::UserDefinedFactory
{
public:
  Teuchos::RCP<NOX::LineSearch::Generic> buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &,
                                                         Teuchos::ParameterList &) const override;
};

} // namespace rpc::solver
