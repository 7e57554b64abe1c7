// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"

#include <string>

namespace rpc
{

/// Writes the contact points of a solution, see io::write_contact_csv(). Collective.
void write_contact(const std::string &path, const Scene &scene, const analysis::Solution &solution);

} // namespace rpc
