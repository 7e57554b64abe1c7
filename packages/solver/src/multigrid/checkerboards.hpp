// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multigrid/shared_rows.hpp"
#include "rpc/algebra/stiff_dilatation.hpp"
#include "rpc/algebra/stiffness_operator.hpp"

namespace rpc::solver
{

/// For pressures that are constant in cells: in quadrilaterals and hexahedra of order 1 and in tetrahedra of order 2. Those that alternate
/// from cell to cell hardly move the body, and the softness of Z K_0^-1 Z^T falls short of that for waves by the more, the smoother they
/// alternate. What they do move are displacements that alternate as well, which K_0 resists about as its diagonal does. So
///
///     C = (I - F) (Z diag(K_0)^-1 Z^T + diag(1/s))^-1 (I - F)                                   doc/theory.md (4.15a)
///
/// adds to the inverse of the Schur complement what it lacks for them. F, the mean over the nodes of a cell of the mean over the cells at a
/// node, keeps smooth pressures as they are and takes alternating ones to 0. Chebyshev polynomials stand for the inverse.
class Checkerboards
{
public:
  /// Collective.
  /// @param dilatation  at_nodes is not null   @param soft  K_0
  /// @throws std::runtime_error on all ranks if K_0's diagonal is not positive
  Checkerboards(const StiffDilatation &dilatation, const StiffnessOperator &soft);

  /// y <- C x; collective.  @param x, y  (modes), not the same
  void apply(const Vector &x, Vector &y) const;

private:
  /// @param A  Z diag(K_0)^-1 Z^T + diag(1/s), which is written into
  Checkerboards(const StiffDilatation &dilatation, const RCP<CrsMatrix> &A);
  void without_smooth(Vector &y) const;

  SharedRows at_nodes_; // N
  Vector of_node_;      // (nodes) 1 / (nodes of a cell times the volume of the split cells at the node) [m^-dim]
  Vector scale_;        // (modes) roots of the inverse of A's diagonal
  StiffnessOperator A_; // to be inverted, with a diagonal of 1; one unknown a cell
  int degree_;          // of the polynomial
  double largest_, smallest_;
  mutable Vector at_node_, scaled_, product_, move_;
};

} // namespace rpc::solver
