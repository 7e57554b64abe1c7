// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/smoothed_functional.hpp"

#include <cstdint>

namespace rpc::contact
{

/// The next active set of the primal-dual active-set iteration, and the pressures that it was chosen by.
struct ActiveSetChoice {
  DeviceView<State *> state;            ///< (contact nodes)
  DeviceView<double *> pressure;        ///< (contact nodes) [Pa]
  DeviceView<Slip *> slip = {};         ///< (contact nodes) of friction; empty: there is none
  DeviceView<double **> direction = {}; ///< (contact nodes, dim) where a point slips: h in the plane, g in space
  DeviceView<bool *> cannot_stick = {}; ///< (contact nodes) slips: a part of its slip is prescribed
  DeviceView<double **> lever = {};     ///< (contact nodes, dim) by which a point sticks, (12.8a); else 0
  DeviceView<double *> violation = {};  ///< (contact nodes) of the law by points whose state is to change, else 0 [Pa]
  DeviceView<double **> traction = {};  ///< (contact nodes, dim) along the side that slip was chosen by [Pa]
  GO changes = 0;                       ///< points on all ranks whose state is to change
  double overshoot = 0;                 ///< ratio of inadmissible to admissible contact force of closed points
  bool confirmed = false; ///< no changes: u and the pressures obey the contact law, up to what the penalty leaves
  std::uint64_t fingerprint = 0; ///< of all states on all ranks: equal for equal ones
};

/// The first active set, from multipliers and penetrations.                                                       (5.8)
/// @param all_close  all points close instead: only contact holds the body
ActiveSetChoice first_choice(const SmoothedFunctional &functional, const ActiveSet &present, const Vector &u,
                             bool all_close);

/// One active-set update at the minimum u for the present active set: a point goes from open to yielding, or
/// back, only by way of closed.                                                                                  (5.8)
/// @param own         (points) stiffness of each point alone [Pa/m]
/// @param negligible  violations up to this part of the largest pressure change no state; dimensionless, >= 0
ActiveSetChoice next_choice(const SmoothedFunctional &functional, const ActiveSet &present, const Vector &u,
                            const DeviceView<double *> &own, double negligible);

/// The update restricted to points that violate the law by at least `part` of the largest violation: for active sets that cycle. With
/// friction only.
ActiveSetChoice largest_changes(const SmoothedFunctional &functional, const ActiveSet &present,
                                const ActiveSetChoice &choice, double part);

/// Takes the update's states for the active set, its pressures for multipliers as far as the states allow. Nodes that close are
/// moved onto the foundation: r v would make a large residual of a small distance.                              (5.7)
/// @param own  (points) stiffness of each point alone [Pa/m]
void take_choice(const ActiveSetChoice &choice, const SmoothedFunctional &functional, const DeviceView<double *> &own,
                 ActiveSet &active, Vector &u);

/// Directions of slip in space become those that the equations linearized last give at u.                       (12.13)
void turn_slip(const SmoothedPoints &points, const ActiveSet &active, const Vector &u);

/// Of a side with friction, points on the branches of an active set are moved to where their penalties bear nothing, and their multipliers take
/// over what they bear; in space multipliers of points that slip turn to their tractions. Nodes of two sides, and those with a prescribed
/// unknown, stay as they are.                                                                              (12.17)
void rest_on_multipliers(const SmoothedPoints &points, const ActiveSet &active, Vector &u);

/// About the largest error of the pressures at nodes that are not open, over the largest pressure: the share k/r that the
/// penalty leaves of the last change, with k the node's own stiffness. In space also that of tractions of points that slip, whose direction
/// follows the penalty.                                                                                            (5.10)
double pressure_error(const SmoothedFunctional &functional, const ActiveSet &active, const Vector &u,
                      const DeviceView<double *> &own);

/// (points, dim, dim) What points add to K, see UpdatedOperator [N/m].
struct AddedBlocks {
  DeviceView<double ***> block;
  DeviceView<double ***> coupling = {}; ///< empty: there is no friction
};

/// The stiffness of an active set's branches at u, and a weak spring where a point is not closed, and along the side where it slips; notes
/// where friction was linearized. (4.2a), (9.8), (12.13)
/// @param spring  in units of the points' scaling, >= 0
AddedBlocks added_blocks(const SmoothedPoints &points, const ActiveSet &active, const Vector &u, double spring);
/// The same of the functional itself at u, whose friction does not follow the pressure: symmetric.          (4.2a), (12.4)
AddedBlocks functional_blocks(const SmoothedPoints &points, const Vector &u, double spring);

/// (points, dim) The tractions of an active set along the side, whether the law admits them or not [Pa].            (12.5)
DeviceView<double **> active_set_tractions(const SmoothedPoints &points, const ActiveSet &active, const Vector &u);

} // namespace rpc::contact
