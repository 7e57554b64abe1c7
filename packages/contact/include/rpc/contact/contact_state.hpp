// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/law/foundation.hpp"

namespace rpc::contact
{

/// Multipliers at the contact points.
struct Multipliers {
  DeviceView<double *> normal;      ///< (points) lambda >= 0 [Pa]
  DeviceView<double **> tangential; ///< (points, dim) along the side [Pa]; empty: the law has none

  Multipliers() = default;
  Multipliers(DeviceView<double *> lambda, DeviceView<double **> along = {})
      : normal(std::move(lambda)), tangential(std::move(along))
  {
  }
  bool has_tangential() const { return tangential.extent(0) > 0; }
  /// A deep copy.
  Multipliers copy() const;
};

/// The state of body and foundation, displacement and multipliers: one step hands it to the next, and a solution is judged by it. Plain data.
struct ContactState {
  RCP<const Vector> displacement; ///< (owned dofs) from 0 [m]
  Multipliers multiplier;
  DeviceView<State *> active_set; ///< (points); empty where it is not known
  /// (owned dofs) Rounding error of `displacement` [m]: the true displacement is the sum of both. Null: 0.
  RCP<const Vector> rest = {};
};

/// A copy in which points without weight have the pressures of their neighbours as multipliers: for interpolation. Collective.
/// @param sides  that the contact nodes were made from
ContactState with_weightless(ContactState state, const ContactNodes &c, const fem::Discretization &d,
                             const std::vector<const mesh::Side *> &sides);

/// A copy of the displacement in which closed points of a foundation without a spring lie on it. What a penalty leaves of their distance would
/// be slip of a node that another side's friction holds along this one's normal.                                        (12.14)
RCP<Vector> on_foundation(const ContactNodes &points, const ContactState &state);

/// The state on another mesh of the same scene: displacement and multipliers by interpolation, side by side, without an active
/// set. Collective.
/// @param interpolation  (fine owned nodes x coarse owned nodes), such as fem::interpolation()
/// @param fine_dofs      owned dofs of the other mesh
ContactState interpolated(const Operator &interpolation, const ContactNodes &coarse, const ContactState &state,
                          const ContactNodes &fine, const RCP<const Map> &fine_dofs);

} // namespace rpc::contact
