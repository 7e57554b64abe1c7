// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "boundary.hpp"
#include "side_on_host.hpp"

namespace rpc::bound
{

/// What the contact law, the pressures and the normals are at the facets of a side, the same on all ranks. Collective.
/// @param model  seen at the time of the step   @param k  which contact side
/// @param prescribed  (facets, component) 1 where the displacement is
/// @throws rpc::Error (bad_input) where the side is not covered
ContactFacets contact_side(const analysis::Problem &problem, const analysis::Model &model, const analysis::Step &step,
                           const OnHost &host, int k, const PointTractions &solution,
                           const HostView<char *[2]> &prescribed);

} // namespace rpc::bound
