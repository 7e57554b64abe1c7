// SPDX-License-Identifier: BSD-3-Clause
// A pool under Kokkos' memory on NVIDIA GPUs, which Kokkos 3.4 takes from CUDA and gives back to it view by view. MueLu's and
// Tpetra's views come and go by the thousand; with managed memory each fresh one costs a page fault for every piece that a kernel
// touches first: two thirds of the GPU's time in a set-up of multigrid. Here freed blocks wait for the next view of their size.
//
// The linker leads CUDA's functions here (--wrap) in programs that link rpc::device_pool, see CMakeLists.txt. RPC_DEVICE_POOL=off in the environment leaves all to CUDA, as compute-sanitizer wants it.
#include <Kokkos_Macros.hpp>

#ifdef KOKKOS_ENABLE_CUDA

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <cuda_runtime_api.h>
#include <map>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

extern "C" {
cudaError_t __real_cudaMalloc(void **pointer, std::size_t bytes);
cudaError_t __real_cudaMallocManaged(void **pointer, std::size_t bytes, unsigned flags);
cudaError_t __real_cudaFree(void *pointer);
}

namespace
{

enum class Kind { device, managed };

/// The size that a block of the pool has: at most an eighth more than is asked for.
std::size_t block_size(const std::size_t bytes)
{
  std::size_t step = 256;
  while (8 * step < bytes) step *= 2;
  return (bytes + step - 1) / step * step;
}

/// Brings a fresh managed block to the GPU before kernels touch it; a hint, so that failure does not matter.
void prefetch(void *const pointer, const std::size_t bytes)
{
  constexpr std::size_t least = 1 << 21; // the driver's own granularity
  if (bytes < least) return;
  int device = 0;
  if (cudaGetDevice(&device) != cudaSuccess) return;
#if CUDART_VERSION >= 13000
  cudaMemLocation location;
  location.type = cudaMemLocationTypeDevice;
  location.id = device;
  const cudaError_t error = cudaMemPrefetchAsync(pointer, bytes, location, 0, nullptr);
#else
  const cudaError_t error = cudaMemPrefetchAsync(pointer, bytes, device, nullptr);
#endif
  if (error != cudaSuccess) cudaGetLastError(); // forget it
}

class Pool
{
public:
  cudaError_t allocate(void **const pointer, const std::size_t bytes, const Kind kind, const unsigned flags)
  {
    if (bytes == 0 || is_off()) return from_cuda(pointer, bytes, kind, flags);
    const std::lock_guard<std::mutex> lock(mutex_);
    const Block block{kind, block_size(bytes)};
    auto &waiting = free_[block];
    if (!waiting.empty()) {
      *pointer = waiting.back();
      waiting.pop_back();
      waiting_bytes_ -= block.second;
    } else {
      if (reserved_bytes_ + block.second > limit()) release();
      cudaError_t error = from_cuda(pointer, block.second, kind, flags);
      if (error == cudaErrorMemoryAllocation && waiting_bytes_ > 0) {
        cudaGetLastError();
        release();
        error = from_cuda(pointer, block.second, kind, flags);
      }
      if (error != cudaSuccess) return error;
      reserved_bytes_ += block.second;
      if (kind == Kind::managed) prefetch(*pointer, block.second); // once: 1 ms per GB even where all is there
    }
    used_.emplace(*pointer, block);
    return cudaSuccess;
  }

  cudaError_t free(void *const pointer)
  {
    if (const cudaError_t error = cudaDeviceSynchronize(); error != cudaSuccess) return error; // as cudaFree does
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto at = used_.find(pointer);
    if (at == used_.end()) return __real_cudaFree(pointer); // not from here, or null
    free_[at->second].push_back(pointer);
    waiting_bytes_ += at->second.second;
    used_.erase(at);
    return cudaSuccess;
  }

private:
  using Block = std::pair<Kind, std::size_t>; // and its size

  static bool is_off()
  {
    static const bool off = [] {
      const char *const choice = std::getenv("RPC_DEVICE_POOL");
      return choice && std::strcmp(choice, "off") == 0;
    }();
    return off;
  }

  /// The pool keeps no more than that: managed memory beyond the card's own would be paged in and out.
  static std::size_t limit()
  {
    static const std::size_t limit = [] {
      std::size_t free = 0, total = 0;
      return cudaMemGetInfo(&free, &total) == cudaSuccess ? free - free / 5 : 0;
    }();
    return limit;
  }

  static cudaError_t from_cuda(void **const pointer, const std::size_t bytes, const Kind kind, const unsigned flags)
  {
    return kind == Kind::managed ? __real_cudaMallocManaged(pointer, bytes, flags) : __real_cudaMalloc(pointer, bytes);
  }

  /// Gives all free blocks back to CUDA.
  void release()
  {
    for (auto &[block, waiting] : free_) {
      for (void *const pointer : waiting) {
        __real_cudaFree(pointer);
        reserved_bytes_ -= block.second;
      }
      waiting.clear();
    }
    waiting_bytes_ = 0;
  }

  std::mutex mutex_;
  std::map<Block, std::vector<void *>> free_;
  std::unordered_map<void *, Block> used_;
  std::size_t reserved_bytes_ = 0; // from CUDA, used and free
  std::size_t waiting_bytes_ = 0;  // of these, free
};

/// Never destroyed: views of static storage are freed last.
Pool &pool()
{
  static Pool *const pool = new Pool;
  return *pool;
}

} // namespace

extern "C" {

cudaError_t __wrap_cudaMalloc(void **pointer, std::size_t bytes)
{
  return pool().allocate(pointer, bytes, Kind::device, 0);
}

cudaError_t __wrap_cudaMallocManaged(void **pointer, std::size_t bytes, unsigned flags)
{
  return pool().allocate(pointer, bytes, Kind::managed, flags);
}

cudaError_t __wrap_cudaFree(void *pointer)
{
  return pool().free(pointer);
}
}

#endif
