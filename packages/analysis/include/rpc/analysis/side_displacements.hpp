// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"

#include <array>
#include <string>
#include <vector>

namespace rpc::analysis
{

/// How far a side of the mesh has moved.
struct SideDisplacement {
  std::string side;
  std::array<double, 3>
      mean{}; ///< over the area; of a side without area, such as the axis of a body of revolution, over its nodes [m]
  double largest = 0; ///< length of the longest displacement of a node [m]
};

/// @param u  (owned dofs) [m]
/// @return of all sides that have a name, in the mesh's order; collective
std::vector<SideDisplacement> side_displacements(const fem::Discretization &d, const Vector &u);

} // namespace rpc::analysis
