// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <NOX_Direction_Generic.H>
#include <NOX_Direction_UserDefinedFactory.H>

namespace rpc::solver
{

/// The Newton direction from where a nonlinear sweep of the functional leads, as a NOX direction for NewtonGroup: truncated
/// nonsmooth Newton, after Graeser, Sander and Kornhuber. The sweep puts unknowns on the kinks of the functional, where a line
/// search would end at the first of them. doc/theory.md (4.6)
///
/// After a step that the line search cut short at a kink the next direction comes without a sweep, once: from there a sweep can lead
/// back before the kink, and the steps would become ever shorter.
class SweepDirection : public NOX::Direction::Generic
{
public:
  bool reset(const Teuchos::RCP<NOX::GlobalData> &, Teuchos::ParameterList &) override { return true; }
  /// Moves the group, too, to where the sweep leads. A direction that the context gives is taken as it is.
  bool compute(NOX::Abstract::Vector &direction, NOX::Abstract::Group &group,
               const NOX::Solver::Generic &solver) override;

private:
  bool swept_ = false; // before the last direction
};

/// Hands SweepDirection to NOX ("Direction" -> "Method" = "User Defined").
class SweepDirectionFactory : public NOX::Direction::UserDefinedFactory
{
public:
  Teuchos::RCP<NOX::Direction::Generic> buildDirection(const Teuchos::RCP<NOX::GlobalData> &,
                                                       Teuchos::ParameterList &) const override;
};

} // namespace rpc::solver
