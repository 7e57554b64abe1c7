// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/kinematics.hpp"

#include "rpc/core/error.hpp"

namespace rpc::fem
{

std::string name_of(const Kinematics kinematics)
{
  switch (kinematics) {
  case Kinematics::plane_stress:
    return "plane stress";
  case Kinematics::axisymmetric:
    return "axisymmetric";
  default:
    return "plane strain";
  }
}

void require_dimension(const Kinematics kinematics, const int dim)
{
  RPC_REQUIRE(dim == 2 || kinematics == Kinematics::plane_strain,
              "deck: \"Kinematics\" = "
                  << name_of(kinematics)
                  << " is for plane meshes, and the mesh lies in space. Remove it, or give a plane mesh.");
}

Kinematics kinematics_option(const std::string &name, const int dim)
{
  for (const auto kinematics : {Kinematics::plane_strain, Kinematics::plane_stress, Kinematics::axisymmetric}) {
    if (name != name_of(kinematics)) continue;
    require_dimension(kinematics, dim);
    return kinematics;
  }
  throw Error(ExitCode::bad_input,
              "deck: \"Kinematics\" must be plane strain, plane stress or axisymmetric, got \"" + name + "\"");
}

} // namespace rpc::fem
