// SPDX-License-Identifier: BSD-3-Clause
#include "motions.hpp"

#include "rpc/adapt/observed_error.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::adapt
{
namespace
{

/// Root mean square of how far a rotation of 1 about the reference point moves the nodes of a side, about the axis where that is most.
double arm_of(const fem::RigidSide &side)
{
  double most = 0;
  const std::size_t n = side.motions.size();
  for (std::size_t k = 0; k < n; ++k)
    if (side.motions[k] >= 3) most = std::max(most, side.products[k * n + k] / side.products.front());
  return std::sqrt(most);
}

/// Whether a condition holds a motion against forces: rotations are motions 3 to 5.
bool holds(const fem::DirichletCondition &condition, const int motion)
{
  if (condition.rigid) return condition.rigid->displacement[motion] || condition.rigid->stiffness[motion] != 0;
  return condition.displacement[motion].has_value();
}

/// Whether it leaves three motions from one on to forces that are given.
bool is_left_to_forces(const fem::DirichletCondition &condition, const int first)
{
  return !holds(condition, first) && !holds(condition, first + 1) && !holds(condition, first + 2);
}

} // namespace

Motions motions_of(const analysis::StepSolution &s)
{
  Motions motions;
  motions.displacements = s.displacements;
  for (const fem::RigidSide &side : s.step.elastic.dirichlet.rigid) motions.arms.push_back(arm_of(side));
  for (const fem::SixNumbers &q : s.rigid_motions) motions.rotations.push_back({q[3], q[4], q[5]});
  for (const fem::SixNumbers &f : s.rigid_forces) motions.moments.push_back({f[3], f[4], f[5]});
  motions.obstacle = s.step.obstacle;
  motions.softness = s.softness;
  return motions;
}

FixedByLoad fixed_by_load(const analysis::Model &model)
{
  FixedByLoad fixed;
  fixed.contact = {true, true, true};
  for (const auto &condition : model.dirichlet) {
    for (int c = 0; c < 3; ++c) fixed.contact[c] = fixed.contact[c] && !holds(condition, c);
    fixed.reactions.push_back(is_left_to_forces(condition, 0));
    if (condition.rigid) fixed.moments.push_back(is_left_to_forces(condition, 3));
  }
  for (const auto &side : model.contact)
    for (int c = 0; c < 3; ++c) {
      if (side.obstacle.force[c]) fixed.contact[c] = side.obstacle.stiffness[c] == 0;
      fixed.springs[c] += side.obstacle.stiffness[c];
    }
  return fixed;
}

namespace
{

/// Error of a component of the contact force on the last mesh, as all meshes show it.                                (10.7)
double shown_of_component(const std::vector<Cycle> &cycles, const int c)
{
  std::vector<double> eta, change, to_last;
  for (std::size_t k = 0; k < cycles.size(); ++k) {
    const double here = cycles[k].contact.force[c];
    eta.push_back(cycles[k].estimate);
    if (k > 0) change.push_back(std::abs(here - cycles[k - 1].contact.force[c]));
    if (k + 1 < cycles.size()) to_last.push_back(std::abs(here - cycles.back().contact.force[c]));
  }
  const double error = std::max(observed_error(change, eta), error_over_span(to_last, eta));
  return unsettled(change, eta, 0) ? std::max(error, change.back()) : error;
}

} // namespace

std::vector<double> contact_force_bars(const std::vector<Cycle> &cycles, const ObservedErrors &errors,
                                       const FixedByLoad &fixed, const double tolerance)
{
  if (cycles.size() < 2 || std::isnan(errors.contact_force)) return {};
  const double rounding = tolerance * length(cycles.back().contact.force);
  std::vector<double> bars(3, errors.contact_force);
  for (int c = 0; c < 3; ++c)
    if (fixed.contact[c]) {
      const double shown = shown_of_component(cycles, c);
      bars[c] = std::min(bars[c], shown > rounding ? shown : 0);
    } else if (fixed.springs[c] > 0) {
      bars[c] = std::min(bars[c], fixed.springs[c] * errors.motions.obstacle);
    }
  return bars;
}

} // namespace rpc::adapt
