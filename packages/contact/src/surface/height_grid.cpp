// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/height_grid.hpp"

#include "height_patch.hpp"
#include "rpc/contact/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rpc::contact
{

HeightGrid::HeightGrid(const HeightTable &table, const Interpolation interpolation, const bool periodic)
    : spacing_(table.spacing), interpolation_(interpolation), periodic_(periodic), columns_(table.columns),
      rows_(table.rows)
{
  const int ends = periodic ? 0 : 1;
  cells_ = {columns_ - ends, rows_ == 1 ? 0 : rows_ - ends};
  if (rows_ == 1) spacing_[1] = spacing_[0];
  const int below = rows_ == 1 ? 0 : 1, behind = rows_ == 1 ? 0 : 2, wide = columns_ + 3;
  height_.assign(static_cast<std::size_t>(wide) * (rows_ + below + behind), 0.);
  const auto entry = [&](const int i, const int j) -> double & {
    return height_[static_cast<std::size_t>(j + below) * wide + i + 1];
  };
  /// A value beyond the end of a row by those before it: a parabola's, so that parabolas are met.
  const auto beyond = [](const int n, const auto &nth) {
    return n > 2 ? 3 * nth(0) - 3 * nth(1) + nth(2) : 2 * nth(0) - nth(1);
  };
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) entry(i, j) = table.at(i, j);
    for (const int i : {-1, columns_, columns_ + 1}) {
      if (periodic)
        entry(i, j) = table.at((i + columns_) % columns_, j);
      else if (i < 0)
        entry(i, j) = beyond(columns_, [&](const int k) { return table.at(k, j); });
      else if (i == columns_)
        entry(i, j) = beyond(columns_, [&](const int k) { return table.at(columns_ - 1 - k, j); });
    }
  }
  for (int i = -1; i < columns_ + 2 && rows_ > 1; ++i)
    for (const int j : {-1, rows_, rows_ + 1}) {
      if (periodic)
        entry(i, j) = entry(i, (j + rows_) % rows_);
      else if (j < 0)
        entry(i, j) = beyond(rows_, [&](const int k) { return entry(i, k); });
      else if (j == rows_)
        entry(i, j) = beyond(rows_, [&](const int k) { return entry(i, rows_ - 1 - k); });
    }
  set_levels();
}

double HeightGrid::node(const int i, const int j) const
{
  return height_[static_cast<std::size_t>(j + (is_profile() ? 0 : 1)) * (columns_ + 3) + i + 1];
}

HeightGrid::Patch HeightGrid::patch(const int i, const int j) const
{
  Patch patch;
  if (is_profile()) {
    patch.rows = 1;
    patch.point[0] = bezier_points({node(i - 1, 0), node(i, 0), node(i + 1, 0), node(i + 2, 0)}, interpolation_);
    return patch;
  }
  std::array<std::array<double, 4>, 4> along{}; // (along y, along x)
  for (int b = 0; b < 4; ++b) {
    const int row = j - 1 + b;
    along[b] = bezier_points({node(i - 1, row), node(i, row), node(i + 1, row), node(i + 2, row)}, interpolation_);
  }
  for (int a = 0; a < 4; ++a) {
    const auto column = bezier_points({along[0][a], along[1][a], along[2][a], along[3][a]}, interpolation_);
    for (int b = 0; b < 4; ++b) patch.point[b][a] = column[b];
  }
  return patch;
}

void HeightGrid::set_levels()
{
  Level level{{cells_[0], std::max(cells_[1], 1)}, {}};
  level.range.reserve(static_cast<std::size_t>(level.size[0]) * level.size[1]);
  for (int j = 0; j < level.size[1]; ++j)
    for (int i = 0; i < level.size[0]; ++i) level.range.push_back(patch(i, j).range());
  levels_.push_back(std::move(level));
  while (levels_.back().range.size() > 1) {
    const Level &fine = levels_.back();
    Level coarse{{(fine.size[0] + 1) / 2, (fine.size[1] + 1) / 2}, {}};
    for (int j = 0; j < coarse.size[1]; ++j)
      for (int i = 0; i < coarse.size[0]; ++i) {
        Interval all = nothing_between();
        for (int q = 2 * j; q < std::min(2 * j + 2, fine.size[1]); ++q)
          for (int p = 2 * i; p < std::min(2 * i + 2, fine.size[0]); ++p) all = both(all, fine.at(p, q));
        coarse.range.push_back(all);
      }
    levels_.push_back(std::move(coarse));
  }
}

std::array<double, 2> HeightGrid::extent() const
{
  return {cells_[0] * spacing_[0], cells_[1] * spacing_[1]};
}

bool HeightGrid::covers(const double x, const double y) const
{
  if (periodic_) return true;
  const std::array<double, 2> size = extent(), place{x, y};
  for (int c = 0; c < (is_profile() ? 1 : 2); ++c)
    if (outside(place[c], {0, size[c]}) > Rounding::place * size[c]) return false;
  return true;
}

std::pair<int, double> HeightGrid::cell_of(const double x, const int direction) const
{
  const int n = cells_[direction];
  if (n == 0) return {0, 0.};
  double t = x / spacing_[direction];
  if (periodic_) t -= n * std::floor(t / n);
  const int cell = std::clamp(static_cast<int>(std::floor(t)), 0, n - 1);
  return {cell, std::clamp(t - cell, 0., 1.)};
}

HeightGrid::Value HeightGrid::at(const double x, const double y) const
{
  const auto [i, u] = cell_of(x, 0);
  const auto [j, v] = cell_of(y, 1);
  const Patch::Jet jet = patch(i, j).at(u, v);
  return {jet.height, {jet.u / spacing_[0], jet.v / spacing_[1]}};
}

double HeightGrid::rms_height() const
{
  double mean = 0, sum = 0;
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) mean += node(i, j);
  mean /= static_cast<double>(columns_) * rows_;
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) sum += (node(i, j) - mean) * (node(i, j) - mean);
  return std::sqrt(sum / (static_cast<double>(columns_) * rows_));
}

double HeightGrid::rms_slope() const
{
  double squared = 0;
  for (int c = 0; c < (is_profile() ? 1 : 2); ++c) {
    double sum = 0, count = 0;
    for (int j = 0; j < (c == 1 ? cells_[1] : rows_); ++j)
      for (int i = 0; i < (c == 0 ? cells_[0] : columns_); ++i) {
        const double slope = (node(i + (c == 0 ? 1 : 0), j + (c == 1 ? 1 : 0)) - node(i, j)) / spacing_[c];
        sum += slope * slope;
        ++count;
      }
    squared += sum / count;
  }
  return std::sqrt(squared);
}

} // namespace rpc::contact
