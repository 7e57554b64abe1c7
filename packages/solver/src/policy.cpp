// SPDX-License-Identifier: BSD-3-Clause
#include "policy.hpp"

#include <algorithm>
#include <iterator>

namespace rpc::solver
{

const PolicyRow &rule_for(const Used used, const Outcome outcome)
{
  return *std::find_if(std::begin(policy), std::prev(std::end(policy)),
                       [=](const PolicyRow &rule) { return rule.used == used && (rule.outcomes & outcome) != 0; });
}

} // namespace rpc::solver
