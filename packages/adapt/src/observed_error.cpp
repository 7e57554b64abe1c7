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

} // namespace rpc::adapt
