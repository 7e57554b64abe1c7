// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc
{

/// Memory that this process can have at most [B]: the least of the machine's, the container's and the shell's bound
/// (ulimit -v); +inf where the system does not tell. What others use meanwhile is not taken off.
double memory_limit();

/// Memory that is free now on the machine, or within the container's or the shell's bound if that is less [B]; +inf where the system does
/// not tell. All processes of the machine share it.
double memory_left();

/// Gives memory that was freed back to the system, where the C library can (glibc's keeps it). Before and after work that takes much
/// memory once: what is kept lies in pieces of other sizes, and the work would take new pages beside them. Takes milliseconds.
void return_freed_memory();

} // namespace rpc
