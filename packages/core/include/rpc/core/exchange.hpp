// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <utility>
#include <vector>

namespace rpc
{

/// Questions to other ranks and their answers: rows of numbers go to the ranks that each rank chooses, and rows of another
/// width come back in the same order. Only ranks that have rows for each other send messages. A message between two ranks has at
/// most 2^31 bytes.
class Exchange
{
public:
  /// @param counts  (ranks) how many rows go to each rank, this one included; collective
  Exchange(const Comm &comm, const std::vector<int> &counts);

  int num_sent() const;     ///< rows that this rank sends
  int num_received() const; ///< rows that it gets
  /// Ranks that it gets rows from, ascending, and how many.
  std::vector<std::pair<int, int>> senders() const;

  /// @param rows  (sent, width), for rank 0 first
  /// @return (received, width), of rank 0 first; collective
  std::vector<double> forward(const std::vector<double> &rows, int width) const;
  /// @param rows  (received, width)
  /// @return (sent, width), row n answers row n that was sent; collective
  std::vector<double> back(const std::vector<double> &rows, int width) const;

private:
  /// Rows that go to a rank, or come from it; > 0.
  struct Share {
    int rank, count;
  };
  using Shares = std::vector<Share>; // ascending ranks

  static Shares received_by(const Comm &comm, const Shares &sent);
  static int total(const Shares &shares);
  std::vector<double> exchange(const Shares &to, const Shares &from, const std::vector<double> &rows, int width) const;

  const Comm &comm_;
  Shares to_, from_;
};

} // namespace rpc
