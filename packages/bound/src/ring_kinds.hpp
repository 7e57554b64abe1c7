// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "equilibration.hpp"
#include "space_stress.hpp"

#include <vector>

namespace rpc::bound
{

/// Which components of the traction of a facet are free, as bits, and times 8 the axis that it lies across; 3: none. Collective.
DeviceView<unsigned char *> free_components(const SpaceInput &in, const BoundaryTractions &boundary,
                                            const SlotExchange &of_facets);

/// Kinds of rings, and a ring of each.
struct RingKinds {
  DeviceView<int *> kind;
  std::vector<LO> example;
};
/// @param free  free_components()
RingKinds ring_kinds(const SpaceInput &in, const DeviceView<unsigned char *> &free);

} // namespace rpc::bound
