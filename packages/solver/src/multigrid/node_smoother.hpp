// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/node_blocks.hpp"
#include "rpc/core/tpetra.hpp"

#include <functional>
#include <memory>

namespace rpc::solver
{

/// The largest eigenvalue of D^-1 A, by some steps of Lanczos' method and with a margin for its error; the same on any number of
/// ranks up to rounding. Collective.
/// @param D  its blocks
/// @throws std::runtime_error on all ranks if A or D is not positive definite
double largest_eigenvalue(const Operator &A, const NodeBlocks &D);
/// The same for any symmetric positive definite D. @param apply_inverse  z <- D^-1 r
double largest_eigenvalue(const Operator &A, const std::function<void(const Vector &r, Vector &z)> &apply_inverse);

/// Chebyshev polynomials of D^-1 A for a symmetric positive definite A, D its diagonal blocks of the nodes: they damp what lies
/// between the largest eigenvalue of D^-1 A and a part of it.                                          doc/theory.md (4.7c)
///
/// D follows a change of A by its blocks at some nodes.
class NodeSmoother
{
public:
  struct Options {
    int degree = 2;     ///< > 0
    double ratio = 10.; ///< of the largest eigenvalue to the smallest one that is damped, > 1
  };

  /// @param A        what it smooths for
  /// @param D        its blocks
  /// @param changing (n) owned nodes at which D may change
  /// @param largest  upper bound of the eigenvalues of D^-1 A, also when both change. Collective.
  /// @throws std::runtime_error on all ranks if D is not positive definite
  NodeSmoother(RCP<const Operator> A, const NodeBlocks &D, const DeviceView<LO *> &changing, double largest,
               const Options &options);

  /// D changes at some nodes; collective.
  /// @param node   (n) some of those at which it may change
  /// @param block  (n, dim, dim); of a block that is not symmetric its symmetric part counts
  void set_blocks(const DeviceView<LO *> &node, const DeviceView<double ***> &block);

  const NodeBlocks &inverse_blocks() const { return inverse_; } ///< of D
  /// (owned dofs) That start() and improve() write, and others may use between them.
  Vector &work() const { return *product_; }

  /// x <- p(D^-1 A) D^-1 b: the polynomial's x for x = 0 at the start.
  void start(const Vector &b, Vector &x) const;
  /// x <- the same, from where x is.
  void improve(const Vector &b, Vector &x) const;

private:
  void step(const Vector &b, double keep, double add, bool at_zero, Vector &x) const;
  void polynomial(const Vector &b, bool at_zero, Vector &x) const;

  RCP<const Operator> A_;
  Options options_;
  NodeBlocks inverse_; // of D
  double largest_;
  RCP<Vector> move_, product_; // of the last step; A x
};

} // namespace rpc::solver
