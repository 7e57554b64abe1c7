#pragma once

#include <string>

namespace rpc::fem
{

/// What body a plane mesh is a section of. doc/theory.md, section 2
enum class Kinematics {
  plane_strain, ///< infinitely long, without displacement along its length; of a body in space: the body itself
  plane_stress  ///< a thin sheet without stresses across it
};

/// As decks call it: "plane strain", "plane stress".
std::string name_of(Kinematics kinematics);

/// The deck's `Kinematics`.
/// @throws rpc::Error (bad_input) if there is none of that name, or a body in space is given another than the default
Kinematics kinematics_option(const std::string &name, int dim);

} // namespace rpc::fem
