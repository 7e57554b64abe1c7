// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"

#include <ostream>

namespace rpc
{

/// What rpc understands of a deck, for --check: the body, each side with its area, normal and role, loads with their resultants, the
/// foundation's law, steps, unknowns, and about what a run takes. Collective; rank 0 prints.
/// @param step  the first one
void print_understood(std::ostream &out, const Scene &scene, const analysis::Problem &problem,
                      const analysis::Step &step);

} // namespace rpc
