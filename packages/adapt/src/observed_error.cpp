// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/adapt/observed_error.hpp"

#include "rpc/core/point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::adapt
{
namespace
{

constexpr double least_reduction = 1.1; // of the estimate: less tells nothing about a limit
constexpr double span = 4;              // by which the estimate is planned to fall from mesh to mesh at most
constexpr double slowest_growth =
    0.5; // of the estimate, that values with a limit approach it with: half of the first order

/// The value where the estimate first falls to a level, straight in its logarithm between meshes.
double value_at(const double level, const std::vector<double> &value, const std::vector<double> &eta)
{
  std::size_t k = 1;
  while (k + 1 < eta.size() && eta[k] > level) ++k;
  const double fall = std::log(eta[k - 1] / eta[k]);
  const double way = fall > 0 ? std::log(eta[k - 1] / level) / fall : 1;
  return value[k - 1] + std::clamp(way, 0., 1.) * (value[k] - value[k - 1]);
}

} // namespace

double observed_error(const std::vector<double> &change, const std::vector<double> &eta)
{
  if (change.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t last = change.size();
  const auto error = [&](const std::size_t k) {
    return change[k - 1] / (std::max(least_reduction, eta[k - 1] / eta[k]) - 1);
  };
  if (last < 2) return error(last);
  return std::max(error(last), error(last - 1) * std::min(1., eta[last] / eta[last - 1]));
}

double error_over_span(const std::vector<double> &distance, const std::vector<double> &eta)
{
  double error = 0;
  for (std::size_t k = 0; k < distance.size(); ++k) {
    const double reduction = eta[k] / eta.back();
    if (reduction <= span) error = std::max(error, distance[k] / (std::max(least_reduction, reduction) - 1));
  }
  return error;
}

double error_of_history(const double distance, const double eta_other, const double eta)
{
  return distance / std::max(least_reduction - 1, std::abs(eta_other / eta - 1));
}

bool hardly_finer(const std::vector<double> &eta)
{
  constexpr double half = 0.5;
  return eta.back() > half * *std::max_element(eta.begin(), eta.end());
}

bool grows_without_limit(const std::vector<double> &value, const std::vector<double> &eta, const double resolved)
{
  if (value.size() < 3 || value.back() < *std::max_element(value.begin(), value.end())) return false;
  const double fall = eta.front() / eta.back();
  if (!(fall > least_reduction)) return false;
  const double middle = value_at(std::sqrt(eta.front() * eta.back()), value, eta);
  const double first = middle - value.front(), second = value.back() - middle;
  return second > resolved && second > std::pow(fall, -slowest_growth / 2) * first;
}

bool unsettled(const std::vector<double> &change, const std::vector<double> &eta, const double resolved)
{
  constexpr double half = 0.5;
  const std::size_t last = change.size();
  if (last < 2 || change[last - 1] <= resolved) return false;
  const bool to_halve = eta[last] < half * eta[last - 1];
  return change[last - 1] > (to_halve ? half : 1) * change[last - 2];
}

double force_at_work(const std::array<double, 3> &contact, const std::vector<std::array<double, 3>> &reactions)
{
  std::array<double, 3> sum = contact;
  for (const auto &reaction : reactions)
    for (int c = 0; c < 3; ++c) sum[c] += reaction[c];
  return std::max(length(contact), length(sum));
}

} // namespace rpc::adapt
