#include "convergence.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::solver
{
namespace
{

constexpr int window = 20; // CG stands still for ten iterations now and then, and goes on

} // namespace

void Convergence::add(const double residual)
{
  least_.push_back(std::min(least_.back(), residual));
}

double Convergence::iterations_in_all(const double tolerance, const double most) const
{
  const int k = iterations(), w = std::min(k, window);
  if (least_[k] <= tolerance) return std::min<double>(k, most);
  const double fallen = std::log(least_[k - w] / least_[k]);
  if (!(fallen > 0)) return most;
  return std::min(k + w * std::log(least_[k] / tolerance) / fallen, most);
}

} // namespace rpc::solver
