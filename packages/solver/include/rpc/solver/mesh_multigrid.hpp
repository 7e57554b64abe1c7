// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/mesh_levels.hpp"

#include <functional>
#include <memory>

namespace rpc::solver
{

/// What solves for the coarsest of the given levels.
class CoarsestSolver
{
public:
  /// How an update has followed the matrix.
  enum class Update {
    made,  ///< made for it
    exact, ///< as good as that
    rough  ///< slight changes have been left out
  };

  virtual ~CoarsestSolver() = default;
  /// The matrix has changed; collective.
  /// @param slight  changes of a node's own block alone, up to this part of it, may be left out where that saves time
  /// @throws std::runtime_error on all ranks if it is not positive definite
  virtual Update update(double slight) = 0;
  /// What part of the contact stiffness may change before update() is called: until then the solver is that of earlier states.
  virtual double most_change() const { return 0; }
  /// About the time of update() [s], which may wait while CG takes less time for the changes that it has not taken in; 0: it may not wait.
  virtual double seconds_of_update() const { return 0; }
  /// x <- about A^-1 b, by a symmetric positive definite operator; collective.
  virtual void apply(const Vector &b, Vector &x) const = 0;
};

/// A factor of the matrix as it is now; collective.
/// @return null where it would take more memory than there is, or the matrix is not positive definite
std::unique_ptr<CoarsestSolver> direct_solver(RCP<const CrsMatrix> A, int dofs_per_node);

/// One V cycle of multigrid on given meshes, for H = K + contact. The interpolation between meshes does not depend on the contact
/// states. It brings contact to each coarse matrix in place, and coarse functions are truncated at the contact points of the finest
/// mesh: a change of states costs as much work as there are contact points. Symmetric and positive definite.
/// doc/theory.md (4.7a), (4.7b)
class MeshMultigrid : public Operator
{
public:
  /// Null where the matrix is not positive definite.
  using MakeCoarsestSolver = std::function<std::unique_ptr<CoarsestSolver>(const MeshLevel &)>;

  /// Collective. @param levels  at least one
  /// @throws std::runtime_error on all ranks if a matrix is not positive definite
  MeshMultigrid(RCP<const UpdatedOperator> H, const MeshLevels &levels, const MakeCoarsestSolver &make_coarsest);
  ~MeshMultigrid() override;

  /// Follows H; collective.
  /// @param slight_changes_too  the coarsest solver follows these as well: where no node's block changes by more than a tenth of the node's
  ///                            own stiffness                                                        doc/theory.md (4.12)
  /// @return whether it is as good as that of the present states
  bool update(bool slight_changes_too = true);
  /// Of the coarsest solver.
  double seconds_of_update() const { return coarsest_->seconds_of_update(); }

  /// y <- B x; collective.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return H_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return H_->getRangeMap(); }

private:
  struct Level;
  DeviceView<double ***> write_contact();
  void add_smoother(const MeshLevels &levels, std::size_t l);
  void cycle(std::size_t level, const Vector &b, Vector &x) const;

  RCP<const UpdatedOperator> H_;
  DeviceView<LO *> contact_node_;              // (nodes) those of H
  RCP<const Map> contact_;                     // map of these
  DeviceView<double ***> contact_base_;        // (nodes, dim, dim) K's own blocks there
  DeviceView<double **> at_rest_, kept_;       // (nodes, dim) zeros; what truncation leaves as it is
  std::vector<std::unique_ptr<Level>> levels_; // from the finest to the one above the coarsest
  std::unique_ptr<CoarsestSolver> coarsest_;
  DeviceView<double ***> contact_of_coarsest_; // (nodes, dim, dim) the update coarsest_ was brought to last
  bool coarsest_is_exact_ = true;              // else it has left out slight changes of that update
};

} // namespace rpc::solver
