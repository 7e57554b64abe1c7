// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

namespace rpc
{

/// A number of this rank's GPU: that of another rank is the same if they share it. 0 without a GPU.
GO gpu_identity();

/// Memory of its GPU that this rank can have at most [B]: ranks that share one have equal parts of it; +inf without GPUs. What others use
/// meanwhile is not taken off. Collective.
double gpu_memory_limit(const Comm &comm);

} // namespace rpc
