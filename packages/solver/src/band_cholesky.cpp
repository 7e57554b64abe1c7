#include "band_cholesky.hpp"

#include "rpc/core/graph.hpp"

#include <Teuchos_ConfigDefs.hpp>
#include <algorithm>
#include <cstdlib>

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

} // namespace

std::optional<BandCholesky> BandCholesky::factor(const int size, const SymmetricEntries &entries,
                                                 const double most_work)
{
  BandCholesky result;
  result.size_ = size;
  const std::vector<int> order = reverse_cuthill_mckee(graph_of(size, entries));
  result.place_.resize(size);
  for (int at = 0; at < size; ++at) result.place_[order[at]] = at;
  const auto &place = result.place_;
  int &width = result.width_;
  for (std::size_t e = 0; e < entries.row.size(); ++e)
    width = std::max(width, std::abs(place[entries.row[e]] - place[entries.column[e]]));
  if (static_cast<double>(size) * width * width > most_work) return std::nullopt;

  const int rows = width + 1;
  result.factor_.assign(static_cast<std::size_t>(rows) * size, 0.);
  for (std::size_t e = 0; e < entries.row.size(); ++e) {
    if (entries.row[e] < entries.column[e]) continue;
    const int a = place[entries.row[e]], b = place[entries.column[e]];
    result.factor_[static_cast<std::size_t>(rows) * std::min(a, b) + std::abs(a - b)] += entries.value[e];
  }
  int info = 0;
  F77_BLAS_MANGLE(dpbtrf, DPBTRF)("L", &size, &width, result.factor_.data(), &rows, &info);
  if (info != 0) return std::nullopt;
  return result;
}

void BandCholesky::solve(double *const x) const
{
  std::vector<double> ordered(size_);
  for (int i = 0; i < size_; ++i) ordered[place_[i]] = x[i];
  const int rows = width_ + 1, one = 1;
  int info = 0;
  F77_BLAS_MANGLE(dpbtrs, DPBTRS)("L", &size_, &width_, &one, factor_.data(), &rows, ordered.data(), &size_, &info);
  for (int i = 0; i < size_; ++i) x[i] = ordered[place_[i]];
}

} // namespace rpc::solver
