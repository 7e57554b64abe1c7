// SPDX-License-Identifier: BSD-3-Clause
#include "preconditioner/factor.hpp"

#include "direct_solver.hpp"
#include "rpc/algebra/bounded_update.hpp"
#include "rpc/solver/rules.hpp"

namespace rpc::solver
{
namespace
{

double most_work(const CrsMatrix &A)
{
  const Comm &comm = *A.getComm();
  const bool on_one = max_all(comm, GO(num_local(*A.getRowMap()))) == static_cast<GO>(A.getGlobalNumRows());
  return comm.getSize() > 1 && on_one ? linear_rules.most_work_on_one_of_several : linear_rules.most_work;
}

} // namespace

Preconditioner::Prepared Factor::prepare(double)
{
  const bool current = revision_ == H_->revision();
  if (!current) {
    factor_.reset();
    if (A_.is_null()) A_ = H_->base().copy();
    write_update(*A_, *H_, bounded_update(*H_));
    factor_ = direct_solver(A_, H_->dofs_per_node(), most_work(*A_));
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
