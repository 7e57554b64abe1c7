// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/exchange.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace rpc::mesh
{

/// Questions to other ranks, in any order: rows of numbers, each to its rank, and rows that answer them.
class Routed
{
public:
  /// @param rank  (rows) whom each asks; collective
  Routed(const Comm &comm, const std::vector<int> &rank)
      : order_(sorted(rank)), exchange_(comm, counts(rank, comm.getSize()))
  {
  }
  int num_received() const { return exchange_.num_received(); }
  /// @param rows  (rows, width)   @return (received, width); collective
  std::vector<double> forward(const std::vector<double> &rows, const int width) const
  {
    std::vector<double> by_rank(rows.size());
    for (std::size_t k = 0; k < order_.size(); ++k)
      std::copy_n(rows.begin() + std::ptrdiff_t(width) * order_[k], width, by_rank.begin() + std::ptrdiff_t(width) * k);
    return exchange_.forward(by_rank, width);
  }
  /// @param answers  (received, width)   @return (rows, width), row n answers row n; collective
  std::vector<double> back(const std::vector<double> &answers, const int width) const
  {
    const std::vector<double> by_rank = exchange_.back(answers, width);
    std::vector<double> rows(by_rank.size());
    for (std::size_t k = 0; k < order_.size(); ++k)
      std::copy_n(by_rank.begin() + std::ptrdiff_t(width) * k, width, rows.begin() + std::ptrdiff_t(width) * order_[k]);
    return rows;
  }

private:
  static std::vector<int> sorted(const std::vector<int> &rank)
  {
    std::vector<int> order(rank.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](const int a, const int b) { return rank[a] < rank[b]; });
    return order;
  }
  static std::vector<int> counts(const std::vector<int> &rank, const int num_ranks)
  {
    std::vector<int> count(num_ranks, 0);
    for (const int r : rank) ++count[r];
    return count;
  }

  std::vector<int> order_; // rows by rank
  Exchange exchange_;
};

} // namespace rpc::mesh
