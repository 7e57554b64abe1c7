// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/surface.hpp"
#include "rpc/core/field.hpp"
#include "rpc/core/file_reader.hpp"

#include <Teuchos_ParameterList.hpp>
#include <array>
#include <optional>
#include <string>

namespace rpc::contact
{

/// The foundation's surface where it has a simple shape.
struct Obstacle {
  std::optional<Surface> surface = {};
  Point point{}; ///< of a plane, the centre of a sphere, one on the axis of a cylinder, the tip of a cone ... [m]
  std::array<ScalarField, 3> path =
      {};         ///< coordinates of `point` that change with time [m]; constant ones are not read
  Point origin{}; ///< where `point` is at t = 0 [m]
  /// Along a coordinate, the force that moves it [N], of time alone; nothing: it follows its path.        doc/theory.md (3.17)
  std::array<std::optional<ScalarField>, 3> force = {};
  std::array<double, 3>
      stiffness{}; ///< of a spring between it and the ground along a coordinate [N/m]; 0: none (3.17e)

  bool exists() const { return surface.has_value(); }
  /// Whether a force or a spring says where it is along a coordinate.
  bool is_moved_along(const int c) const { return force[c] || stiffness[c] > 0; }
  bool is_moved() const { return is_moved_along(0) || is_moved_along(1) || is_moved_along(2); }
  bool has_springs() const { return stiffness[0] > 0 || stiffness[1] > 0 || stiffness[2] > 0; }
  bool moves() const; ///< with time, or by a force or a spring
  /// The same, with `point` where its path has it at a time.
  Obstacle seen_at(double t) const;
};

/// Parameters of an `Obstacle` sublist.
Teuchos::ParameterList valid_obstacle_parameters();
/// @param path       of the sublist, for messages
/// @param read_file  for obstacles that are given by a file
/// @throws rpc::Error (bad_input) on anything out of range, or given for another type of obstacle
Obstacle obstacle_options(const Teuchos::ParameterList &list, int dim, const std::string &path,
                          const FieldParser &parse, const FileReader &read_file = bytes_of_file);

// Of an obstacle that exists:

/// Unit normal of the foundation at the point of its surface nearest to x, pointing into the foundation; nothing where none is the nearest, such as
/// the centre of a sphere or the axis of a cylinder. doc/theory.md (3.6)
std::optional<Point> direction_into(const Obstacle &obstacle, const Point &x);
/// The parameter that says where there is no such normal, "Centre" or "Axis".
std::string no_direction_at(const Obstacle &obstacle);

/// The parameter that says where it is, "Point" or "Centre".
std::string point_name(const Obstacle &obstacle);

/// Whether x lies in the foundation, deeper than rounding.
bool lies_in(const Obstacle &obstacle, const Point &x);

/// How far it is from x to the foundation's surface along a unit direction that points into the foundation [m]; negative
/// if x lies in the foundation. Nothing if that way does not lead into it: it passes the foundation by or leads away from
/// it, or x lies in the foundation and the way does not cross the surface. doc/theory.md (3.7)
std::optional<double> distance_along(const Obstacle &obstacle, const Point &x, const Point &direction);

} // namespace rpc::contact
