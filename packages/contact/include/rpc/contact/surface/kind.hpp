// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_Array.hpp>
#include <string>
#include <variant>
#include <vector>

namespace rpc::contact
{

/// A parameter of a deck's `Obstacle` list.
struct SurfaceParameter {
  std::string name;
  std::variant<double, bool, Teuchos::Array<double>, std::string, std::vector<std::string>>
      standard;     ///< its default; of several words the first one is it, and the others are all that may stand there
  std::string help; ///< behind "plane: ", without a full stop
};

/// How a deck's `Obstacle` list describes a kind of surface. A name may be of several kinds, with the same type and default.
struct SurfaceKind {
  std::vector<std::string> types;           ///< its names as `Type`; the first one stands in texts
  std::string point;                        ///< the parameter that says where it is
  std::string point_help;                   ///< the help of that one, without unit
  std::vector<SurfaceParameter> parameters; ///< the others that go with it
  std::string in_the_plane;                 ///< the type that stands for it in the plane; empty: itself
};

} // namespace rpc::contact
