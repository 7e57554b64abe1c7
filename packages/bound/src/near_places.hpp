// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/point.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace rpc::bound
{

/// Numbers at places of nodes.
class NearPlaces
{
public:
  /// @param near  how near places are the same [m]
  explicit NearPlaces(const double near) : near_(near) {}

  void add(const Point &place, const double value) { all_.insert({key_of(place), {place, value}}); }
  bool empty() const { return all_.empty(); }
  bool has(const Point &x) const { return find(x) != all_.end(); }
  /// 0 where there is no place.
  double value_at(const Point &x) const
  {
    const auto found = find(x);
    return found == all_.end() ? 0 : found->second.second;
  }

private:
  using Places = std::multimap<double, std::pair<Point, double>>; // by a number that tells most places apart

  static double key_of(const Point &x) { return 0.60 * x[0] + 0.53 * x[1] + 0.47 * x[2]; }
  Places::const_iterator find(const Point &x) const
  {
    const double key = key_of(x);
    for (auto it = all_.lower_bound(key - 2 * near_); it != all_.end() && it->first <= key + 2 * near_; ++it) {
      const Point &place = it->second.first;
      if (std::abs(x[0] - place[0]) + std::abs(x[1] - place[1]) + std::abs(x[2] - place[2]) <= near_) return it;
    }
    return all_.end();
  }

  double near_;
  Places all_;
};

} // namespace rpc::bound
