// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <string>
#include <vector>

namespace rpc
{

/// Kokkos' option by which this rank takes the GPU of its number on the host; of more ranks than GPUs several share one. Empty where
/// Kokkos' own options or its environment choose one, and where there are no GPUs or no kernels for them. After MPI_Init, before Kokkos.
/// @param given  options for Kokkos
std::string gpu_option(const std::vector<char *> &given);

/// "2 x NVIDIA H100 80GB HBM3, a rank each; messages through pinned memory of the host".
/// @param name    of the root's GPU
/// @param ranks   in all, one or more
/// @param gpus    different ones that they use
/// @param direct  MPI reads the GPUs' memory
std::string gpu_text(const std::string &name, int ranks, int gpus, bool direct);

/// What the log says about the ranks' GPUs, a line; empty without kernels for them. Collective, after Kokkos has started.
std::string gpu_report(const Comm &comm);

} // namespace rpc
