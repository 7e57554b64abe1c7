// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_state.hpp"
#include "rpc/fem/elasticity.hpp"

/// Energies and forces of a state of body and foundation, and its residual in the contact law. Displacements are from 0; all functions
/// are collective.
namespace rpc::contact
{

/// Energies of (u, lambda) at the contact nodes, over all ranks.
struct ContactEnergy {
  double dissipated =
      0; ///< sum_i w_i (lambda_i - H_i d_i / 2) d_i, d = (v - c lambda)+ [J]; where the law holds the work that new dents
         ///< have taken up; perfectly plastic: lambda_i v_i+                                                     (3.14)
  double duality_gap =
      0; ///< sum_i w_i (psi_i(v_i) + psi_i*(lambda_i) - lambda_i v_i) [J], friction's s |e| - q . e included, each term >= 0: what the contact
         ///< law misses, with twice the largest multiplier in place of any higher xi or s          (5.5)
};

/// Energy of the problem, J(u) = Pi(u) + sum_i w_i psi_i(v_i) [J], computed as Pi(u) + sum_i w_i (lambda_i v_i -
/// psi_i*(lambda_i)): the two are equal where the contact law holds, but xi v+ makes much of the rounding of v at a closed
/// node.                                                                                  paper (6); (1.4), (5.14)
/// @param elastic  Pi(u) [J]
double energy(double elastic, const ContactNodes &points, const ContactState &state);

/// Energy of the problem at any u, by the contact law itself: Pi(u) + sum_i w_i (psi_i(v_i) + s_i |e_i|) [J], with friction's bounds of the
/// multiplier; infinite where a rigid foundation is penetrated.                                    (1.4), (12.2)
double energy_at(double elastic, const ContactNodes &points, const Multipliers &multiplier, const RCP<const Vector> &u);

/// Largest violation of the laws of contact and friction by (u, lambda), dimensionless: of w = 0 in paper (7).  (5.3), (12.6)
/// @param roundings  v and e within this many times their rounding bound count as 0: 1 or 0                       (12.7a)
double contact_law_residual(const ContactNodes &points, const ContactState &state, double roundings = 0);

ContactEnergy contact_energy(const ContactNodes &points, const ContactState &state);

/// sum_i w_i s_i |e_i| of this step [J]: what Tresca's functional has beside energy().                             (12.2)
double friction_work(const ContactNodes &points, const ContactState &state);

/// sum_i w_i (lambda_i m_i + lambda_tau,i), the force of the body on the foundation at the unknowns (owned dofs) [N].
Vector multiplier_forces(const ContactNodes &points, const Multipliers &multiplier, const RCP<const Map> &dofs);

} // namespace rpc::contact
