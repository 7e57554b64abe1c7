// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace rpc
{

/// What `work` returns, which runs in a child of this process: a library that a damaged file breaks down, or that writes to the console, does
/// so there alone. On this rank alone; `work` does nothing with MPI, threads or the device.
/// @return nothing where the child broke down, as where memory ran out
/// @throws rpc::Error with the code and the text of one that work throws; internal_error where there can be no child
std::optional<std::string> in_child_process(const std::function<std::string()> &work);

} // namespace rpc
