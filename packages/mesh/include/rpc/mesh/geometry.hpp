// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace rpc::mesh
{

/// What a curve of a plane body's boundary, or a surface of a body in space, lies on.
struct BoundaryShape {
  enum class Kind {
    flat,     ///< line or plane: through `point`, normal to `direction`
    sphere,   ///< or circle: around `point`
    cylinder, ///< around the axis through `point` along `direction`
    other     ///< no closed formula is known: gmsh tells points of it
  };
  Kind kind = Kind::flat;
  int tag = 0;                       ///< gmsh's number of the curve or surface
  std::array<double, 3> point{};     ///< [m]; z is 0 in the plane
  std::array<double, 3> direction{}; ///< of length 1, where there is one
  double radius = 0;                 ///< [m]
};

/// The facets of a mesh that lie on one curve or surface.
struct BoundaryPart {
  BoundaryShape shape;
  std::vector<int> cell, ordinal; ///< (facets) as those of a side
};

/// The point nearest to x that lies on all of some shapes: Newton's method with the least move for two of them, projections one after
/// another for those that touch. Shapes of kind `other` do not count.
/// @param shapes  at least one
/// @return none if it does not converge, as where they have no point in common   doc/theory.md (2.17)
std::optional<std::array<double, 3>> nearest_point(const std::vector<BoundaryShape> &shapes, std::array<double, 3> x);

} // namespace rpc::mesh
