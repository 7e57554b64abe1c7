#pragma once

#include "scene.hpp"

#include <string>

namespace rpc
{

/// The table of load steps as comma-separated values: one row for each; for each Dirichlet condition its mean displacement and its
/// reaction.
std::string history_text(const Scene &scene, const analysis::Solution &solution);

} // namespace rpc
