// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"

#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

namespace rpc
{

/// What the user should know of a deck before its mesh is made: lists that say nothing, and numbers that unit slips make.
/// @param deck  of which the scene was read
std::vector<std::string> notes_on_deck(const Teuchos::ParameterList &deck, const Scene &scene);

/// For results that loads have made too large: which of the loads is a force per area, and what a force on the whole side is; empty if there
/// is none.
std::string force_per_area_hint(const Scene &scene);

} // namespace rpc
