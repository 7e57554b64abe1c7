// SPDX-License-Identifier: BSD-3-Clause
#include "preconditioner/factor.hpp"

#include "rpc/algebra/bounded_update.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/solver/rules.hpp"

#include <limits>
#include <sstream>
#include <stdexcept>

namespace rpc::solver
{
namespace
{

/// On all ranks; collective. @param a, b  (nodes, dim, dim)
bool are_equal(const Comm &comm, const DeviceView<double ***> &a, const DeviceView<double ***> &b)
{
  const int dim = static_cast<int>(a.extent(1));
  LO different = 0;
  Kokkos::parallel_reduce(
      "rpc::solver::are_equal", device_range(static_cast<LO>(a.extent(0))),
      KOKKOS_LAMBDA(const LO n, LO &count) {
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) count += a(n, k, l) != b(n, k, l);
      },
      different);
  return sum_all(comm, GO(different)) == 0;
}

} // namespace

const Factor::Prospect &Factor::prospect()
{
  if (solver_) return prospect_;
  A_ = H_->base().copy();
  solver_ = std::make_unique<DirectSolver>(A_, H_->dofs_per_node(), is_band_);
  prospect_ = {solver_->cost(), solver_->lacks_memory()};
  return prospect_;
}

Preconditioner::Prepared Factor::prepare()
{
  const int revision = H_->revision();
  if (revision == revision_) return Prepared::unchanged;
  revision_ = -1;
  const std::string &obstacle = prospect().obstacle;
  if (!obstacle.empty()) throw std::runtime_error(obstacle);
  const auto bounded = bounded_update(*H_, std::numeric_limits<double>::max());
  has_all_ = are_equal(*H_->getDomainMap()->getComm(), bounded, H_->update());
  write_update(*A_, *H_, bounded);
  last_update_ = solver_->update(linear_rules.slight_change);
  revision_ = revision;
  return last_update_ == CoarsestSolver::Update::made ? Prepared::made : Prepared::updated;
}

bool Factor::renew()
{
  if (std::exchange(last_update_, CoarsestSolver::Update::made) == CoarsestSolver::Update::made) return false;
  revision_ = -1;
  solver_->forget();
  return true;
}

std::string Factor::name() const
{
  return is_band_ ? "band factor" : "sparse factor";
}

std::string Factor::description() const
{
  std::ostringstream text;
  text.precision(1);
  text << std::fixed << name() << " of " << H_->getDomainMap()->getGlobalNumElements() << " unknowns, "
       << prospect_.cost.entries / 1e6 << " million entries";
  return text.str();
}

void Factor::forget()
{
  revision_ = -1;
  solver_.reset();
  A_ = Teuchos::null;
}

void Factor::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  for (std::size_t k = 0; k < x.getNumVectors(); ++k) solver_->apply(*x.getVector(k), *y.getVectorNonConst(k));
}

} // namespace rpc::solver
