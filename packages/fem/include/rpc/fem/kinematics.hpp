// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rpc::fem
{

/// What body a plane mesh is a section of. doc/theory.md, section 2
enum class Kinematics {
  plane_strain, ///< infinitely long, without displacement along its length; of a body in space: the body itself
  plane_stress, ///< a thin sheet without stresses across it
  axisymmetric  ///< a body of revolution: x is the radius r >= 0, y runs along the axis
};

/// As decks call it: "plane strain", "plane stress", "axisymmetric".
std::string name_of(Kinematics kinematics);

/// The deck's `Kinematics`.
/// @throws rpc::Error (bad_input) if there is none of that name, and as require_dimension()
Kinematics kinematics_option(const std::string &name, int dim);

/// @throws rpc::Error (bad_input) if a body in space is given another than the default
void require_dimension(Kinematics kinematics, int dim);

} // namespace rpc::fem
