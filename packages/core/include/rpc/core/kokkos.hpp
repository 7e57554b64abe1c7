// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Kokkos_Core.hpp>
#include <Tpetra_Map_decl.hpp>
#include <type_traits>

/// Execution and memory spaces, ordinals and the one way in which kernels add to shared memory.
namespace rpc
{

using LO = Tpetra::Map<>::local_ordinal_type;  ///< index on one rank
using GO = Tpetra::Map<>::global_ordinal_type; ///< index over all ranks
using Node = Tpetra::Map<>::node_type;
using ExecutionSpace = Node::execution_space; ///< where kernels run
using HostSpace = Kokkos::HostSpace;

/// Kernels run on a GPU, and cannot read the host's memory.
inline constexpr bool on_gpu = !Kokkos::SpaceAccessibility<ExecutionSpace, HostSpace>::accessible;

/// Where this project's views live: beside the kernels. Tpetra 13.2 takes managed memory with CUDA, which the host can read
/// too, page by page and slowly; here that is a crash instead of a slow program. Tpetra's views can be assigned to these.
#ifdef KOKKOS_ENABLE_CUDA
using MemorySpace =
    std::conditional_t<std::is_same_v<Node::memory_space, Kokkos::CudaUVMSpace>, Kokkos::CudaSpace, Node::memory_space>;
#else
using MemorySpace = Node::memory_space;
#endif
using Device = Kokkos::Device<ExecutionSpace, MemorySpace>;

template <class Data>
using DeviceView = Kokkos::View<Data, Device>;
template <class Data>
using HostView = Kokkos::View<Data, Kokkos::HostSpace>;

/// target += value, atomic unless there is but one thread to write (atomics cost Kokkos::Serial half of an assembly).
KOKKOS_INLINE_FUNCTION void add_shared(double &target, const double value)
{
#ifdef KOKKOS_ENABLE_SERIAL
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Serial>)
    target += value;
  else
#endif
    Kokkos::atomic_add(&target, value);
}

/// A device copy of a host view, and a host copy of a device view; both fence.
template <class HostViewType>
auto to_device(const HostViewType &host)
{
  return Kokkos::create_mirror_view_and_copy(Device(), host);
}
template <class DeviceViewType>
auto to_host(const DeviceViewType &device)
{
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), device);
}

/// Range over n items of the device's execution space.
inline auto device_range(const LO n)
{
  return Kokkos::RangePolicy<ExecutionSpace, LO>(0, n);
}

} // namespace rpc
