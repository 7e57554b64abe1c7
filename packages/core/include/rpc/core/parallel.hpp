// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <algorithm>
#include <vector>

/// Arrays over all ranks: sums, and gathers on rank 0 or on all ranks. T is a number that Teuchos can send.
namespace rpc
{

/// Calls message(first, count) for each piece of [0, total), for MPI counts the bytes of a message in an int.
template <class Message>
void in_pieces(const std::size_t total, const Message &message)
{
  constexpr std::size_t most = std::size_t(1) << 26; // items; far below 2^31 bytes
  for (std::size_t first = 0; first < total; first += most)
    message(first, static_cast<int>(std::min(most, total - first)));
}

/// Entry by entry the sum over all ranks, on every rank; collective.
/// @param mine  as many entries on every rank
template <class T>
std::vector<T> summed(const Comm &comm, const std::vector<T> &mine)
{
  std::vector<T> all(mine.size());
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), all.data());
  return all;
}

/// The same with maxima.
template <class T>
std::vector<T> largest(const Comm &comm, const std::vector<T> &mine)
{
  std::vector<T> all(mine.size());
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, static_cast<int>(mine.size()), mine.data(), all.data());
  return all;
}

/// Sum over the ranks before this one; collective.
template <class T>
T sum_before(const Comm &comm, const T value)
{
  T sum{};
  Teuchos::scan(comm, Teuchos::REDUCE_SUM, value, Teuchos::outArg(sum));
  return sum - value;
}

/// What all ranks hold, rank after rank, on rank 0; empty elsewhere. No rank's share is bounded by MPI's int counts;
/// collective.
template <class T>
std::vector<T> gathered_by_root(const Comm &comm, const T *const values, const std::size_t count)
{
  const GO mine = static_cast<GO>(count);
  std::vector<GO> counts(comm.getSize());
  Teuchos::gatherAll(comm, 1, &mine, comm.getSize(), counts.data());
  if (comm.getRank() != 0) {
    in_pieces(count, [&](const std::size_t first, const int n) { Teuchos::send(comm, n, values + first, 0); });
    return {};
  }
  GO total = 0;
  for (const GO n : counts) total += n;
  std::vector<T> all(total);
  std::copy(values, values + count, all.begin());
  std::size_t offset = count;
  for (int rank = 1; rank < comm.getSize(); ++rank) {
    in_pieces(counts[rank], [&](const std::size_t first, const int n) {
      Teuchos::receive(comm, rank, n, all.data() + offset + first);
    });
    offset += counts[rank];
  }
  return all;
}
template <class T>
std::vector<T> gathered_by_root(const Comm &comm, const std::vector<T> &mine)
{
  return gathered_by_root(comm, mine.data(), mine.size());
}

/// What all ranks hold, rank after rank, on every rank: for arrays that are small over all ranks. Collective.
template <class T>
std::vector<T> gathered_by_all(const Comm &comm, const std::vector<T> &mine)
{
  std::vector<T> all = gathered_by_root(comm, mine);
  GO total = static_cast<GO>(all.size());
  Teuchos::broadcast(comm, 0, &total);
  all.resize(total);
  in_pieces(total, [&](const std::size_t first, const int n) { Teuchos::broadcast(comm, 0, n, all.data() + first); });
  return all;
}

/// The other way round: entries of an array of rank 0 that each rank asks for; collective.
/// @param values  on rank 0   @param wanted  indices into it, of this rank
template <class T>
std::vector<T> scattered_from_root(const Comm &comm, const std::vector<T> &values, const std::vector<GO> &wanted)
{
  std::vector<T> mine(wanted.size());
  const auto pick = [&values](const std::vector<GO> &indices) {
    std::vector<T> picked(indices.size());
    for (std::size_t k = 0; k < indices.size(); ++k) picked[k] = values[indices[k]];
    return picked;
  };
  const GO count = static_cast<GO>(wanted.size());
  std::vector<GO> counts(comm.getSize());
  Teuchos::gatherAll(comm, 1, &count, comm.getSize(), counts.data());
  if (comm.getRank() != 0) {
    in_pieces(wanted.size(), [&](const std::size_t first, const int n) {
      Teuchos::send(comm, n, wanted.data() + first, 0);
      Teuchos::receive(comm, 0, n, mine.data() + first);
    });
    return mine;
  }
  mine = pick(wanted);
  for (int rank = 1; rank < comm.getSize(); ++rank)
    in_pieces(counts[rank], [&](const std::size_t, const int n) {
      std::vector<GO> indices(n);
      Teuchos::receive(comm, rank, n, indices.data());
      Teuchos::send(comm, n, pick(indices).data(), rank);
    });
  return mine;
}

} // namespace rpc
