#pragma once

#include "rpc/core/field.hpp"

#include <Teuchos_ParameterList.hpp>
#include <array>
#include <optional>
#include <string>

namespace rpc::contact
{

/// The foundation's surface where it has a simple shape.
struct Obstacle {
  enum class Kind {
    none,
    plane,
    sphere,  ///< in 2D a circle
    cylinder ///< an endless one, in 3D
  };

  Kind kind = Kind::none;
  Point point{};         ///< of a plane, the centre of a sphere, or one on the axis of a cylinder [m]
  Point normal{};        ///< of a plane, unit, out of the foundation towards the body
  double radius = 0;     ///< of a sphere or cylinder [m]
  bool encloses = false; ///< the body lies inside of the sphere or cylinder, the foundation outside
  Point axis{};          ///< of a cylinder, unit
  std::array<ScalarField, 3> path =
      {};         ///< coordinates of `point` that change with time [m]; constant ones are not read
  Point origin{}; ///< where `point` is at the first of several steps [m]

  /// The same, with `point` where it is at a time.
  Obstacle seen_at(double t) const;
};

/// Parameters of an `Obstacle` sublist.
Teuchos::ParameterList valid_obstacle_parameters();
/// @param path  of the sublist, for messages
/// @throws rpc::Error (bad_input) on anything out of range, or given for another type of obstacle
Obstacle obstacle_options(const Teuchos::ParameterList &list, int dim, const std::string &path,
                          const FieldParser &parse);

/// Unit normal of the foundation at the point of its surface nearest to x, pointing into the foundation; nothing at the
/// centre of a sphere or on the axis of a cylinder. doc/theory.md (3.6)
std::optional<Point> direction_into(const Obstacle &obstacle, const Point &x);

/// Whether x lies in the foundation, deeper than rounding.
bool lies_in(const Obstacle &obstacle, const Point &x);

/// How far it is from x to the foundation's surface along a unit direction that points into the foundation [m]; negative
/// if x lies in the foundation. Nothing if that way does not lead into it: it passes the foundation by or leads away from
/// it, or x lies in the foundation and the way does not cross the surface. doc/theory.md (3.7)
std::optional<double> distance_along(const Obstacle &obstacle, const Point &x, const Point &direction);

} // namespace rpc::contact
