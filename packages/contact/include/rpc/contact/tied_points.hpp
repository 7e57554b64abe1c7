// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/contact_state.hpp"

#include <vector>

namespace rpc::contact
{

/// Refuses friction at nodes of a side that a force moves: what they slip would follow the tied unknown. Collective.
/// @throws rpc::Error (bad_input)
void require_no_friction_on_tied(const fem::Discretization &d, const ContactNodes &points,
                                 const fem::DirichletDofs &dirichlet, const std::vector<ContactOptions> &options);

/// Of nodes that a force moves along their normal, or along a part of it, free_gap takes over how far: a step is solved as if the force did not move
/// them, so that its pressure there, if any, is wrong. Collective.
/// @param state  the solution
/// @throws rpc::Error (bad_input) where one of them bears a pressure, or touches once it has moved
void settle_tied_points(const fem::Discretization &d, const ContactNodes &points, const fem::DirichletDofs &dirichlet,
                        const std::vector<ContactOptions> &options, const ContactState &state);

} // namespace rpc::contact
