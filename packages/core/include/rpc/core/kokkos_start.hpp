// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

/// What differs between the versions of Kokkos where it starts, see doc/trilinos_versions.md.
namespace rpc
{

/// An option for Kokkos as this version spells it: --kokkos-threads is --kokkos-num-threads in Kokkos 4, and either is taken. Others
/// stay as they are.
std::string kokkos_spelling(const std::string &option);

/// Calls what starts Kokkos. Where Kokkos 3.4 cannot start, as with an option that makes no sense, it throws; 4.5 writes the reason to
/// the standard error and calls abort(). Here it is an exception with both.
///
/// The standard error is kept back meanwhile. It appears afterwards if Kokkos has started, without Kokkos' warnings of options that
/// it does not know: these stay among the arguments, and the caller tells of them.
/// For the main thread.
/// @throws std::exception  with Kokkos' reason; Kokkos cannot be started any more then
void start_or_throw(const std::function<void()> &start);

} // namespace rpc
