// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace rpc::fem
{

/// Rows of an interpolation that are listed one after another on the host.
class InterpolationRows
{
public:
  /// An entry of the row that is being listed; of weight 0 none. @param column  overlap node of the coarse mesh
  void add(const LO column, const double weight)
  {
    if (weight != 0) row_.emplace_back(column, weight);
  }
  void end_row()
  {
    std::sort(row_.begin(), row_.end());
    for (const auto &[column, weight] : row_) {
      column_.push_back(column);
      value_.push_back(weight);
    }
    row_.clear();
    begin_.push_back(column_.size());
  }
  /// (fine owned nodes x coarse owned nodes) Collective.
  RCP<CrsMatrix> matrix(const RCP<const Map> &rows, const RCP<const Map> &columns, const RCP<const Map> &domain) const
  {
    typename LocalMatrix::row_map_type::non_const_type begins("rpc::fem::interpolation_begin", begin_.size());
    typename LocalMatrix::index_type::non_const_type columns_of("rpc::fem::interpolation_column", column_.size());
    typename LocalMatrix::values_type::non_const_type values("rpc::fem::interpolation_weight", value_.size());
    const auto fill = [](const auto &view, const auto &list) {
      const auto host = Kokkos::create_mirror_view(view);
      std::copy(list.begin(), list.end(), host.data());
      Kokkos::deep_copy(view, host);
    };
    fill(begins, begin_);
    fill(columns_of, column_);
    fill(values, value_);
    const auto matrix = rcp(new CrsMatrix(rows, columns, begins, columns_of, values));
    matrix->fillComplete(domain, rows);
    return matrix;
  }

private:
  using LocalMatrix = CrsMatrix::local_matrix_device_type;
  std::vector<LocalMatrix::row_map_type::non_const_value_type> begin_{0};
  std::vector<LO> column_;
  std::vector<double> value_;
  std::vector<std::pair<LO, double>> row_;
};

} // namespace rpc::fem
