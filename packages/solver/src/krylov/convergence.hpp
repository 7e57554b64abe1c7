// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace rpc::solver
{

/// Iterations of a solve that are not lost; they are counted to 1e-8.
double fair(double tolerance);

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

/// The error of CG in the norm of H by what its iterations add to the energy of x. From x = 0 on,
///
///     |x_k|_H^2 = x_k . b,    |x - x_k|_H^2 = |x|_H^2 - |x_k|_H^2,
///
/// so that the gains of all later iterations are the error's square; they are taken to fall on as the last ones have.
/// doc/theory.md (4.10c)
class EnergyError
{
public:
  /// @param rate  by which gains fall, until two of them tell; 1: not known, which is never small
  explicit EnergyError(const double rate = 1) : rate_(rate) {}

  /// After an iteration. @param energy  x_k . b [J]
  void add(double energy);
  /// About |x - x_k|_H^2 [J]; infinite before the first iteration, and where no rate is known.
  double squared() const;
  double energy() const { return energy_; }
  double rate() const { return rate_; }

private:
  double energy_ = 0, gain_ = -1, rate_; // gain -1: none yet
};

} // namespace rpc::solver
