// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/linear_solver_options.hpp"
#include "rpc/solver/mesh_levels.hpp"
#include "rpc/solver/mesh_multigrid.hpp"
#include "rpc/solver/preconditioner.hpp"

namespace rpc::solver
{

/// Multigrid on coarser meshes, (4.7a). The coarsest matrix is factored where it has few unknowns; else MueLu's hierarchy follows.
/// The meshes are made at the first set-up. Changes of contact are followed in place.
class Meshes : public Preconditioner
{
public:
  /// @param levels  not null
  Meshes(RCP<UpdatedOperator> H, MakeMeshLevels levels, LinearSolverOptions options)
      : H_(std::move(H)), make_levels_(std::move(levels)), options_(std::move(options))
  {
  }

  /// @throws std::runtime_error where there is no coarser mesh, or a coarse matrix is not positive definite
  Prepared prepare() override;
  void forget() override;
  std::string name() const override { return "meshes"; }
  std::string description() const override;
  /// Where slight changes of contact that the coarsest solver has not followed have cost as much time as it takes
  /// to follow them, it does so next.                                                                doc/theory.md (4.12)
  void learn(int iterations, double seconds_of_iteration) override;

  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp = Teuchos::NO_TRANS, double = 1,
             double = 0) const override
  {
    multigrid_->apply(x, y);
  }
  RCP<const Map> getDomainMap() const override { return H_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return H_->getRangeMap(); }

private:
  std::unique_ptr<CoarsestSolver> coarsest(const MeshLevel &level, bool has_few_unknowns) const;

  RCP<UpdatedOperator> H_;
  MakeMeshLevels make_levels_;
  LinearSolverOptions options_;
  RCP<MeshMultigrid> multigrid_; // null: to be made
  std::size_t num_levels_ = 0;   // with the finest one
  std::string remark_;           // of MeshLevels
  int revision_ = -1;            // of H when it was last brought to it
  bool is_current_ = false;      // the coarsest solver is that of the present contact
  double lost_seconds_ = 0;      // since it was
};

} // namespace rpc::solver
