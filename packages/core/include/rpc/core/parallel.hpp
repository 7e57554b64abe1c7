#pragma once

#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc
{

/// What all ranks hold, rank after rank, on every rank; collective.
template <class T>
std::vector<T> gathered_by_all(const Comm &comm, std::vector<T> mine)
{
  if (comm.getSize() == 1) return mine;
  const int size = static_cast<int>(mine.size());
  std::vector<int> sizes(comm.getSize());
  Teuchos::gatherAll(comm, 1, &size, comm.getSize(), sizes.data());
  const int longest = max_all(comm, size);
  std::vector<T> padded(static_cast<std::size_t>(longest) * comm.getSize()), all;
  if (longest == 0) return all;
  mine.resize(longest);
  Teuchos::gatherAll(comm, longest, mine.data(), static_cast<int>(padded.size()), padded.data());
  for (int rank = 0; rank < comm.getSize(); ++rank) {
    const auto from = padded.begin() + static_cast<std::ptrdiff_t>(rank) * longest;
    all.insert(all.end(), from, from + sizes[rank]);
  }
  return all;
}

} // namespace rpc
