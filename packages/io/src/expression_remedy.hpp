// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/remedies.hpp"

#include <string>

namespace rpc::io
{

/// What to write instead of a text that is no expression: " Did you mean "sin"?", " Powers are written ^."; empty if nothing is known.
std::string expression_remedy(const std::string &text, const Wanted &wanted = {});

} // namespace rpc::io
