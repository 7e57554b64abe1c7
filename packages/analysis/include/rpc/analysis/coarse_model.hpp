// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/solver/sparse_factor.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace rpc::analysis
{

/// A contact point of a fine mesh, for a model of the body on a coarse one.
struct ModelPoint {
  double weight;    ///< w > 0 [m^(dim-1)]
  double stiffness; ///< k > 0 of the fine mesh's node alone [Pa/m]
  contact::Foundation law;
};

/// What a model says of all points.
struct ModelStates {
  std::vector<contact::State> state;
  std::vector<double> pressure; ///< [Pa]
};

/// How the contact points of a fine mesh move under their pressures, as a coarse mesh of the body tells and as solves on the fine mesh have
/// taught: it predicts the states at a solution from any solved active set.                       doc/theory.md (5.8b) to (5.8e)
///
/// A change dp of the pressures moves the points by about
///
///     dv = -C W dp,    C = s P K^-1 P^T + diag(1 / (w k)) + sum_j c_j c_j^T
///
/// with W the points' weights, P the displacements of the points, along their directions, as the coarse nodes give them, s >= 1 where the
/// coarse mesh is much too stiff, and c_j what makes C exact for the j-th change that was seen (symmetric rank-one updates).
///
/// It lives on one rank, on the host.
class CoarseModel
{
public:
  /// @param size    unknowns of the coarse mesh
  /// @param K       its stiffness [N/m], prescribed unknowns eliminated
  /// @param points  P^T: a column for each point, of free unknowns alone
  /// @param data    (points)
  CoarseModel(int size, const solver::SymmetricEntries &K, solver::SparseColumns points, std::vector<ModelPoint> data);

  /// Whether its factors, of which a choice takes several, are cheap. A precondition of all functions below.
  /// @param solve_seconds  what a linear solve of the fine mesh takes on one rank
  bool is_cheap(double solve_seconds) const;

  /// Takes the minimum for an active set on the fine mesh, whose changes against the one before it teach the model.
  /// @param v  (points) penetration [m]   @param p  (points) pressures, whether the law admits them or not [Pa]
  void learn(std::vector<double> v, std::vector<double> p);
  /// How many changes were of use.
  int num_learnt() const { return static_cast<int>(learnt_.size()); }
  double scale() const { return scale_; } ///< s
  /// The states of the model's solution, from what was taken last. Nothing where it is not found.
  std::optional<ModelStates> choose();

private:
  struct Unknowns { // of the model: displacement of the coarse nodes, and factors of the c_j
    std::vector<double> y, part;
    void move(double t, const Unknowns &d);
  };
  struct Change {               // of two active sets' minima
    std::vector<double> forces; // W dp [N]
    std::vector<double> moved;  // (points) -dv less the local part [m]
    std::vector<double> coarse; // (points) P K^-1 P^T W dp [m]
  };
  /// H of (5.8e) with its factors.
  struct System {
    std::vector<double> stiffness;                     // (points) of the pieces [Pa/m]
    std::vector<std::vector<double>> coupling, solved; // B and A^-1 B, a column for each c_j
    std::vector<double> S;                             // Cholesky factor of what is left for the z_j
  };
  class Line;
  std::vector<double> points_moved(const Unknowns &x) const;
  std::vector<double> nodal_forces(const std::vector<double> &p) const;
  Unknowns elastic_forces(const Unknowns &x) const;
  double pressure(std::size_t i, double moved) const;
  contact::State state(std::size_t i, double moved) const;
  bool factorize(const std::vector<double> &stiffness);
  void update();
  Unknowns gradient(const Unknowns &elastic, std::vector<double> pressure) const;
  bool factorize(System &system);
  Unknowns direction(const System &system, const Unknowns &gradient) const;

  int size_;
  solver::SymmetricEntries K_;                   // of the lower half, row after row
  std::vector<double> matrix_;                   // (entries of K_) of the factor
  solver::SparseColumns points_;                 // P^T
  std::vector<ModelPoint> data_;                 // (points)
  std::vector<std::size_t> first_;               // (points + 1) where each point's entries begin in
  std::vector<int> entry_;                       // what it adds to: of each pair of its unknowns the place in K_
  std::unique_ptr<solver::SparseFactor> factor_; // null: it would not be cheap
  bool is_elastic_ = false;                      // the factor is K's
  std::vector<double> v_, p_;                    // (points) taken last
  std::vector<Change> changes_;                  // that were seen
  double scale_ = 1;
  std::vector<std::vector<double>> learnt_; // (points) c_j
};

} // namespace rpc::analysis
