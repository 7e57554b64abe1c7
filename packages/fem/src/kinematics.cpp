#include "rpc/fem/kinematics.hpp"

#include "rpc/core/error.hpp"

namespace rpc::fem
{

std::string name_of(const Kinematics kinematics)
{
  switch (kinematics) {
  case Kinematics::plane_stress:
    return "plane stress";
  default:
    return "plane strain";
  }
}

Kinematics kinematics_option(const std::string &name, const int dim)
{
  for (const auto kinematics : {Kinematics::plane_strain, Kinematics::plane_stress}) {
    if (name != name_of(kinematics)) continue;
    RPC_REQUIRE(dim == 2 || kinematics == Kinematics::plane_strain,
                "deck: \"Kinematics\" = " << name
                                          << " is for plane meshes, and the mesh lies in space. Remove it, or give a "
                                          << "plane mesh.");
    return kinematics;
  }
  throw Error(ExitCode::bad_input, "deck: \"Kinematics\" must be plane strain or plane stress, got \"" + name + "\"");
}

} // namespace rpc::fem
