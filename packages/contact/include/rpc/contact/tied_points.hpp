// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"

#include <vector>

namespace rpc::contact
{

/// Refuses friction at nodes of a side that a force moves: what they slip would follow the tied unknown. Collective.
/// @throws rpc::Error (bad_input)
void require_no_friction_on_tied(const fem::Discretization &d, const ContactNodes &points,
                                 const fem::DirichletDofs &dirichlet, const std::vector<ContactOptions> &options);

/// Of nodes that a force moves along their normal, free_gap takes over how far: while a step is solved they count as if they did not
/// touch. Collective.
/// @param u  (owned dofs) the solution [m]
/// @throws rpc::Error (bad_input) where one of them touches after all
void settle_tied_points(const fem::Discretization &d, const ContactNodes &points, const fem::DirichletDofs &dirichlet,
                        const std::vector<ContactOptions> &options, const Vector &u);

} // namespace rpc::contact
