// SPDX-License-Identifier: BSD-3-Clause
#include "step/softness.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace rpc::analysis
{
namespace
{

/// Root of the sum of squares of a row of the softness of all groups, or of a combination of rows.
class Rows
{
public:
  /// @param columns  (groups, groups)   @param n  groups
  Rows(std::vector<double> columns, const int n) : columns_(std::move(columns)), n_(n) {}

  /// @param factors  (groups from the first one on) of the rows   @return infinite where there are no columns: the softness is not known
  double squared(const int first, const std::vector<double> &factors) const
  {
    if (columns_.empty()) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (int k = 0; k < n_; ++k) {
      double entry = 0;
      for (std::size_t j = 0; j < factors.size(); ++j) entry += factors[j] * columns_[k * n_ + first + j];
      sum += entry * entry;
    }
    return sum;
  }

private:
  std::vector<double> columns_;
  int n_;
};

} // namespace

Softness softness_of(const Problem &problem, const fem::DirichletDofs &dirichlet, SolverState &state)
{
  const auto &conditions = problem.model().dirichlet;
  Softness softness;
  softness.displacement.assign(conditions.size(), 0.);
  softness.rotation.assign(dirichlet.rigid.size(), 0.);
  const int groups = dirichlet.tied ? dirichlet.tied->size() : 0;
  const Rows rows(state.linear().softness_of_tied(), groups);
  if (groups == 0) return softness;
  int group = 0;
  for (const auto &[k, c] : fem::moved_by_force(conditions)) softness.displacement[k] += rows.squared(group++, {1});
  for (std::size_t j = 0; j < fem::floating_components(conditions).size(); ++j)
    softness.obstacle += rows.squared(group++, {1});
  for (std::size_t j = 0; j < dirichlet.rigid.size(); ++j) {
    const fem::RigidSide &side = dirichlet.rigid[j];
    const std::size_t n = side.unknown.size();
    for (std::size_t k = 0; k < n; ++k) { // motion k is a combination of the groups                           (2.9b)
      const std::vector<double> factors(side.to_motions.begin() + static_cast<std::ptrdiff_t>(k * n),
                                        side.to_motions.begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
      (side.unknown[k] < 3 ? softness.displacement[side.condition] : softness.rotation[j]) +=
          rows.squared(side.first_group, factors);
    }
  }
  for (auto *const all : {&softness.displacement, &softness.rotation})
    for (double &each : *all) each = std::sqrt(each);
  softness.obstacle = std::sqrt(softness.obstacle);
  return softness;
}

} // namespace rpc::analysis
