// SPDX-License-Identifier: BSD-3-Clause
#include "factor/low_rank_update.hpp"

#include "rpc/solver/rules.hpp"

#include <Teuchos_BLAS.hpp>
#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <type_traits>

namespace rpc::solver
{
namespace
{

constexpr int columns_at_once = 64; // that are solved for together

/// v . x, for x of one column.
double product(const RankOneTerm &term, const double *const x)
{
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    if (term.v[k] != 0) sum += term.v[k] * x[term.first_row + k];
  return sum;
}

void append(const RankOneTerm &term, SparseColumns &columns)
{
  for (int k = 0; k < 3; ++k)
    if (term.v[k] != 0) {
      columns.row.push_back(static_cast<int>(term.first_row) + k);
      columns.value.push_back(term.v[k]);
    }
  columns.begin.push_back(static_cast<int>(columns.row.size()));
}

/// x += factor v.
void add(const RankOneTerm &term, const double factor, double *const x)
{
  for (int k = 0; k < 3; ++k)
    if (term.v[k] != 0) x[term.first_row + k] += factor * term.v[k];
}

/// Whether both are parallel, up to rounding.
bool same_direction(const RankOneTerm &a, const RankOneTerm &b)
{
  double product = 0;
  for (int k = 0; k < 3; ++k) product += a.v[k] * b.v[k];
  return std::abs(std::abs(product) - 1) <= rounding.sum;
}

} // namespace

/// -1: none yet.
int LowRankUpdate::column_of(const RankOneTerm &term) const
{
  const auto [first, last] = columns_at_.equal_range(term.first_row);
  for (auto it = first; it != last; ++it)
    if (same_direction(column_[it->second], term)) return it->second;
  return -1;
}

/// Of these terms, how many have no column yet.
std::size_t LowRankUpdate::num_unknown(const std::vector<RankOneTerm> &terms) const
{
  return std::count_if(terms.begin(), terms.end(), [this](const RankOneTerm &term) { return column_of(term) < 0; });
}

/// Whether there would be more columns than their places have directions.
bool LowRankUpdate::starts_anew(const std::vector<RankOneTerm> &terms) const
{
  std::set<long long> places;
  for (const auto &[first_row, column] : columns_at_) places.insert(first_row);
  for (const RankOneTerm &term : terms) places.insert(term.first_row);
  return column_.size() + num_unknown(terms) > std::extent_v<decltype(RankOneTerm::v)> * places.size();
}

int LowRankUpdate::num_new(const std::vector<RankOneTerm> &terms) const
{
  return static_cast<int>(starts_anew(terms) ? terms.size() : num_unknown(terms));
}

void LowRankUpdate::set(const SparseFactor &factor, const int size, const bool has_vectors,
                        const std::vector<RankOneTerm> &terms, const std::vector<Coupling> &couplings,
                        const double most_kept)
{
  if (starts_anew(terms)) forget();
  size_ = size;
  coupling_ = couplings;
  std::vector<int> made;
  present_.clear();
  scale_.clear();
  for (const RankOneTerm &term : terms) {
    int column = column_of(term);
    if (column < 0) {
      column = static_cast<int>(column_.size());
      made.push_back(column);
      column_.push_back(term);
      columns_at_.emplace(term.first_row, column);
      flexibility_.emplace_back(column + 1);
    }
    present_.push_back(column);
    scale_.push_back(term.scale);
  }
  keeps_ = keeps_ && static_cast<double>(column_.size()) * size <= most_kept;
  if (!keeps_) solved_ = {};
  std::vector<double> x;
  for (std::size_t first = 0; first < made.size(); first += columns_at_once) {
    const int count = static_cast<int>(std::min<std::size_t>(columns_at_once, made.size() - first));
    SparseColumns columns;
    for (int c = 0; c < count; ++c) append(column_[made[first + c]], columns);
    if (!has_vectors) {
      factor.solve(columns, nullptr);
      continue;
    }
    x.resize(static_cast<std::size_t>(size) * count);
    factor.solve(columns, x.data());
    for (int c = 0; c < count; ++c) // symmetric: with those of later columns, later ones bring them
      for (int other = 0; other <= made[first + c]; ++other)
        flexibility_[made[first + c]][other] = product(column_[other], x.data() + static_cast<std::size_t>(c) * size);
    for (int c = 0; keeps_ && c < count; ++c) {
      const auto column = x.begin() + static_cast<std::ptrdiff_t>(c) * size;
      solved_.emplace_back(column, column + size);
    }
  }
  if (!has_vectors) return;
  const int n = static_cast<int>(present_.size());
  matrix_.clear();
  std::vector<double> flexibility(n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i)
      flexibility[i] = flexibility_[std::max(present_[i], present_[j])][std::min(present_[i], present_[j])];
    const std::vector<double> column = times_S(flexibility);
    matrix_.insert(matrix_.end(), column.begin(), column.end());
    matrix_[static_cast<std::size_t>(j) * n + j] += 1;
  }
  pivot_.resize(n);
  int info = 0;
  if (n > 0) Teuchos::LAPACK<int, double>().GETRF(n, n, matrix_.data(), n, pivot_.data(), &info);
  if (info != 0) matrix_.assign(matrix_.size(), std::numeric_limits<double>::quiet_NaN()); // singular: norms will tell
}

std::vector<double> LowRankUpdate::times_S(const std::vector<double> &x) const
{
  std::vector<double> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = scale_[i] * x[i];
  for (const Coupling &c : coupling_) {
    y[c.i] += c.value * x[c.j];
    y[c.j] += c.value * x[c.i];
  }
  return y;
}

void LowRankUpdate::solve(const SparseFactor &factor, double *const x) const
{
  const int n = static_cast<int>(present_.size());
  if (n == 0) return factor.solve(x);
  if (!x) {
    if (!keeps_) factor.solve(nullptr);
    return factor.solve(nullptr);
  }
  std::vector<double> moves(n); // V^T A^-1 x
  if (keeps_) {
    const Teuchos::BLAS<int, double> blas;
    for (int i = 0; i < n; ++i) moves[i] = blas.DOT(size_, solved_[present_[i]].data(), 1, x, 1);
  } else {
    std::vector<double> z(x, x + size_);
    factor.solve(z.data());
    for (int i = 0; i < n; ++i) moves[i] = product(column_[present_[i]], z.data());
  }
  std::vector<double> forces = times_S(moves);
  int info = 0;
  Teuchos::LAPACK<int, double>().GETRS('N', n, 1, matrix_.data(), n, pivot_.data(), forces.data(), n, &info);
  for (int i = 0; i < n; ++i) add(column_[present_[i]], -forces[i], x);
  factor.solve(x);
}

} // namespace rpc::solver
