// SPDX-License-Identifier: BSD-3-Clause
#include "factor/matrix_changes.hpp"

#include "rpc/algebra/jacobi.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace rpc::solver
{
namespace
{

/// The local matrix on the host, with gids.
class HostMatrix
{
public:
  explicit HostMatrix(const CrsMatrix &A)
      : rows_(*A.getRowMap()), columns_(*A.getColMap()), begin_(to_host(A.getLocalMatrixDevice().graph.row_map)),
        entries_(to_host(A.getLocalMatrixDevice().graph.entries)), values_(to_host(A.getLocalMatrixDevice().values))
  {
  }
  LO num_rows() const { return num_local(rows_); }
  GO row(const LO row) const { return rows_.getGlobalElement(row); }
  GO column(const std::size_t entry) const { return columns_.getGlobalElement(entries_(entry)); }
  std::size_t begin(const LO row) const { return begin_(row); }
  double value(const std::size_t entry) const { return values_(entry); }

private:
  using Local = CrsMatrix::local_matrix_device_type;
  template <class View>
  using OnHost = decltype(to_host(std::declval<View>()));

  const Map &rows_, &columns_;
  OnHost<Local::row_map_type> begin_;
  OnHost<Local::index_type> entries_;
  OnHost<Local::values_type> values_;
};

/// A node's own block before its change, and the change.
template <int Dim>
struct OwnBlock {
  double before[Dim][Dim] = {}, change[Dim][Dim] = {};

  static double largest(const double (&block)[Dim][Dim])
  {
    double most = 0;
    for (const auto &row : block)
      for (const double entry : row) most = std::max(most, std::abs(entry));
    return most;
  }
};

/// Adds the changes of the node with some row as its first one.
template <int Dim>
void add_changes_of(const HostMatrix &A, const HostView<const double *> &before, const LO first, MatrixChanges &changes)
{
  const GO node = A.row(first);
  OwnBlock<Dim> own;
  std::vector<MatrixChanges::Between> others;
  bool is_coupled = false;
  for (int k = 0; k < Dim; ++k)
    for (std::size_t e = A.begin(first + k); e < A.begin(first + k + 1); ++e) {
      const GO column = A.column(e);
      const double change = A.value(e) - before(e);
      if (column >= node && column < node + Dim) {
        own.before[k][column - node] = before(e);
        own.change[k][column - node] = change;
      } else if (change != 0) {
        others.push_back({node + k, column, change});
      }
    }
  const double least = rounding.block * own.largest(own.before), largest = own.largest(own.change);
  for (const auto &entry : others) {
    if (!(std::abs(entry.value) > least)) continue;
    is_coupled = true;
    if (entry.row > entry.column) changes.between.push_back(entry);
  }
  if (is_coupled) {
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l <= k; ++l)
        if (std::abs(own.change[k][l]) > least) changes.between.push_back({node + k, node + l, own.change[k][l]});
    return;
  }
  if (!(largest > least)) return;
  const EigenPairs<Dim> pairs = eigen_pairs(own.change);
  for (int k = 0; k < Dim; ++k) {
    if (!(std::abs(pairs.value[k]) > std::max(least, rounding.block * largest))) continue;
    RankOneTerm term;
    term.first_row = node;
    std::copy(pairs.vector[k], pairs.vector[k] + Dim, term.v);
    term.scale = pairs.value[k];
    changes.at_nodes.push_back({term, largest / own.largest(own.before)});
  }
}

template <int Dim>
MatrixChanges changes_of_rank(const HostView<const double *> &before, const HostMatrix &A)
{
  MatrixChanges changes;
  for (LO first = 0; first < A.num_rows(); first += Dim) {
    std::size_t e = A.begin(first);
    while (e < A.begin(first + Dim) && A.value(e) == before(e)) ++e;
    if (e < A.begin(first + Dim)) add_changes_of<Dim>(A, before, first, changes);
  }
  return changes;
}

MatrixChanges of_all_ranks(const Comm &comm, const MatrixChanges &mine)
{
  if (comm.getSize() == 1) return mine;
  constexpr int numbers = 6, numbers_between = 3; // of a term; of an entry
  std::vector<double> at_nodes, between;
  for (const auto &[term, part] : mine.at_nodes)
    at_nodes.insert(at_nodes.end(),
                    {static_cast<double>(term.first_row), term.v[0], term.v[1], term.v[2], term.scale, part});
  for (const auto &[row, column, value] : mine.between)
    between.insert(between.end(), {static_cast<double>(row), static_cast<double>(column), value});
  at_nodes = gathered_by_all(comm, at_nodes);
  between = gathered_by_all(comm, between);
  MatrixChanges all;
  for (const double *n = at_nodes.data(); n != at_nodes.data() + at_nodes.size(); n += numbers)
    all.at_nodes.push_back({{static_cast<long long>(n[0]), {n[1], n[2], n[3]}, n[4]}, n[5]});
  for (const double *n = between.data(); n != between.data() + between.size(); n += numbers_between)
    all.between.push_back({static_cast<long long>(n[0]), static_cast<long long>(n[1]), n[2]});
  return all;
}

} // namespace

MatrixChanges changes_since(const HostView<const double *> &before, const CrsMatrix &A, const int dofs_per_node)
{
  const HostMatrix now(A);
  const Comm &comm = *A.getComm();
  if (dofs_per_node == 1) return of_all_ranks(comm, changes_of_rank<1>(before, now));
  return of_all_ranks(comm, dofs_per_node == 2 ? changes_of_rank<2>(before, now) : changes_of_rank<3>(before, now));
}

LowRankTerms low_rank_terms(const MatrixChanges &changes, const double least_part, const int dofs_per_node)
{
  LowRankTerms result;
  for (const auto &[term, part] : changes.at_nodes)
    if (part > least_part) result.terms.push_back(term);
  std::map<long long, int> place; // of the terms that are single unknowns
  const auto place_of = [&](const long long row) {
    const auto [at, is_new] = place.emplace(row, static_cast<int>(result.terms.size()));
    if (is_new) {
      RankOneTerm term;
      const int component = static_cast<int>(row % dofs_per_node);
      term.first_row = row - component;
      term.v[component] = 1;
      result.terms.push_back(term);
    }
    return at->second;
  };
  for (const auto &[row, column, value] : changes.between) {
    const int i = place_of(row), j = place_of(column);
    if (i == j)
      result.terms[i].scale = value;
    else
      result.couplings.push_back({i, j, value});
  }
  return result;
}

} // namespace rpc::solver
