// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/newton_group.hpp"

#include <NOX_LineSearch_Generic.H>
#include <NOX_LineSearch_UserDefinedFactory.H>
#include <NOX_MeritFunction_Generic.H>
#include <Teuchos_ParameterList.hpp>

namespace rpc::solver
{

/// int_a^b of a line function's slope, which is continuous, nondecreasing and piecewise linear: exact where kinks of the functional are
/// at least 1/1024 of the interval apart; collective.
double rise(const LineFunction &line, double a, double b);

/// What NOX's line searches are to lower: the convex functional itself. Their own choice, |F|^2/2, may rise along a Newton direction at a
/// kink, and its slope takes the transpose of the Jacobian.
///
/// Along the line that is searched it is the change of the functional since t = 0, by its slope: the difference of two values would be
/// rounding near the minimum.
class FunctionalMerit : public NOX::MeritFunction::Generic
{
public:
  double computef(const NOX::Abstract::Group &group) const override;
  void computeGradient(const NOX::Abstract::Group &group, NOX::Abstract::Vector &result) const override;
  double computeSlope(const NOX::Abstract::Vector &direction, const NOX::Abstract::Group &group) const override;
  /// Of trust regions, which the deck cannot choose. @throws std::logic_error, both
  double computeQuadraticModel(const NOX::Abstract::Vector &, const NOX::Abstract::Group &) const override;
  void computeQuadraticMinimizer(const NOX::Abstract::Group &, NOX::Abstract::Vector &) const override;
  const std::string &name() const override { return name_; }

private:
  std::string name_ = "the functional";
};

/// A line search of NOX's; the context notes where it fails. Steps that the context marks as full are taken as they are.
class NoxLineSearch : public NOX::LineSearch::Generic
{
public:
  explicit NoxLineSearch(RCP<NOX::LineSearch::Generic> search) : search_(std::move(search)) {}
  bool compute(NOX::Abstract::Group &group, double &step, const NOX::Abstract::Vector &direction,
               const NOX::Solver::Generic &solver) override;

private:
  RCP<NOX::LineSearch::Generic> search_;
};

/// Hands NoxLineSearch to NOX ("Line Search" -> "Method" = "User Defined").
class NoxLineSearchFactory : public NOX::LineSearch::UserDefinedFactory
{
public:
  /// @param list  the deck's list for the line search, which is read from there
  explicit NoxLineSearchFactory(RCP<Teuchos::ParameterList> list) : list_(std::move(list)) {}
  Teuchos::RCP<NOX::LineSearch::Generic> buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &data,
                                                         Teuchos::ParameterList &) const override;

private:
  RCP<Teuchos::ParameterList> list_;
};

} // namespace rpc::solver
