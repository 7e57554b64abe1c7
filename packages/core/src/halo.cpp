// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/halo.hpp"

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/exchange.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Distributor.hpp>
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>

#ifdef HAVE_TPETRACORE_MPI
#include <mpi.h>
#ifdef OPEN_MPI
#include <mpi-ext.h>
#endif
#endif

namespace rpc
{
namespace
{

constexpr int tag = 3; // of messages

/// Memory that kernels write and MPI reads.
std::shared_ptr<double> message_buffer(const std::size_t size)
{
  if (size == 0) return nullptr;
  const std::size_t bytes = sizeof(double) * size;
#ifdef KOKKOS_ENABLE_CUDA
  if constexpr (on_gpu) {
    if (!mpi_reads_gpu())
      return {static_cast<double *>(Kokkos::kokkos_malloc<Kokkos::CudaHostPinnedSpace>("rpc::core::message", bytes)),
              [](double *const p) { Kokkos::kokkos_free<Kokkos::CudaHostPinnedSpace>(p); }};
  }
#endif
  return {static_cast<double *>(Kokkos::kokkos_malloc<MemorySpace>("rpc::core::message", bytes)),
          [](double *const p) { Kokkos::kokkos_free<MemorySpace>(p); }};
}

/// buffer <- x at some nodes.
void pack(const DeviceView<LO *> &node, const int width, const Vector &x, double *const buffer)
{
  const auto from = device_read(x);
  Kokkos::parallel_for(
      "rpc::core::pack", device_range(num_dofs(width, static_cast<LO>(node.extent(0)))),
      KOKKOS_LAMBDA(const LO i) { buffer[i] = from(dof(width, node(node_of(width, i)), component_of(width, i))); });
}

/// x at some nodes <- buffer.
void unpack(const double *const buffer, const DeviceView<LO *> &node, const int width, Vector &x)
{
  const auto to = device_write(x);
  Kokkos::parallel_for(
      "rpc::core::unpack", device_range(num_dofs(width, static_cast<LO>(node.extent(0)))),
      KOKKOS_LAMBDA(const LO i) { to(dof(width, node(node_of(width, i)), component_of(width, i))) = buffer[i]; });
}

/// x at some nodes, each of them once, += buffer.
/// @param first, count  a part of the nodes and of the buffer
void add(const double *const buffer, const DeviceView<LO *> &node, const LO first, const LO count, const int width,
         Vector &x)
{
  const auto to = device_write(x);
  Kokkos::parallel_for(
      "rpc::core::add_received",
      Kokkos::RangePolicy<ExecutionSpace, LO>(num_dofs(width, first), num_dofs(width, first + count)),
      KOKKOS_LAMBDA(const LO i) { to(dof(width, node(node_of(width, i)), component_of(width, i))) += buffer[i]; });
}

/// to(i) <- from(i) for the first unknowns.
void copy_first(const LO size, const Vector &from_vector, Vector &to_vector)
{
  const auto from = device_read(from_vector);
  const auto to = device_write(to_vector);
  Kokkos::parallel_for(
      "rpc::core::copy_own", device_range(size), KOKKOS_LAMBDA(const LO i) { to(i) = from(i); });
}

/// to at some nodes <- from at others.
void move(const DeviceView<LO *> &node, const DeviceView<LO *> &to_node, const int width, const Vector &from_vector,
          Vector &to_vector)
{
  if (node.extent(0) == 0) return;
  const auto from = device_read(from_vector);
  const auto to = device_write(to_vector);
  Kokkos::parallel_for(
      "rpc::core::move_own", device_range(num_dofs(width, static_cast<LO>(node.extent(0)))), KOKKOS_LAMBDA(const LO i) {
        const LO n = node_of(width, i);
        const int k = component_of(width, i);
        to(dof(width, to_node(n), k)) = from(dof(width, node(n), k));
      });
}

DeviceView<LO *> listed(const Teuchos::ArrayView<const LO> &nodes)
{
  return device_values(std::vector<LO>(nodes.begin(), nodes.end()), "rpc::core::halo");
}

} // namespace

bool mpi_reads_gpu()
{
  static const bool reads = [] {
    if (const char *const choice = std::getenv("RPC_CUDA_AWARE_MPI")) return std::strcmp(choice, "yes") == 0;
#if defined(MPIX_CUDA_AWARE_SUPPORT) && defined(KOKKOS_ENABLE_CUDA)
    return MPIX_Query_cuda_support() == 1;
#else
    return false;
#endif
  }();
  return reads;
}

Halo::Halo(const RCP<const Import> &importer, const int width) : width_(width)
{
  if (importer.is_null()) return;
  comm_ = importer->getSourceMap()->getComm();
  num_owned_ = num_local(*importer->getSourceMap());
  num_columns_ = num_local(*importer->getTargetMap());
  num_same_ = static_cast<LO>(importer->getNumSameIDs());
  if (!on_any(num_same_ < num_owned_ || num_same_ < num_columns_)) return;
  moved_ = listed(importer->getPermuteFromLIDs());
  moved_to_ = listed(importer->getPermuteToLIDs());
  const auto node = importer->getExportLIDs();
  const auto rank = importer->getExportPIDs();
  std::vector<int> order(node.size()); // the receiver has the nodes in this one
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](const int a, const int b) { return rank[a] < rank[b]; });
  std::vector<LO> sent;
  for (const int k : order) {
    add_to(to_, rank[k]);
    sent.push_back(node[k]);
  }
  sent_ = device_values(sent, "rpc::core::halo");
  received_ = listed(importer->getRemoteLIDs());
  const auto sources = importer->getDistributor().getProcsFrom();
  const auto counts = importer->getDistributor().getLengthsFrom();
  for (Teuchos_Ordinal k = 0; k < sources.size(); ++k)
    if (counts[k] > 0) from_.push_back({sources[k], total(from_), static_cast<LO>(counts[k])});
  allocate();
}

