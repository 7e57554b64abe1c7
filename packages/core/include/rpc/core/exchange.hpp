#pragma once

#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc
{

/// Questions to other ranks and their answers: rows of numbers go to the ranks that each rank chooses, and rows of another
/// width come back in the same order. A message between two ranks has at most 2^31 bytes.
class Exchange
{
public:
  /// @param counts  (ranks) how many rows go to each rank, this one included; collective
  Exchange(const Comm &comm, std::vector<int> counts);

  int num_sent() const;     ///< rows that this rank sends
  int num_received() const; ///< rows that it gets

  /// @param rows  (sent, width), for rank 0 first
  /// @return (received, width), of rank 0 first; collective
  std::vector<double> forward(const std::vector<double> &rows, int width) const;
  /// @param rows  (received, width)
  /// @return (sent, width), row n that to row n of what was sent; collective
  std::vector<double> back(const std::vector<double> &rows, int width) const;

private:
  std::vector<double> exchange(const std::vector<int> &to, const std::vector<int> &from,
                               const std::vector<double> &rows, int width) const;

  const Comm &comm_;
  std::vector<int> to_, from_;
};

} // namespace rpc
