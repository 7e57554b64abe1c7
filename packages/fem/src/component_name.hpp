// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::fem
{

/// Names of a vector's components in the deck.
inline constexpr const char *component_name[] = {"X", "Y", "Z"};

} // namespace rpc::fem
