// SPDX-License-Identifier: BSD-3-Clause
#include "preconditioner/meshes.hpp"

#include "factor/direct_solver.hpp"
#include "multigrid/muelu_defaults.hpp"
#include "multigrid/multigrid.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace rpc::solver
{
namespace
{

/// MueLu's hierarchy for the order-1 matrix of a mesh that has no coarser one. It is renewed where much of contact has changed.
class AlgebraicSolver : public CoarsestSolver
{
public:
  AlgebraicSolver(const MeshLevel &level, const Teuchos::ParameterList &list)
      : now_(level.stiffness), A_(rcp(new CrsMatrix(*level.stiffness, Teuchos::Copy))), list_(list),
        residual_(rcp(new Vector(A_->getDomainMap()))), correction_(rcp(new Vector(A_->getDomainMap())))
  {
    list_.sublist("user data").set("Coordinates", level.body.coordinates());
    list_.sublist("user data").set("Nullspace", level.body.null_space());
    multigrid_ = make_multigrid(A_, list_);
  }
  Update update(double) override
  {
    Kokkos::deep_copy(A_->getLocalMatrixDevice().values, now_->getLocalMatrixDevice().values);
    if (multigrid_.is_null() || !renew_multigrid(A_, multigrid_)) multigrid_ = make_multigrid(A_, list_);
    return Update::made;
  }
  double most_change() const override { return linear_rules.changed_part; }
  /// Two cycles: the matrix is small beside that of order 2, and one cycle costs it a third more CG iterations.
  void apply(const Vector &b, Vector &x) const override
  {
    if (multigrid_.is_null()) throw std::runtime_error("multigrid: the last update failed");
    multigrid_->apply(b, x);
    residual_->assign(b);
    A_->apply(x, *residual_, Teuchos::NO_TRANS, -1., 1.);
    multigrid_->apply(*residual_, *correction_);
    x.update(1., *correction_, 1.);
  }

private:
  RCP<const CrsMatrix> now_; // follows the states
  RCP<CrsMatrix> A_;         // what the hierarchy was made for
  Teuchos::ParameterList list_;
  RCP<Multigrid> multigrid_;
  RCP<Vector> residual_, correction_;
};

} // namespace

std::unique_ptr<CoarsestSolver> Meshes::coarsest(const MeshLevel &level, const bool has_few_unknowns) const
{
  if (has_few_unknowns) return direct_solver(level.stiffness, H_->dofs_per_node());
  Teuchos::ParameterList list = muelu_defaults(*level.stiffness->getDomainMap(), H_->dofs_per_node());
  list.set("reuse: type", options_.reuse == "none" ? "tP" : options_.reuse);
  list.setParameters(options_.muelu);
  return std::make_unique<AlgebraicSolver>(level, list);
}

Preconditioner::Prepared Meshes::prepare()
{
  const int revision = H_->revision();
  const bool exists = !multigrid_.is_null();
  if (exists && revision == revision_) return Prepared::unchanged;
  if (exists) {
    is_current_ = multigrid_->update(lost_seconds_ >= multigrid_->seconds_of_update());
  } else {
    const MeshLevels levels = make_levels_();
    if (levels.level.empty()) throw std::runtime_error("multigrid: a coarser mesh would be too small for the ranks");
    num_levels_ = levels.level.size() + 1;
    remark_ = levels.down_to_few ? levels.remark : "algebraic below";
    H_->allow_rounding(true);
    multigrid_ =
        rcp(new MeshMultigrid(H_, levels, [&](const MeshLevel &level) { return coarsest(level, levels.down_to_few); }));
    is_current_ = true;
  }
  revision_ = revision;
  return exists ? Prepared::updated : Prepared::made;
}

void Meshes::learn(const int iterations, const double seconds_of_iteration)
{
  // A solve on the interior path takes one or two iterations where nothing has been put off.
  lost_seconds_ = is_current_ ? 0 : lost_seconds_ + std::max(iterations - 1, 0) * seconds_of_iteration;
}

std::string Meshes::description() const
{
  return name() + ", " + std::to_string(num_levels_) + " levels" + (remark_.empty() ? "" : ", " + remark_);
}

void Meshes::forget()
{
  multigrid_ = Teuchos::null;
  H_->allow_rounding(false);
}

} // namespace rpc::solver
