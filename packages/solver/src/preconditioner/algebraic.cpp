// SPDX-License-Identifier: BSD-3-Clause
#include "preconditioner/algebraic.hpp"

#include "multigrid/muelu_defaults.hpp"
#include "rpc/algebra/bounded_update.hpp"
#include "rpc/solver/rules.hpp"

#include <utility>

namespace rpc::solver
{
namespace
{

Teuchos::ParameterList list_for(const Map &dofs, const int dofs_per_node, const LinearSolverOptions &options)
{
  Teuchos::ParameterList list = muelu_defaults(dofs, dofs_per_node);
  list.set("reuse: type", options.reuse);
  list.set("sa: damping factor", options.damping);
  if (options.muelu.isParameter("smoother: type")) list.remove("smoother: params"); // of another type
  list.setParameters(options.muelu);
  return list;
}

bool leaves_strength_open(const Teuchos::ParameterList &user)
{
  for (const char *name : {"coarse: max size", "smoother: type", "smoother: params"})
    if (user.isParameter(name)) return false;
  return true;
}

} // namespace

Algebraic::Algebraic(RCP<const UpdatedOperator> H, Body body, const LinearSolverOptions &options)
    : H_(std::move(H)), body_(std::move(body)), muelu_(list_for(*H_->getDomainMap(), body_.dim, options)),
      may_strengthen_(leaves_strength_open(options.muelu))
{
}

Preconditioner::Prepared Algebraic::prepare()
{
  const int revision = H_->revision();
  const bool exists = !multigrid_.is_null();
  if (exists && revision == revision_) return Prepared::unchanged;
  if (exists) {
    is_fresh_ = false;
    for (const double slight : {0., double(linear_rules.slight_change)}) {
      correction_ = LocalCorrection::around(*H_, *A_, written_, slight);
      const bool is_whole = !correction_ && num_changes(*H_, written_, slight) == 0; // there is nothing to correct
      if (!correction_ && !is_whole) continue;
      revision_ = revision;
      return is_whole && slight == 0 ? Prepared::unchanged : Prepared::updated;
    }
  }
  set_up();
  revision_ = revision;
  return Prepared::made;
}

void Algebraic::write(const DeviceView<double ***> &update)
{
  written_ = update;
  write_update(*A_, *H_, update);
}

void Algebraic::set_up()
{
  correction_.reset();
  if (A_.is_null()) A_ = H_->base().copy();
  write(bounded_update(*H_, linear_rules.most_on_coarse_meshes));
  correction_ = LocalCorrection::around(*H_, *A_, written_);
  if (!correction_) write(bounded_update(*H_));
  is_fresh_ = true;
  is_renewed_ =
      !multigrid_.is_null() && muelu_.get<std::string>("reuse: type") != "none" && renew_multigrid(A_, multigrid_);
  if (is_renewed_) return;
  Teuchos::ParameterList list = muelu_;
  list.sublist("user data").set("Coordinates", body_.coordinates());
  list.sublist("user data").set("Nullspace", body_.null_space());
  multigrid_ = Teuchos::null; // two hierarchies would take twice the memory
  multigrid_ = make_multigrid(A_, list);
}

void Algebraic::forget()
{
  multigrid_ = Teuchos::null;
  correction_.reset();
  A_ = Teuchos::null;
  is_fresh_ = true;
  is_renewed_ = false;
}

void Algebraic::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  if (!correction_) return multigrid_->apply(x, y);
  for (std::size_t k = 0; k < x.getNumVectors(); ++k)
    correction_->apply(*multigrid_, *x.getVector(k), *y.getVectorNonConst(k));
}

// What a solve on the patch leaves of b is 0 there, and so are all residuals that follow.                           (4.8)
Preconditioner::Start Algebraic::start(const Vector &b) const
{
  if (!correction_) return {};
  const Start start{rcp(new Vector(b.getMap())), rcp(new Vector(b.getMap()))};
  correction_->solve_on_patch(b, *start.x, *start.rest);
  return start;
}

void Algebraic::apply_to_residual(const MultiVector &r, MultiVector &y) const
{
  if (!correction_) return multigrid_->apply(r, y);
  for (std::size_t k = 0; k < r.getNumVectors(); ++k)
    correction_->apply_off_patch(*multigrid_, *r.getVector(k), *y.getVectorNonConst(k));
}

bool Algebraic::renew()
{
  if (is_fresh_ && !is_renewed_) return false;
  forget();
  return true;
}

bool Algebraic::strengthen()
{
  if (!may_strengthen_ || std::exchange(strengthened_, true)) return false;
  Teuchos::ParameterList &smoother = muelu_.sublist("smoother: params");
  smoother.set("chebyshev: degree", int(linear_rules.strong_degree));
  smoother.set("chebyshev: ratio eigenvalue", double(linear_rules.strong_ratio));
  forget();
  return true;
}

} // namespace rpc::solver
