#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/result.hpp"

#include <vector>

/// Dents of a foundation that the body's points move along.                               doc/theory.md (11.4)
///
/// Where "Dents Move With" = foundation, the dents of a side lie on the foundation's surface: that of node j lies where the node is
/// in the mesh, seen from the foundation, which is where it was at the first step. Point i stands at
///
///     y_i = x_i + u_i - (motion of the obstacle since the first step)
///
/// and meets the dents where the line through y_i along its normal meets the side as it is in the mesh. What a step adds to the dents of
/// points is carried back alone, so that older dents stay as they are. The foundation remembers dents under the side's place in the
/// mesh; beyond it there are none.
namespace rpc::contact
{

bool any_moves_with_foundation(const std::vector<ContactOptions> &options);

/// The dents that nodes meet, (owned nodes; sides) [m]: of sides whose dents move with the body those given. Collective.
/// @param options  seen at the time of the step
/// @param dents    (owned nodes; sides) at the nodes' places in the mesh [m]
/// @param u        (owned dofs) at which the nodes meet them [m]
RCP<const MultiVector> dents_met(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                                 const RCP<const MultiVector> &dents, const Vector &u);

/// Adds to dents on the foundation what a step has added to those of points; those of other sides stay. Collective.
/// @param options  seen at the time of the step
/// @param added    (owned nodes; sides) >= 0, at nodes as they stand [m]
/// @param u        (owned dofs) after the step [m]
/// @param[in,out] dents  (owned nodes; sides) at the nodes' places in the mesh [m]
void add_where_they_lie(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                        const MultiVector &added, const Vector &u, MultiVector &dents);

/// Makes `max_dent` and `dent_volume` those of the whole foundation where dents move with it; of other sides they are that already.
/// Collective.
/// @param dents  (owned nodes; sides) after the step, at the nodes' places in the mesh [m]
void take_dents_of_foundation(const fem::Discretization &d, const std::vector<ContactOptions> &options,
                              const MultiVector &dents, ContactResult &result);

} // namespace rpc::contact
