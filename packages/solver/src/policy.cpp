// SPDX-License-Identifier: BSD-3-Clause
#include "policy.hpp"

#include <algorithm>
#include <iterator>

namespace rpc::solver
{

const Rule &rule_for(const Used used, const Outcome outcome)
{
  return *std::find_if(std::begin(policy), std::prev(std::end(policy)),
                       [=](const Rule &rule) { return rule.used == used && (rule.outcomes & outcome) != 0; });
}

} // namespace rpc::solver
