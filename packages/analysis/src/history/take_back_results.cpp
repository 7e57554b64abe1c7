// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/quantities.hpp"
#include "rpc/analysis/run.hpp"

#include <limits>

namespace rpc::analysis
{
namespace
{

constexpr double no_result = std::numeric_limits<double>::quiet_NaN();

void take_back(contact::ContactSums &sums)
{
  for (const auto &q : contact::contact_quantities) sums.*q.value = no_result;
  sums.force.fill(no_result);
}

} // namespace

void take_back_results(Solution &s)
{
  s.energy = s.energy_norm_squared = no_result;
  for (const auto &q : body_quantities) s.body.*q.value = no_result;
  take_back(s.contact.total);
  for (auto &side : s.contact.sides) take_back(side);
  for (auto &force : s.reactions) force.fill(no_result);
  for (auto &displacement : s.displacements) displacement.fill(no_result);
  for (auto *const numbers : {&s.rigid_motions, &s.rigid_forces})
    for (auto &each : *numbers) each.fill(no_result);
  s.contact.between = {};
}

} // namespace rpc::analysis
