// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <memory>
#include <vector>

namespace rpc
{

/// Whether MPI takes messages from a GPU's memory: Open MPI says so itself; RPC_CUDA_AWARE_MPI=yes or no in the environment overrules it.
bool mpi_reads_gpu();

/// A vector's entries at columns that other ranks own: what an Import does, for the vectors of a Krylov iteration.
///
/// Kernels write what leaves this rank into one buffer and read what arrives from another one, so that no managed memory changes
/// sides; each neighbour gets one message. The buffers are the GPU's where MPI reads it, else the host's pinned memory. Whoever makes one
/// keeps it: buffers and columns stay. One thread at a time.
class Halo
{
public:
  /// Collective.
  /// @param importer  from the nodes that this rank owns to its columns; null: these are the same
  /// @param width     consecutive unknowns of a node
  explicit Halo(const RCP<const Import> &importer = {}, int width = 1);
  /// The same where the columns are the owned nodes and, after them, some of other ranks; collective. In one process there are none.
  /// @param owned   contiguous   @param ghosts  their gids, each once
  Halo(const RCP<const Map> &owned, const std::vector<GO> &ghosts);
  /// The same for unknowns at the nodes of another halo.
  Halo(const Halo &nodes, int width);

  bool is_empty() const { return comm_.is_null(); }
  /// Messages that this rank sends, and their numbers in all.
  int num_messages() const { return static_cast<int>(to_.size()); }
  std::size_t num_sent() const { return static_cast<std::size_t>(width_) * sent_.extent(0); }

  /// What x is at the columns: x itself where these are its own, else a vector that the next call overwrites; collective.
  const Vector &at_columns(const Vector &x) const;
  /// A vector to add to at the columns, for sum_at_owners(); its values are anything. Not for an empty halo.
  Vector &columns() const;
  /// y <- what columns() holds at y's own entries and, added, what other ranks' hold there; collective. The order of the sums is always
  /// the same.
  void sum_at_owners(Vector &y) const;

private:
  /// Entries that go to a rank, or come from it.
  struct Share {
    int rank;
    LO first, count; // in a list of nodes
  };
  using Shares = std::vector<Share>;
  using Requests = std::vector<RCP<Teuchos::CommRequest<int>>>;

  bool on_any(bool here);
  void allocate();
  static void add_to(Shares &shares, int rank);
  static LO total(const Shares &shares) { return shares.empty() ? 0 : shares.back().first + shares.back().count; }
  Requests start(const Shares &to, const double *sent, const Shares &from, double *received) const;
  void wait(Requests requests) const;

  RCP<const Comm> comm_; // null: of nothing
  int width_ = 1;
  LO num_owned_ = 0, num_columns_ = 0; // nodes
  LO num_same_ = 0;                    // first columns that are the first owned nodes
  DeviceView<LO *> moved_, moved_to_;  // further owned nodes and their columns
  DeviceView<LO *> sent_, received_;   // owned nodes and columns, rank by rank
  Shares to_, from_;                   // ascending ranks
  std::shared_ptr<double> at_owners_;  // buffer: entries of sent_
  std::shared_ptr<double> at_others_;  // buffer: entries of received_
  mutable RCP<Vector> columns_;        // on a map of this rank alone, made when it is needed
};

} // namespace rpc