Halo::Halo(const RCP<const Map> &owned, const std::vector<GO> &ghosts)
{
  const Comm &comm = *owned->getComm();
  if (comm.getSize() == 1) return;
  comm_ = owned->getComm();
  num_owned_ = num_same_ = num_local(*owned);
  num_columns_ = num_owned_ + static_cast<LO>(ghosts.size());
  if (!on_any(!ghosts.empty())) return;
  std::vector<int> rank(ghosts.size()), lid(ghosts.size());
  const auto size = static_cast<Teuchos_Ordinal>(ghosts.size());
  owned->getRemoteIndexList(Teuchos::ArrayView<const GO>(ghosts.data(), size),
                            Teuchos::ArrayView<int>(rank.data(), size), Teuchos::ArrayView<int>(lid.data(), size));
  std::vector<int> order(ghosts.size()), counts(comm.getSize());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](const int a, const int b) { return rank[a] < rank[b]; });
  std::vector<LO> received;
  std::vector<double> wanted; // nodes of their owners
  for (const int k : order) {
    add_to(from_, rank[k]);
    ++counts[rank[k]];
    received.push_back(num_owned_ + k);
    wanted.push_back(lid[k]);
  }
  const Exchange exchange(comm, counts);
  std::vector<LO> sent;
  for (const double node : exchange.forward(wanted, 1)) sent.push_back(static_cast<LO>(node));
  for (const auto &[sender, count] : exchange.senders()) to_.push_back({sender, total(to_), count});
  sent_ = device_values(sent, "rpc::core::halo");
  received_ = device_values(received, "rpc::core::halo");
  allocate();
}

Halo::Halo(const Halo &nodes, const int width) : Halo(nodes)
{
  width_ = width;
  columns_ = Teuchos::null;
  allocate();
}

/// Whether columns differ from the owned nodes on any rank; if not, the halo is empty. Collective.
bool Halo::on_any(const bool here)
{
  const bool any = max_all(*comm_, here ? 1 : 0) == 1;
  if (!any) comm_ = Teuchos::null;
  return any;
}

void Halo::add_to(Shares &shares, const int rank)
{
  if (shares.empty() || shares.back().rank != rank) shares.push_back({rank, total(shares), 0});
  ++shares.back().count;
}

void Halo::allocate()
{
  at_owners_ = message_buffer(static_cast<std::size_t>(width_) * total(to_));
  at_others_ = message_buffer(static_cast<std::size_t>(width_) * total(from_));
}

Vector &Halo::columns() const
{
  if (columns_.is_null()) {
    const LO size = num_dofs(width_, num_columns_);
    columns_ = rcp(new Vector(rcp(new Map(size, 0, rcp(new Teuchos::SerialComm<int>)))));
  }
  return *columns_;
}

/// Starts to send and to receive; kernels that write what is sent, and those that read what came before, end first.
Halo::Requests Halo::start(const Shares &to, const double *const sent, const Shares &from, double *const received) const
{
  Kokkos::fence();
  const Comm &comm = *comm_;
  const auto at = [this](const Share &share) { return static_cast<std::ptrdiff_t>(width_) * share.first; };
  Requests requests;
  for (const Share &share : from)
    requests.push_back(Teuchos::ireceive(
        Teuchos::ArrayRCP<double>(received + at(share), 0, width_ * share.count, false), share.rank, tag, comm));
  for (const Share &share : to)
    requests.push_back(Teuchos::isend(Teuchos::ArrayRCP<const double>(sent + at(share), 0, width_ * share.count, false),
                                      share.rank, tag, comm));
  return requests;
}

void Halo::wait(Requests requests) const
{
  Teuchos::waitAll(*comm_, Teuchos::ArrayView<Requests::value_type>(requests));
}

const Vector &Halo::at_columns(const Vector &x) const
{
  if (is_empty()) return x;
  pack(sent_, width_, x, at_owners_.get());
  const Requests requests = start(to_, at_owners_.get(), from_, at_others_.get());
  Vector &to = columns();
  copy_first(num_dofs(width_, num_same_), x, to);
  move(moved_, moved_to_, width_, x, to);
  wait(requests);
  unpack(at_others_.get(), received_, width_, to);
  return to;
}

void Halo::sum_at_owners(Vector &y) const
{
  const Vector &from = columns();
  pack(received_, width_, from, at_others_.get());
  const Requests requests = start(from_, at_others_.get(), to_, at_owners_.get());
  if (num_same_ + static_cast<LO>(moved_.extent(0)) < num_owned_) y.putScalar(0);
  copy_first(num_dofs(width_, num_same_), from, y);
  move(moved_to_, moved_, width_, from, y);
  wait(requests);
  for (const Share &share : to_) add(at_owners_.get(), sent_, share.first, share.count, width_, y);
}

} // namespace rpc
