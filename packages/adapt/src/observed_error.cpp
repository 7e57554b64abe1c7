#include "rpc/adapt/observed_error.hpp"

#include <algorithm>
#include <limits>

namespace rpc::adapt
{

double observed_error(const std::vector<double> &change, const std::vector<double> &eta)
{
  constexpr double least_reduction = 1.1; // less tells nothing about a limit
  if (change.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t last = change.size();
  const auto error = [&](const std::size_t k) {
    return change[k - 1] / (std::max(least_reduction, eta[k - 1] / eta[k]) - 1);
  };
  if (last < 2) return error(last);
  return std::max(error(last), error(last - 1) * std::min(1., eta[last] / eta[last - 1]));
}

bool unsettled(const std::vector<double> &change, const std::vector<double> &eta, const double resolved)
{
  constexpr double half = 0.5;
  const std::size_t last = change.size();
  if (last < 2 || change[last - 1] <= resolved) return false;
  const bool to_halve = eta[last] < half * eta[last - 1];
  return change[last - 1] > (to_halve ? half : 1) * change[last - 2];
}

} // namespace rpc::adapt
