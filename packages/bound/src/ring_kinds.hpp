// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_kinds.hpp"
#include "equilibration.hpp"
#include "space_stress.hpp"

namespace rpc::bound
{

/// Which components of the traction of a facet are free, as bits, and times 8 the axis that it lies across; 3: none. Collective.
DeviceView<unsigned char *> free_components(const SpaceInput &in, const BoundaryTractions &boundary,
                                            const SlotExchange &of_facets);

/// Rings of cells of the same kinds in the same places.
/// @param free  free_components()
Kinds ring_kinds(const SpaceInput &in, const DeviceView<unsigned char *> &free);

} // namespace rpc::bound
