// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/problem.hpp"

#include <array>
#include <string>
#include <vector>

namespace rpc::analysis
{

/// How far a side of the mesh, or a set of points, has moved.
struct SideDisplacement {
  std::string side;
  std::array<double, 3>
      mean{}; ///< over the area; of points, and of a side without area as on the axis of a body of revolution, over nodes [m]
  double largest = 0; ///< length of the longest displacement of a node [m]
};

/// @param u      (owned dofs) [m]
/// @param sides  names of sides or sets of points
/// @return of each of them; collective
std::vector<SideDisplacement> side_displacements(const fem::Discretization &d, const Vector &u,
                                                 const std::vector<std::string> &sides);

/// The means of the places that the conditions of `Dirichlet` hold, in all components, free ones too [m]; collective.
std::vector<std::array<double, 3>> held_displacements(const Problem &problem, const Vector &u);

} // namespace rpc::analysis
