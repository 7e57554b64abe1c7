// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/dirichlet.hpp"

#include <memory>
#include <vector>

namespace rpc::fem
{

/// @throws rpc::Error (bad_input) where a force is to move a point, or a side along the radius of a body of revolution
void require_movable(const Discretization &d, const std::vector<DirichletCondition> &conditions);

/// The unknowns that forces move as one; null where there are none. Collective.
/// @param condition  see DirichletDofs
std::shared_ptr<const TiedUnknowns> tied_unknowns(const Discretization &d,
                                                  const std::vector<DirichletCondition> &conditions,
                                                  const DeviceView<int *> &condition);

} // namespace rpc::fem
