// SPDX-License-Identifier: BSD-3-Clause
#include "gauss.hpp"

#include <cmath>

namespace rpc::bound
{

double legendre(const int j, const double x)
{
  const double u = 2 * x - 1;
  double before = 0, now = 1;
  for (int n = 0; n < j; ++n) {
    const double next = ((2 * n + 1) * u * now - n * before) / (n + 1);
    before = now;
    now = next;
  }
  return now;
}

Gauss gauss(const int n)
{
  Gauss rule;
  const double pi = std::acos(-1.);
  for (int i = 0; i < n; ++i) {
    double x = 0.5 - 0.5 * std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) { // Newton's method, from a start that leads to the i-th root
      const double u = 2 * x - 1, p = legendre(n, x);
      slope = 2 * n * (u * p - legendre(n - 1, x)) / (u * u - 1); // by x
      const double move = p / slope;
      x -= move;
      if (std::abs(move) < 1e-16) break;
    }
    rule.point.push_back(x);
    rule.weight.push_back(1 / (x * (1 - x) * slope * slope));
  }
  return rule;
}

} // namespace rpc::bound
