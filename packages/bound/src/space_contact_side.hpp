// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "boundary.hpp"
#include "space_contact.hpp"
#include "space_facets_on_host.hpp"

#include <string>

namespace rpc::bound
{

/// What the contact law, the pressures and the normals are at the facets of a side in space, the same on all ranks. Collective.
/// @param model  seen at the time of the step   @param k  which contact side
/// @param prescribed  (outer facets, component) 1 where the displacement is
/// @throws rpc::Error (bad_input) where the side is not covered
SpaceContact space_side(const fem::Discretization &discretization, const analysis::Model &model,
                        const analysis::Step &step, const SpaceFacetsOnHost &host, int k,
                        const PointTractions &solution, const HostView<char *[3]> &prescribed);

/// "(x, y, z)".
std::string place_in_space(const Point &x);

} // namespace rpc::bound
