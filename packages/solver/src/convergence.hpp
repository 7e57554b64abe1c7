#pragma once

#include <vector>

namespace rpc::solver
{

/// The residuals of one Krylov iteration, from which it is predicted how many iterations it takes in all.
class Convergence
{
public:
  /// The next residual, |r|/|b|; of the start: 1, which is known.
  void add(double residual);
  int iterations() const { return static_cast<int>(least_.size()) - 1; }
  /// By the rate of the last iterations, by which the least residual has fallen. A rate over all of them would hide a stall behind what
  /// the first ones have gained.
  ///
  ///     k + w log(rho_k / eps) / log(rho_(k - w) / rho_k),    w = min(k, 20)                            doc/theory.md (4.10a)
  ///
  /// @param tolerance  eps, |r|/|b| that ends the solve   @param most  what is answered where nothing has fallen, and never exceeded
  double iterations_in_all(double tolerance, double most) const;

private:
  std::vector<double> least_{1.}; // (iterations + 1) rho, the least residual so far
};

} // namespace rpc::solver
