#include "preconditioner/factor.hpp"

#include "direct_solver.hpp"
#include "rpc/algebra/bounded_update.hpp"

namespace rpc::solver
{
namespace
{

constexpr double most_work_of_factor = 1e7; // multiplications

} // namespace

Preconditioner::Prepared Factor::prepare(double)
{
  const bool current = revision_ == H_->revision();
  if (!current) {
    factor_.reset();
    if (A_.is_null()) A_ = H_->base().copy();
    write_update(*A_, *H_, bounded_update(*H_));
    factor_ = direct_solver(A_, H_->dofs_per_node(), most_work_of_factor);
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
