#pragma once

#include "rpc/contact/smoothed_functional.hpp"

#include <NOX_LineSearch_Generic.H>
#include <NOX_LineSearch_UserDefinedFactory.H>

namespace rpc::solver
{

/// The t > 0 where a line model's slope vanishes, to rounding. doc/theory.md (4.4)
///
/// The slope is continuous, nondecreasing and piecewise linear: Newton's method, kept inside a bracket and helped by
/// bisection, ends on the piece that holds the root and is then exact. Each trial costs one sum over the contact nodes.
/// @return 0 if slope(0) >= 0: no descent; collective
double exact_step(const contact::LineModel &line);

/// Exact minimization of the functional along the Newton direction, as a NOX line search for NewtonGroup.
/// Without it full steps cycle between sets of contact states.
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
