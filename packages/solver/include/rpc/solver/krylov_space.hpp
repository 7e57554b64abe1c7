// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"

#include <vector>

namespace rpc::solver
{

/// The space of a Krylov method whose operator H = K + update may change at its nodes while the method goes on: vectors z_j = B F_j, one for
/// each residual that it met. The products with K are kept, those with the update are made anew where H has changed. With one H it is
/// GMRES, preconditioned on the right. All members are collective.                                  doc/theory.md (12.15)
class KrylovSpace
{
public:
  explicit KrylovSpace(RCP<const UpdatedOperator> H);

  /// One more vector, B F over its norm. @return whether it is finite and not 0
  bool extend(const Operator &B, const Vector &F);
  /// d <- the vector of the space for which |F + H d| is least, with the present H; F <- F + H d. @return |F|
  double minimize(Vector &d, Vector &F);
  /// The same d, for a caller who finds F at d himself.
  void find_least(const Vector &F, Vector &d);
  int size() const { return static_cast<int>(z_.size()); }

private:
  void follow();
  std::vector<double> least(const Vector &F, const Vector &rows);

  RCP<const UpdatedOperator> H_;
  RCP<const Map> at_nodes_;                      // the rows of H's nodes, of each rank
  int revision_;                                 // of H that the last ones below belong to
  std::vector<RCP<Vector>> z_, elsewhere_;       // z; K z but for the rows of H's nodes, which are 0
  std::vector<RCP<Vector>> K_rows_, H_rows_;     // rows of H's nodes of K z, of H z
  std::vector<std::vector<double>> products_;    // of elsewhere_[j] with those up to j
  std::vector<std::vector<double>> at_products_; // the same of H_rows_
};

} // namespace rpc::solver
