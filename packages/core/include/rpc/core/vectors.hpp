#pragma once

/// Whether kernels on the host may be written with the vector types of GCC, for the processor at hand.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#define RPC_HAS_VECTORS
#endif
