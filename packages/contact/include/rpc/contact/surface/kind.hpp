// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rpc::contact
{

/// How a deck's `Obstacle` list describes a kind of surface.
struct SurfaceKind {
  std::vector<std::string> types;      ///< its names as `Type`
  std::string point;                   ///< the parameter that says where it is
  std::vector<std::string> parameters; ///< the others that go with it
  std::string in_the_plane;            ///< the type that stands for it in the plane; empty: itself
};

} // namespace rpc::contact
