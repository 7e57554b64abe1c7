// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/muelu.hpp"

namespace rpc::solver
{

/// Puts MueLu's aggregates of one thread in the place of those that many threads would make, unless the user wants these. Does nothing
/// where MueLu has its factories once only.
void use_one_thread_aggregates(MueLu::FactoryManager<double, LO, GO, Node> &manager);

} // namespace rpc::solver
