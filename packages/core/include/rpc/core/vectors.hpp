// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Whether kernels on the host may be written with the vector types of GCC, for the processor at hand.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#define RPC_HAS_VECTORS

namespace rpc
{

using Four = double __attribute__((vector_size(32))); ///< four numbers at a time

} // namespace rpc
#endif
