// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/sweep_direction.hpp"

#include "rpc/solver/newton_group.hpp"
#include "rpc/solver/rules.hpp"

namespace rpc::solver
{
bool SweepDirection::compute(NOX::Abstract::Vector &direction, NOX::Abstract::Group &group,
                             const NOX::Solver::Generic &)
{
  using Group = NOX::Abstract::Group;
  NewtonContext &context = dynamic_cast<const NewtonGroup &>(group).context();
  if (!context.given.is_null()) {
    dynamic_cast<NoxVector &>(direction).data().assign(*context.given);
    return true;
  }
  swept_ = !swept_ || context.step_length >= newton_rules.cut_short;
  if (swept_) {
    NoxVector moved(dynamic_cast<const NoxVector &>(group.getX()), NOX::DeepCopy);
    context.functional.sweep(moved.data());
    group.setX(moved);
  }
  if (group.computeF() != Group::Ok || group.computeJacobian() != Group::Ok) return false;
  Teuchos::ParameterList none;
  const auto status = group.computeNewton(none);
  direction = group.getNewton();
  context.piece = context.functional.piece(tpetra(group.getX()));
  return status == Group::Ok || status == Group::NotConverged; // a rough direction leads down as well
}

Teuchos::RCP<NOX::Direction::Generic> SweepDirectionFactory::buildDirection(const Teuchos::RCP<NOX::GlobalData> &,
                                                                            Teuchos::ParameterList &) const
{
  return Teuchos::rcp(new SweepDirection);
}

} // namespace rpc::solver
