// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_state.hpp"
#include "rpc/fem/elasticity.hpp"

#include <functional>

namespace rpc::contact
{

/// How well (u, lambda) solves the discrete problem, how far it is from the saddle point of paper (8): four numbers without
/// dimension, 0 at the solution.                                                              doc/theory.md (5.2) to (5.5)
struct OptimalityResiduals {
  double equilibrium_residual = 0; ///< forces out of balance, over the forces at work                        (5.2)
  double kkt_residual = 0;         ///< largest violation of the contact law, over the largest pressure        (5.3)
  double energy_balance = 0;       ///< twice the strain energy less the work of all forces, over their sum   (5.4)
  double duality_gap = 0;          ///< primal less dual energy, over the energy at work                       (5.5)
  fem::InternalWork internal;      ///< of the displacement that was judged, for results to be read from
  RCP<const Vector> forces = {};   ///< of the body, those of what rounding has left of the displacement included [N]
  double force_size = 0;           ///< that the forces out of balance are compared with [N]                  (5.2)
  double energy_at_work = 0;       ///< the largest energy or work of (5.4) and (5.5) [J], in 2D per m

  /// The largest of the four; NaN if one is.
  double worst() const;
  bool holds(const double tolerance) const { return worst() <= tolerance; }
};

/// Judges (u, lambda) by sums over cells, not by the matrix that the solution came from; collective. Where the state has a rest, forces
/// are in balance with it: in doubles alone a stiff body that moves far cannot say how little it is strained.
/// @param force_scale      size of the forces at work, see Iterate::force_scale() [N]
/// @param residual_energy  F -> an estimate of F . K^-1 F [J], for a residual F (owned dofs, 0 where prescribed) [N]
/// @param least_energy     energy balance and duality gap are shares of this at least [J], in 2D per m             (5.5b)
OptimalityResiduals optimality_residuals(const fem::Discretization &d, const fem::Materials &materials,
                                         const fem::ElasticProblem &elastic, const ContactNodes &points,
                                         const ContactState &state, double force_scale,
                                         const std::function<double(const Vector &)> &residual_energy,
                                         double least_energy = 0);

/// Where all energies at work are no more than the accuracy of displacements alone may give them, (10.9), (5.4) and (5.5) compare rounding with
/// rounding: they become 0, and balance and contact law alone judge a body that nothing strains. A displacement that does not obey (5.5c) is
/// no minimum, and stays judged by all four. Collective.
/// @param tolerance, least_energy  by which (5.5c) may fail
void forgive_energies_of_rounding(const fem::Discretization &d, const fem::Materials &materials,
                                  const fem::ElasticProblem &elastic, const ContactNodes &points,
                                  const ContactState &state, double tolerance, double least_energy,
                                  OptimalityResiduals &residuals);

/// The equilibrium residual that rounding alone makes: of u_i eps with signs at random, the same on any number of ranks. Forces that are
/// out of balance by about that much cannot be brought nearer to it in double precision. Collective.
/// @param u  (owned dofs) [m]   @param force_size  see OptimalityResiduals [N]
double residual_of_rounding(const fem::Discretization &d, const fem::Materials &materials,
                            const fem::DirichletDofs &dirichlet, const Vector &u, double force_size);

} // namespace rpc::contact
