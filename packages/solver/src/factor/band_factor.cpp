// SPDX-License-Identifier: BSD-3-Clause
#include "factor/band_factor.hpp"

#include "rpc/core/graph.hpp"
#include "rpc/solver/rules.hpp"

#include <Teuchos_ConfigDefs.hpp>
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <utility>

// LAPACK's band Cholesky, which Teuchos does not wrap.
extern "C" {
void F77_BLAS_MANGLE(dpbtrf, DPBTRF)(const char *half, const int *n, const int *width, double *band, const int *rows,
                                     int *info);
void F77_BLAS_MANGLE(dpbtrs, DPBTRS)(const char *half, const int *n, const int *width, const int *columns,
                                     const double *band, const int *rows, double *b, const int *b_rows, int *info);
}

namespace rpc::solver
{
namespace
{

/// The graph of the matrix: of each row the columns of its entries beside the diagonal.
Lists graph_of(const int size, const SymmetricEntries &entries)
{
  std::vector<std::vector<int>> neighbours(size);
  for (std::size_t e = 0; e < entries.row.size(); ++e) {
    const int i = entries.row[e], j = entries.column[e];
    if (i <= j) continue;
    neighbours[i].push_back(j);
    neighbours[j].push_back(i);
  }
  Lists graph;
  for (auto &list : neighbours) {
    std::sort(list.begin(), list.end());
    graph.value.insert(graph.value.end(), list.begin(), std::unique(list.begin(), list.end()));
    graph.begin.push_back(graph.value.size());
  }
  return graph;
}

constexpr std::size_t above = std::numeric_limits<std::size_t>::max(); // the diagonal: such an entry does not count

} // namespace

std::unique_ptr<BandFactor> BandFactor::in_cuthill_mckee_order(const int size, const SymmetricEntries &entries)
{
  const std::vector<int> order = reverse_cuthill_mckee(graph_of(size, entries));
  std::vector<int> place(size);
  for (int at = 0; at < size; ++at) place[order[at]] = at;
  return std::make_unique<BandFactor>(size, entries, std::move(place));
}

std::unique_ptr<BandFactor> BandFactor::as_numbered(const int size, const SymmetricEntries &entries)
{
  std::vector<int> place(size);
  std::iota(place.begin(), place.end(), 0);
  return std::make_unique<BandFactor>(size, entries, std::move(place));
}

BandFactor::BandFactor(const int size, const SymmetricEntries &entries, std::vector<int> place)
    : size_(size), place_(std::move(place))
{
  for (std::size_t e = 0; e < entries.row.size(); ++e)
    width_ = std::max(width_, std::abs(place_[entries.row[e]] - place_[entries.column[e]]));
  const std::size_t rows = width_ + 1;
  entry_.reserve(entries.row.size());
  for (std::size_t e = 0; e < entries.row.size(); ++e) {
    const int a = place_[entries.row[e]], b = place_[entries.column[e]];
    entry_.push_back(entries.row[e] < entries.column[e] ? above : rows * std::min(a, b) + std::abs(a - b));
  }
}

FactorCost BandFactor::cost_of(const double size, const double width)
{
  const double operation = width > cost_model.wide ? cost_model.wide_band : cost_model.narrow_band;
  FactorCost cost;
  cost.operations = size * width * width;
  cost.entries = size * (width + 1);
  cost.bytes = sizeof(double) * cost.entries;
  cost.seconds = operation * cost.operations + cost_model.band_entry * cost.entries;
  cost.seconds_of_solve = cost.seconds_of_column =
      cost_model.band_row_in_solve * size + cost_model.band_entry_in_solve * cost.entries;
  return cost;
}

bool BandFactor::make(const std::vector<double> &value)
{
  const int rows = width_ + 1;
  factor_.assign(static_cast<std::size_t>(rows) * size_, 0.);
  for (std::size_t e = 0; e < entry_.size(); ++e)
    if (entry_[e] != above) factor_[entry_[e]] += value[e];
  int info = 0;
  F77_BLAS_MANGLE(dpbtrf, DPBTRF)("L", &size_, &width_, factor_.data(), &rows, &info);
  exists_ = info == 0;
  if (!exists_) factor_.clear();
  return exists_;
}

void BandFactor::solve(const SparseColumns &B, double *const x) const
{
  std::fill_n(x, static_cast<std::size_t>(size_) * B.count(), 0.);
  for (int c = 0; c < B.count(); ++c)
    for (int e = B.begin[c]; e < B.begin[c + 1]; ++e) x[static_cast<std::size_t>(c) * size_ + B.row[e]] = B.value[e];
  solve_in_place(x, B.count());
}

void BandFactor::solve_in_place(double *const x, const int columns) const
{
  if (size_ == 0) return; // LAPACK wants a row
  std::vector<double> ordered(static_cast<std::size_t>(size_) * columns);
  for (int c = 0; c < columns; ++c)
    for (int i = 0; i < size_; ++i)
      ordered[static_cast<std::size_t>(c) * size_ + place_[i]] = x[static_cast<std::size_t>(c) * size_ + i];
  const int rows = width_ + 1;
  int info = 0;
  F77_BLAS_MANGLE(dpbtrs, DPBTRS)("L", &size_, &width_, &columns, factor_.data(), &rows, ordered.data(), &size_, &info);
  for (int c = 0; c < columns; ++c)
    for (int i = 0; i < size_; ++i)
      x[static_cast<std::size_t>(c) * size_ + i] = ordered[static_cast<std::size_t>(c) * size_ + place_[i]];
}

} // namespace rpc::solver
