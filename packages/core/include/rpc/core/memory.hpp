#pragma once

namespace rpc
{

/// Memory that this process can have at most [B]: the least of the machine's, the container's and the shell's bound
/// (ulimit -v); +inf where the system does not tell. What others use meanwhile is not taken off.
double memory_limit();

} // namespace rpc
