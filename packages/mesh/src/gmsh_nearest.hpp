// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rpc::mesh
{

/// Points on the boundary of a .geo's body, near given ones: on a curve, in space on a surface, or on the curves that two surfaces
/// share. One rank only.
/// @param tags    (points, 2) gmsh's; the second is 0 where there is one
/// @param coords  (points, 3) [m]
/// @return (points, 3) [m]; NaN where gmsh finds none
/// @throws rpc::Error as read_gmsh() does
std::vector<double> nearest_of_geo(const std::string &file, const std::vector<int> &tags,
                                   const std::vector<double> &coords);

} // namespace rpc::mesh
