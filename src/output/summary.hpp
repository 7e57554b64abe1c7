// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"
#include "solve.hpp"

#include <nlohmann/json.hpp>

namespace rpc
{

/// The summary of a run as doc/input/results.md lists it. A value that is not a number (a limit of inf, say) is null.
nlohmann::ordered_json summary(const Scene &scene, const Solution &solution);

} // namespace rpc
