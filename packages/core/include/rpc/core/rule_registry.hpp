// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rpc::ablation
{

/// The value of a rule of this name: the one of `settings` = "name=value;name=value" where it is there, else `value`.
/// @throws std::invalid_argument if the number of an entry cannot be read
double replaced(double value, const std::string &name, const std::string &settings);

/// `replaced` by the environment variable RPC_RULES, which is also where "list" asks for a line about each rule on standard output.
double registered(double value, const char *name, const char *meaning, const char *source);

} // namespace rpc::ablation
