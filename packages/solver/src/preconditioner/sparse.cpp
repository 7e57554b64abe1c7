#include "preconditioner/sparse.hpp"

#include "rpc/algebra/bounded_update.hpp"

#include <sstream>
#include <stdexcept>

namespace rpc::solver
{
namespace
{

// The factor takes closed nodes for at most so many times their own stiffness: all of it would cost digits where they open again. CG
// takes the difference in an iteration.
constexpr double most_closed_stiffness = 1e4;

} // namespace

const Sparse::Prospect &Sparse::prospect()
{
  if (solver_) return prospect_;
  A_ = H_->base().copy();
  solver_ = std::make_unique<DirectSolver>(A_, H_->dofs_per_node());
  prospect_ = {solver_->cost(), solver_->lacks_memory()};
  return prospect_;
}

Preconditioner::Prepared Sparse::prepare(double)
{
  const int revision = H_->revision();
  if (made_ && revision == revision_) return Prepared::unchanged;
  if (!prospect().obstacle.empty()) throw std::runtime_error(prospect_.obstacle);
  write_update(*A_, *H_, bounded_update(*H_, most_closed_stiffness));
  made_ = false;
  last_update_ = solver_->update(CoarsestSolver::slight_change);
  made_ = true;
  revision_ = revision;
  return last_update_ == CoarsestSolver::Update::made ? Prepared::made : Prepared::updated;
}

void Sparse::renew()
{
  made_ = false;
  solver_->forget();
}

std::string Sparse::description() const
{
  std::ostringstream text;
  text.precision(1);
  text << std::fixed << name() << " of " << H_->getDomainMap()->getGlobalNumElements() << " unknowns, "
       << prospect_.cost.entries / 1e6 << " million entries";
  return text.str();
}

void Sparse::forget()
{
  made_ = false;
  solver_.reset();
  A_ = Teuchos::null;
}

void Sparse::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  for (std::size_t k = 0; k < x.getNumVectors(); ++k) solver_->apply(*x.getVector(k), *y.getVectorNonConst(k));
}

} // namespace rpc::solver
