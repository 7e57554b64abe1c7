// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace rpc::bound
{

inline double inner_of(const std::vector<double> &x, const std::vector<double> &y)
{
  double parts[4] = {}; // no addition waits for another one
  const std::size_t n = x.size(), whole = n - n % 4;
  for (std::size_t i = 0; i < whole; i += 4)
    for (int k = 0; k < 4; ++k) parts[k] += x[i + k] * y[i + k];
  for (std::size_t i = whole; i < n; ++i) parts[0] += x[i] * y[i];
  return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

/// The least of a quadratic function x . H x/2 - f . x between bounds: conjugate gradients on the face, with steps that leave it (Dostal, SIAM
/// J. Optim. 7, 1997), which are cut off at the bounds (Kruzik et al., Adv. Eng. Softw. 2020). It ends near rounding: a bound changes in proportion
/// to what is left, which would show between one rank and two. What steps have made of the gradient drifts from it, which shows where H has large
/// eigenvalues beside small ones; then it goes on from the gradient.
/// @param fit  has apply(x, y), y <- H x; gradient(x, y), y <- H x - f, where that is small accurately; right_side(), f; start(); low() and high();
/// scale(), which makes about 1 of the diagonal
template <class Fit>
std::vector<double> least_in_box(Fit &fit)
{
  // Squares of what may be left of the gradient, over that of f, over what was left at a look, and over the first one; all scaled.
  constexpr double enough = 1e-26, enough_after_look = 1e-10, enough_of_first = 1e-26;
  const std::vector<double> &scale = fit.scale();
  const std::size_t n = scale.size();
  std::vector<double> x(n), g(n), y(n), Hy(n), free(n), chopped(n), scaled(n), lower(n), upper(n), old_x(n), old_g(n);
  const auto apply = [&](const std::vector<double> &from, std::vector<double> &to) {
    for (std::size_t i = 0; i < n; ++i) scaled[i] = scale[i] * from[i];
    fit.apply(scaled, to);
    for (std::size_t i = 0; i < n; ++i) to[i] *= scale[i];
  };
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = fit.start()[i] / scale[i];
    lower[i] = fit.low()[i] / scale[i];
    upper[i] = fit.high()[i] / scale[i];
  }
  const auto look = [&] {
    for (std::size_t i = 0; i < n; ++i) scaled[i] = scale[i] * x[i];
    fit.gradient(scaled, g);
    for (std::size_t i = 0; i < n; ++i) g[i] *= scale[i];
  };
  look();
  double wanted = 0, first = 0,
         before = std::numeric_limits<double>::infinity(); // squares: what may be left, what was left at a look
  for (std::size_t i = 0; i < n; ++i) wanted += enough * std::pow(scale[i] * fit.right_side()[i], 2);
  bool restart = true, looked = true;
  for (int step = 0; step < 3000; ++step) {
    for (std::size_t i = 0; i < n; ++i) {
      const bool low = x[i] <= lower[i], high = x[i] >= upper[i];
      free[i] = low || high ? 0 : g[i];
      chopped[i] = low && high ? 0 : (low ? std::min(g[i], 0.) : (high ? std::max(g[i], 0.) : 0.));
    }
    const double ff = inner_of(free, free), cc = inner_of(chopped, chopped);
    if (looked) {
      if (ff + cc >= before / 4 || ff + cc <= enough_of_first * first) break;
      if (before < std::numeric_limits<double>::infinity())
        wanted = std::max(enough_after_look * (ff + cc), enough_of_first * first / 4);
      else
        first = ff + cc;
      before = ff + cc;
      looked = false;
    } else if (ff + cc <= wanted) {
      look();
      restart = looked = true;
      continue;
    }
    if (cc > ff) { // leave bounds
      apply(chopped, Hy);
      double most = inner_of(chopped, g) / inner_of(chopped, Hy);
      for (std::size_t i = 0; i < n; ++i) {
        if (chopped[i] > 0) most = std::min(most, (x[i] - lower[i]) / chopped[i]);
        if (chopped[i] < 0) most = std::min(most, (x[i] - upper[i]) / chopped[i]);
      }
      for (std::size_t i = 0; i < n; ++i) {
        x[i] = std::clamp(x[i] - most * chopped[i], lower[i], upper[i]);
        g[i] -= most * Hy[i];
      }
      restart = true;
      continue;
    }
    if (restart) y = free;
    restart = false;
    apply(y, Hy);
    const double curvature = inner_of(y, Hy), length = inner_of(g, y) / curvature;
    bool within = true;
    for (std::size_t i = 0; i < n; ++i)
      within = within && x[i] - length * y[i] >= lower[i] && x[i] - length * y[i] <= upper[i];
    if (within) {
      for (std::size_t i = 0; i < n; ++i) {
        x[i] -= length * y[i];
        g[i] -= length * Hy[i];
        free[i] = x[i] > lower[i] && x[i] < upper[i] ? g[i] : 0;
      }
      const double beta = inner_of(free, Hy) / curvature;
      for (std::size_t i = 0; i < n; ++i) y[i] = free[i] - beta * y[i];
      continue;
    }
    // The whole step, cut off at the bounds; where the function rises by that, the part of the step that stays within.
    double most = length;
    for (std::size_t i = 0; i < n; ++i) {
      if (y[i] > 0) most = std::min(most, (x[i] - lower[i]) / y[i]);
      if (y[i] < 0) most = std::min(most, (x[i] - upper[i]) / y[i]);
    }
    old_x = x;
    old_g = g;
    for (std::size_t i = 0; i < n; ++i) x[i] = std::clamp(x[i] - length * y[i], lower[i], upper[i]);
    look();
    double rise = 0;
    for (std::size_t i = 0; i < n; ++i) rise += (x[i] - old_x[i]) * (g[i] + old_g[i]);
    for (std::size_t i = 0; i < n && rise > 0; ++i) {
      x[i] = std::clamp(old_x[i] - most * y[i], lower[i], upper[i]);
      g[i] = old_g[i] - most * Hy[i];
    }
    restart = true;
  }
  for (std::size_t i = 0; i < n; ++i) x[i] = std::clamp(x[i] * scale[i], fit.low()[i], fit.high()[i]);
  return x;
}

} // namespace rpc::bound
