// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"

#include <string>

namespace rpc::fem
{

/// Refuses a force on a whole side that depends on the place, as far as some points tell.
/// @param parameter  of the deck   @param remedy  "Write ..."
void require_of_time_alone(const ScalarField &force, const std::string &parameter, const std::string &remedy);

} // namespace rpc::fem
