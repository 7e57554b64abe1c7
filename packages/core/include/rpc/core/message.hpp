// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

namespace rpc
{

/// A message as a terminal should get it, in one line of at most 900 bytes. What it quotes of a user's files may be
/// anything: control characters become "?", tabs blanks, and a text that is too long loses its middle.
std::string for_terminal(std::string message);

/// Whether an exception says that memory ran out; Kokkos has a runtime_error of its own for it.
bool is_out_of_memory(const std::exception &error);

/// For handlers of exceptions that all ranks throw: rethrows one that memory ran out, which the other ranks have not thrown.
/// @param error  the exception that is being handled
void pass_on_out_of_memory(const std::exception &error);

} // namespace rpc
