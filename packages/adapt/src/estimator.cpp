// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/adapt/estimator.hpp"

#include "rpc/adapt/estimators/recovered.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::adapt
{

std::string PressurePeak::unknown() const
{
  constexpr double unresolved = 0.2, logarithmic = 0.05;
  if (at_bound) return "";
  if (yield_jump) return "the yield stress jumps next to a part that yields, where the pressure is singular";
  if (gap_jump) return "contact ends where the gap jumps, where the pressure is singular";
  if (dented_jump)
    return "the foundation is dented up to a jump of the gap, which lies between nodes that differ from mesh to mesh";
  if (friction_jump) return "friction jumps where the body slips, where the pressure is singular";
  if (friction_edge)
    return "contact with friction reaches an edge of the contact side, where the pressure may be singular";
  if (kink > logarithmic)
    return "the gap has a kink in contact, where the pressure grows without bound like a logarithm";
  if (drop <= unresolved) return "";
  return "the pressure falls by " + std::to_string(std::lround(100 * drop)) +
         " % within one cell where it is largest, as next to a singularity or a jump";
}

double ErrorEstimate::part(const std::string &key) const
{
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const ErrorPart &part) { return part.key == key; });
  RPC_REQUIRE_CODE(found != parts.end(), ExitCode::internal_error, "estimate: it has no part \"" << key << "\"");
  return found->squared;
}

double ErrorEstimate::total() const
{
  double sum = 0;
  for (const ErrorPart &part : parts) sum += part.squared;
  return sum;
}

Estimator estimator()
{
  return recovered_estimate;
}

} // namespace rpc::adapt
