// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/guarded_solver.hpp"
#include "rpc/core/message.hpp"

#include <exception>
#include <limits>

namespace rpc::solver
{

void GuardedSolver::Setup(MueLu::Level &level)
{
  failed_ = false;
  try {
    direct_->Setup(level);
  } catch (const std::exception &failure) { // a singular matrix
    pass_on_out_of_memory(failure);
    failed_ = true;
  }
  IsSetup(true);
}

void GuardedSolver::Apply(XpetraVectors &x, const XpetraVectors &b, const bool initial_guess_is_zero) const
{
  try {
    if (!failed_) return direct_->Apply(x, b, initial_guess_is_zero);
  } catch (const std::exception &failure) { // Amesos2 factors at the first solve
    pass_on_out_of_memory(failure);
  }
  x.putScalar(std::numeric_limits<double>::quiet_NaN());
}

} // namespace rpc::solver
