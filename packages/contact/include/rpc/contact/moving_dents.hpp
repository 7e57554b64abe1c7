// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/result.hpp"

#include <memory>
#include <vector>

/// Dents of a foundation that the body's points move along.                               doc/theory.md (11.4)
///
/// Where "Dents Move With" = foundation, the dents of a side lie where the body stood when it pressed them in, seen from the foundation,
/// which is where it was at the first step: point i stands at
///
///     y_i = x_i + u_i - (motion of the obstacle since t = 0).
///
/// The foundation keeps the side as it stood in each step that has dented it, a sheet with what the step has added to the dents: it
/// remembers what lies beyond the side's present place. A point meets the sum of what all sheets have where the line through y_i along
/// its normal meets them. Of many sheets those that lie in one place become one.
namespace rpc::contact
{

/// The dented facets of a side as it stood. Plain data: this rank's part, in which each facet of all ranks is once.
struct DentSheet {
  mesh::Element facet;          ///< of the side
  double spread = 0;            ///< by how much nodes had moved along the foundation beside each other [m]
  std::vector<Point> place;     ///< (nodes) y, seen from the foundation [m]
  std::vector<Point> direction; ///< (nodes) unit, into the foundation
  std::vector<double> dent;     ///< (nodes) what was pressed in there [m]
  std::vector<LO> facet_node;   ///< (facets, nodes of a facet) numbers of the nodes above
};

/// What a side's foundation remembers, whatever meshes the body has had since. Plain data.
struct FoundationDents {
  std::vector<std::shared_ptr<const DentSheet>> sheets; ///< from the oldest; none where dents move with the body
  double deepest = 0;                                   ///< that any step has pressed in [m]
  double volume = 0; ///< that all steps have pressed in, sum of w times what is added [m^3], in the plane [m^2]
};

bool any_moves_with_foundation(const std::vector<ContactOptions> &options);

/// The dents that nodes meet, (owned nodes; sides) [m]. Collective.
/// @param options     seen at the time of the step
/// @param with_body   (owned nodes; sides) dents of sides whose dents move with the body [m]
/// @param foundations by side; empty: none has a dent
/// @param u           (owned dofs) at which the nodes meet them [m]
RCP<const MultiVector> dents_met(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                                 const RCP<const MultiVector> &with_body,
                                 const std::vector<FoundationDents> &foundations, const Vector &u);

/// Adds what a step has pressed into foundations that remember. Older dents stay as they are. Collective.
/// @param options  seen at the time of the step
/// @param added    (owned nodes; sides) >= 0 at nodes as they stand [m]
/// @param after    (owned nodes; sides) the dents of contact points after the step [m]
/// @param u        (owned dofs) after the step [m]
/// @param[in,out] foundations  by side
void press_in(const fem::Discretization &d, const std::vector<ContactOptions> &options, const MultiVector &added,
              const MultiVector &after, const Vector &u, std::vector<FoundationDents> &foundations);

/// Makes `max_dent` and `dent_volume` those of all dents of the foundation, though some may lie at no contact point now, or between the
/// nodes of a new mesh. Sides that do not remember keep theirs.
void take_all_dents(const std::vector<ContactOptions> &options, const std::vector<FoundationDents> &foundations,
                    ContactResult &result);

} // namespace rpc::contact
