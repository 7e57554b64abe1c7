// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc
{
namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

Bounds Bounds::empty()
{
  return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}

void Bounds::add(const Point &x)
{
  add({x, x});
}

void Bounds::add(const Bounds &other)
{
  for (int c = 0; c < 3; ++c) {
    lower[c] = std::min(lower[c], other.lower[c]);
    upper[c] = std::max(upper[c], other.upper[c]);
  }
}

int Bounds::longest() const
{
  int axis = 0;
  for (int c = 1; c < 3; ++c)
    if (upper[c] - lower[c] > upper[axis] - lower[axis]) axis = c;
  return axis;
}

double Bounds::nearest(const Point &x) const
{
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double out = std::max({lower[c] - x[c], x[c] - upper[c], 0.});
    sum += out * out;
  }
  return sum;
}

double Bounds::farthest(const Point &x) const
{
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double out = std::max(std::abs(lower[c] - x[c]), std::abs(x[c] - upper[c]));
    sum += out * out;
  }
  return sum;
}

bool Bounds::meets_line(const Point &x, const Point &direction) const
{
  double from = -infinity, to = infinity;
  for (int c = 0; c < 3; ++c) {
    const double low = lower[c] - x[c], high = upper[c] - x[c];
    if (std::abs(direction[c]) < std::numeric_limits<double>::min()) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low / direction[c], b = high / direction[c];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

} // namespace rpc
