// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/gpu_memory.hpp"

#include <limits>

#ifdef KOKKOS_ENABLE_CUDA
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cuda_runtime_api.h>
#include <functional>
#include <string>
#include <vector>
#endif

namespace rpc
{

GO gpu_identity()
{
#ifdef KOKKOS_ENABLE_CUDA
  int device = 0;
  cudaDeviceProp gpu{};
  if (cudaGetDevice(&device) != cudaSuccess || cudaGetDeviceProperties(&gpu, device) != cudaSuccess) return 0;
  const std::string uuid(gpu.uuid.bytes, sizeof(gpu.uuid.bytes));
  return static_cast<GO>(std::hash<std::string>()(uuid) >> 1); // not negative
#else
  return 0;
#endif
}

double gpu_memory_limit([[maybe_unused]] const Comm &comm)
{
#ifdef KOKKOS_ENABLE_CUDA
  const GO mine = gpu_identity();
  const std::vector<GO> all = gathered_by_all(comm, std::vector<GO>{mine});
  std::size_t free = 0, total = 0;
  if (cudaMemGetInfo(&free, &total) != cudaSuccess) return std::numeric_limits<double>::infinity();
  return static_cast<double>(total) / static_cast<double>(std::count(all.begin(), all.end(), mine));
#else
  return std::numeric_limits<double>::infinity();
#endif
}

} // namespace rpc
