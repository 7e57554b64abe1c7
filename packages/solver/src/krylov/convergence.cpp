// SPDX-License-Identifier: BSD-3-Clause
#include "krylov/convergence.hpp"

#include "rpc/core/rules.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::solver
{

double fair(const double tolerance)
{
  return linear_rules.fair_iterations * std::min(1., std::log(tolerance) / std::log(1e-8));
}
void Convergence::add(const double residual)
{
  least_.push_back(std::min(least_.back(), residual));
}

double Convergence::iterations_in_all(const double tolerance, const double most) const
{
  const int k = iterations(), w = std::min<int>(k, linear_rules.window);
  if (least_[k] <= tolerance) return std::min<double>(k, most);
  const double fallen = std::log(least_[k - w] / least_[k]);
  if (!(fallen > 0)) return most;
  return std::min(k + w * std::log(least_[k] / tolerance) / fallen, most);
}

void EnergyError::add(const double energy)
{
  const double gain = std::max(energy - energy_, 0.);
  if (gain_ >= 0) rate_ = gain_ > 0 ? std::min<double>(gain / gain_, headway_rules.falls) : headway_rules.falls;
  energy_ = energy;
  gain_ = gain;
}

double EnergyError::squared() const
{
  return gain_ >= 0 && rate_ < 1 ? gain_ * rate_ / (1 - rate_) : std::numeric_limits<double>::infinity();
}

} // namespace rpc::solver
