// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/rule.hpp"

namespace rpc
{

/// Numbers that steer which scenes a program for GPUs hands over to one for the host, see core/rule.hpp.
struct HandOverRules {
  Rule<double> of_one_thread{50000, "hand_over.of_one_thread", "unknowns from which a GPU is faster than a thread [-]",
                             "doc/portability.md"};
  Rule<double> most_threads{16, "hand_over.most_threads", "threads that count [-]", "doc/portability.md"};
  Rule<double> work{10, "hand_over.work",
                    "of nearly incompressible bodies over that of others, for a thread [-]; off: 1",
                    "doc/portability.md"};
};
inline constexpr_rules HandOverRules hand_over_rules;

} // namespace rpc
