// SPDX-License-Identifier: BSD-3-Clause
#include "gpu.hpp"

#include "rpc/core/gpu_memory.hpp"
#include "rpc/core/halo.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cstdlib>

#ifdef KOKKOS_ENABLE_CUDA
#include <cuda_runtime_api.h>
#include <fcntl.h>
#include <unistd.h>
#endif
#ifdef HAVE_TPETRACORE_MPI
#include <mpi.h>
#endif

namespace rpc
{
namespace
{

#ifdef KOKKOS_ENABLE_CUDA

bool chosen_by_user(const std::vector<char *> &given)
{
  for (const char *const name : {"KOKKOS_DEVICE_ID", "KOKKOS_NUM_DEVICES"})
    if (std::getenv(name)) return true;
  return std::any_of(given.begin() + 1, given.end(), [](const char *const option) {
    const std::string text = option ? option : "";
    return text.find("device") != std::string::npos; // --kokkos-device-id, --kokkos-num-devices and their short forms
  });
}

int rank_on_host()
{
  int rank = 0;
#ifdef HAVE_TPETRACORE_MPI
  MPI_Comm host;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host);
  MPI_Comm_rank(host, &rank);
  MPI_Comm_free(&host);
#endif
  return rank;
}

/// GPUs whose devices this process may open: a batch system may keep others from it.
int gpus_of_host()
{
  int count = 0;
  constexpr int most = 64;
  for (int gpu = 0; gpu < most; ++gpu)
    if (::access(("/dev/nvidia" + std::to_string(gpu)).c_str(), F_OK) == 0) {
      const int device = ::open(("/dev/nvidia" + std::to_string(gpu)).c_str(), O_RDWR | O_CLOEXEC);
      if (device < 0) return 0; // which of them CUDA would number how is not known
      ::close(device);
      ++count;
    }
  return count;
}

/// Leaves CUDA the rank's own GPU alone: it takes a fifth of a second for each that it sees. Not where MPI reads the GPUs' memory, for
/// it may go from one to the other.
/// @return whether CUDA sees no other now
bool hide_other_gpus(const int rank)
{
  if (std::getenv("CUDA_VISIBLE_DEVICES") || mpi_reads_gpu()) return false;
  const int gpus = gpus_of_host();
  if (gpus < 2) return false;
  setenv("CUDA_VISIBLE_DEVICES", std::to_string(rank % gpus).c_str(), 0);
  int seen = 0;
  return cudaGetDeviceCount(&seen) == cudaSuccess && seen == 1;
}

#endif

} // namespace

std::string gpu_option([[maybe_unused]] const std::vector<char *> &given)
{
#ifdef KOKKOS_ENABLE_CUDA
  int gpus = 0;
  const int rank = rank_on_host(); // collective
  if (chosen_by_user(given)) return {};
  if (hide_other_gpus(rank)) return "--kokkos-device-id=0";
  if (cudaGetDeviceCount(&gpus) != cudaSuccess || gpus == 0) return {};
  return "--kokkos-device-id=" + std::to_string(rank % gpus);
#else
  return {};
#endif
}

std::string gpu_text(const std::string &name, const int ranks, const int gpus, const bool direct)
{
  std::string text = (gpus > 1 ? std::to_string(gpus) + " x " : "") + name;
  if (ranks == 1) return text;
  if (ranks == gpus)
    text += ", a rank each";
  else
    text += ", shared by " + std::to_string(ranks) + " ranks: they take turns unless CUDA's MPS runs";
  return text + "; messages " + (direct ? "from the GPUs' memory" : "through pinned memory of the host");
}

std::string gpu_report([[maybe_unused]] const Comm &comm)
{
#ifdef KOKKOS_ENABLE_CUDA
  int device = 0;
  cudaDeviceProp gpu{};
  cudaGetDevice(&device);
  cudaGetDeviceProperties(&gpu, device);
  std::vector<GO> all = gathered_by_all(comm, std::vector<GO>{gpu_identity()});
  const int ranks = comm.getSize();
  std::sort(all.begin(), all.end());
  const int gpus = static_cast<int>(std::unique(all.begin(), all.end()) - all.begin());
  return gpu_text(gpu.name, ranks, gpus, mpi_reads_gpu());
#else
  return {};
#endif
}

} // namespace rpc
