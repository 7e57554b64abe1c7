// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"

#include <string>

namespace rpc::fem
{

/// Refuses what is of a whole side, such as a force, and depends on the place, as far as some points tell.
/// @param parameter  of the deck   @param remedy  "Write ..."   @param why  it must not
void require_of_time_alone(const ScalarField &force, const std::string &parameter, const std::string &remedy,
                           const std::string &why = "it is the force on the whole side");

} // namespace rpc::fem
