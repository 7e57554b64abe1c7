#pragma once

#include "rpc/contact/smoothed_functional.hpp"

#include <cstdint>

namespace rpc::contact
{

/// The next active set of the primal-dual active-set iteration, and the pressures that it was chosen by.
struct ActiveSetChoice {
  DeviceView<State *> state;     ///< (contact nodes)
  DeviceView<double *> pressure; ///< (contact nodes) [Pa]
  GO changes = 0;                ///< points on all ranks whose state is to change
  double overshoot = 0;          ///< forces of closed points that the law does not admit, over those that it admits
  bool confirmed = false; ///< no changes: u and the pressures obey the contact law, up to what the penalty leaves
  std::uint64_t fingerprint = 0; ///< of all states on all ranks: equal for equal ones
};

/// The states that the Hessian belongs to. Plain data.
struct ActiveSet {
  DeviceView<State *> state; ///< (points)
  bool chosen = false;       ///< else the states are those of K itself, all open, and say nothing about pressures
};

/// The first choice, from multipliers and penetrations, before there is an active set.                            (5.8)
/// @param all_close  all points close instead: only contact holds the body
ActiveSetChoice first_choice(const SmoothedFunctional &functional, const ActiveSet &present, const Vector &u,
                             bool all_close);

/// One choice of the active-set iteration at the minimum u for the present active set: a point goes from open to yielding, or
/// back, only by way of closed.                                                                                  (5.8)
/// @param own         (points) stiffness of each point alone [Pa/m]
/// @param negligible  violations up to this part of the largest pressure change no state; dimensionless, >= 0
ActiveSetChoice next_choice(const SmoothedFunctional &functional, const ActiveSet &present, const Vector &u,
                            const DeviceView<double *> &own, double negligible);

/// Takes the choice's states for the active set, its pressures for multipliers as far as the states allow. Nodes that close are
/// moved onto the foundation: r v would make a large residual of a small distance.                              (5.7)
void take_choice(const ActiveSetChoice &choice, const SmoothedFunctional &functional, ActiveSet &active, Vector &u);

/// About the largest error of the pressures at nodes that are not open, over the largest pressure: the share k/r that the
/// penalty leaves of the last change, with k the node's own stiffness.                                           (5.10)
double pressure_error(const SmoothedFunctional &functional, const ActiveSet &active, const Vector &u,
                      const DeviceView<double *> &own);

/// (points, dim, dim) What an active set adds to K: the stiffness of the law's branch, and a weak spring where a point is not
/// closed [N/m].                                                                                           (4.2a), (9.8)
/// @param spring  in units of the points' scaling, >= 0
DeviceView<double ***> added_blocks(const SmoothedPoints &points, const DeviceView<State *> &active, double spring);

} // namespace rpc::contact
