#include "preconditioner/factor.hpp"

#include "direct_solver.hpp"
#include "rpc/algebra/bounded_update.hpp"

namespace rpc::solver
{
namespace
{

// Multiplications. On several ranks the hierarchy that would take its place is set up over all of them, and is not exact.
constexpr double most_work_of_factor = 1e7, most_work_on_ranks = 1e8;

} // namespace

Preconditioner::Prepared Factor::prepare(double)
{
  const bool current = revision_ == H_->revision();
  if (!current) {
    factor_.reset();
    if (A_.is_null()) A_ = H_->base().copy();
    write_update(*A_, *H_, bounded_update(*H_));
    const bool alone = A_->getComm()->getSize() == 1;
    factor_ = direct_solver(A_, H_->dofs_per_node(), alone ? most_work_of_factor : most_work_on_ranks);
    revision_ = H_->revision();
  }
  if (!factor_) return Prepared::refused;
  return current ? Prepared::unchanged : Prepared::made;
}

void Factor::forget()
{
  factor_.reset();
  A_ = Teuchos::null;
  revision_ = -1;
}

void Factor::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  for (std::size_t k = 0; k < x.getNumVectors(); ++k) factor_->apply(*x.getVector(k), *y.getVectorNonConst(k));
}

} // namespace rpc::solver
