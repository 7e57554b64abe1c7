// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/convex_functional.hpp"

#include <NOX_LineSearch_Generic.H>
#include <NOX_LineSearch_UserDefinedFactory.H>
#include <vector>

namespace rpc::solver
{

/// The t > 0 where the slope of a piecewise quadratic functional vanishes, to rounding. doc/theory.md (4.4)
///
/// The slope is continuous, nondecreasing and piecewise linear: Newton's method, kept inside a bracket and helped by
/// bisection, ends on the piece that holds the root and is then exact. Each trial evaluates the slope once.
/// @return 0 if slope(0) >= 0: no descent; infinite if the slope is negative however far it goes; collective
double exact_step(const LineFunction &line);

/// Coefficients at which a piecewise quadratic functional on a subspace is least, by Newton's method with exact steps: at the
/// returned ones it is no larger than at the given ones. doc/theory.md (4.4a)
/// @param a  (directions) where to start; collective
std::vector<double> least_within(const SubspaceFunction &function, std::vector<double> a);

/// Exact minimization of the functional along the direction, as a NOX line search for NewtonGroup; steps that the context marks
/// as full are taken as they are. Without it full Newton steps cycle between pieces of the functional.
///
/// Where a step ends at a kink, the functional is minimized, from there, within the span of the direction and of the last ones
/// before it: edges of contact zones that move by a node a step move on. doc/theory.md (4.4a)
class ExactLineSearch : public NOX::LineSearch::Generic
{
public:
  /// @param earlier  directions to minimize within at most, besides the new one; 0: none
  explicit ExactLineSearch(int earlier) : most_earlier_(earlier) {}
  bool compute(NOX::Abstract::Group &group, double &step, const NOX::Abstract::Vector &direction,
               const NOX::Solver::Generic &solver) override;

private:
  std::size_t most_earlier_;
  std::vector<RCP<const rpc::Vector>> earlier_; // directions, from the oldest
};

/// Hands ExactLineSearch to NOX ("Line Search" -> "Method" = "User Defined").
class ExactLineSearchFactory : public NOX::LineSearch::UserDefinedFactory
{
public:
  explicit ExactLineSearchFactory(int most_earlier) : most_earlier_(most_earlier) {}
  Teuchos::RCP<NOX::LineSearch::Generic> buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &,
                                                         Teuchos::ParameterList &) const override;

private:
  int most_earlier_;
};

} // namespace rpc::solver
