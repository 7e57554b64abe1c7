#include "guarded_solver.hpp"

#include <exception>
#include <limits>
#include <new>

namespace rpc::solver
{

void GuardedSolver::Setup(MueLu::Level &level)
{
  failed_ = false;
  try {
    direct_->Setup(level);
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &) { // a singular matrix
    failed_ = true;
  }
  IsSetup(true);
}

void GuardedSolver::Apply(XpetraVectors &x, const XpetraVectors &b, const bool initial_guess_is_zero) const
{
  try {
    if (!failed_) return direct_->Apply(x, b, initial_guess_is_zero);
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const std::exception &) { // Amesos2 factors at the first solve
  }
  x.putScalar(std::numeric_limits<double>::quiet_NaN());
}

} // namespace rpc::solver
