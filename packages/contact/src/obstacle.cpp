#include "rpc/contact/obstacle.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <Teuchos_Array.hpp>
#include <cmath>
#include <vector>

namespace rpc::contact
{
namespace
{

using Teuchos::Array;

constexpr double rounding = 1e-9; ///< of positions and directions, relative

Point point_of(const Teuchos::ParameterList &list, const std::string &name, const int dim, const std::string &path)
{
  const auto &numbers = list.get<Array<double>>(name);
  RPC_REQUIRE(numbers.size() == dim,
              "deck: \"" << path << "->" << name << "\" must hold " << dim << " numbers, got " << numbers.size());
  Point point{};
  for (int c = 0; c < dim; ++c) {
    RPC_REQUIRE(std::isfinite(numbers[c]),
                "deck: \"" << path << "->" << name << "\" must be finite, got " << numbers[c]);
    point[c] = numbers[c];
  }
  return point;
}

/// The coordinates of a point as functions of time alone.
std::array<ScalarField, 3> path_of(const Teuchos::ParameterList &list, const std::string &name, const int dim,
                                   const std::string &path, const FieldParser &parse)
{
  const auto texts = field_texts(list, name);
  RPC_REQUIRE(static_cast<int>(texts.size()) == dim, "deck: \"" << path << "->" << name << "\" must hold " << dim
                                                                << " numbers or expressions of t, got "
                                                                << texts.size());
  std::array<ScalarField, 3> fields;
  for (int c = 0; c < dim; ++c) {
    fields[c] = parse(texts[c], path + "->" + name);
    const double here = fields[c]({0, 0, 0}), there = fields[c]({0.7, 1.3, 2.1});
    RPC_REQUIRE(here == there || (std::isnan(here) && std::isnan(there)),
                "deck: \"" << path << "->" << name << "\" must not depend on x, y or z, got " << texts[c]);
    RPC_REQUIRE(std::isfinite(here), "deck: \"" << path << "->" << name << "\" must be finite, got " << here
                                                << (fields[c].is_constant() ? "" : " from " + texts[c]));
  }
  return fields;
}

/// Unit vector from one of any length.
Point unit_of(const Teuchos::ParameterList &list, const std::string &name, const int dim, const std::string &path)
{
  const Point given = point_of(list, name, dim, path);
  const double size = length(given);
  RPC_REQUIRE(size > 0 && std::isfinite(size),
              "deck: \"" << path << "->" << name << "\" must have a length > 0, got " << size);
  return scaled(1 / size, given);
}

/// A vector without its part along the axis of a cylinder; all of it for a sphere.
Point across(const Obstacle &obstacle, const Point &v)
{
  return difference(v, scaled(inner(v, obstacle.axis), obstacle.axis));
}

} // namespace

Teuchos::ParameterList valid_obstacle_parameters()
{
  Teuchos::ParameterList valid("Obstacle");
  valid.set("Type", "none",
            "Shape of the foundation's surface: `plane`, `sphere` (in 2D also named `circle`), in 3D `cylinder`, or "
            "`none`: see Gap.");
  set_fields(valid, "Point", "plane: a point on it; cylinder: a point on its axis [m]. Numbers, or expressions of t.");
  valid.set("Normal", Array<double>(), "plane: its normal, out of the foundation towards the body, of any length.");
  valid.set("Axis", Array<double>(), "cylinder: the direction of its axis, of any length.");
  set_fields(valid, "Centre", "sphere: its centre [m]. Numbers, or expressions of t.");
  valid.set("Radius", 0., "sphere, cylinder: its radius, > 0 [m].");
  valid.set("Encloses Body", false, "sphere, cylinder: whether the body lies inside of it and the foundation outside.");
  return valid;
}

Obstacle Obstacle::seen_at(const double t) const
{
  Obstacle seen = *this;
  for (int c = 0; c < 3; ++c) {
    seen.path[c] = path[c].seen_at(t);
    if (!path[c].is_constant()) seen.point[c] = seen.path[c]({});
  }
  return seen;
}

Obstacle obstacle_options(const Teuchos::ParameterList &list, const int dim, const std::string &path,
                          const FieldParser &parse)
{
  const auto &type = list.get<std::string>("Type");
  const bool sphere = type == "sphere" || type == "circle", cylinder = type == "cylinder", plane = type == "plane";
  RPC_REQUIRE(type == "none" || plane || sphere || cylinder,
              "deck: \"" << path << "->Type\" must be one of none, plane, sphere, circle, cylinder, got \"" << type
                         << "\"");
  RPC_REQUIRE(!cylinder || dim == 3,
              "deck: \"" << path << "->Type\" = cylinder goes with a body in space; use circle in the plane");
  const auto refuse = [&](const std::vector<std::string> &names) {
    for (const auto &name : names)
      RPC_REQUIRE(list.getEntry(name).isDefault(),
                  "deck: \"" << path << "->" << name << "\" does not go with \"" << path << "->Type\" = " << type);
  };
  Obstacle obstacle; // `none` switches an obstacle off, whatever it was
  if (sphere) refuse({"Point", "Normal", "Axis"});
  if (cylinder) refuse({"Centre", "Normal"});
  if (plane) refuse({"Centre", "Axis", "Radius", "Encloses Body"});
  if (plane) {
    obstacle.kind = Obstacle::Kind::plane;
    obstacle.path = path_of(list, "Point", dim, path, parse);
    obstacle.normal = unit_of(list, "Normal", dim, path);
  }
  if (sphere) {
    obstacle.kind = Obstacle::Kind::sphere;
    obstacle.path = path_of(list, "Centre", dim, path, parse);
  }
  if (cylinder) {
    obstacle.kind = Obstacle::Kind::cylinder;
    obstacle.path = path_of(list, "Point", dim, path, parse);
    obstacle.axis = unit_of(list, "Axis", dim, path);
  }
  if (sphere || cylinder) {
    obstacle.radius = list.get<double>("Radius");
    obstacle.encloses = list.get<bool>("Encloses Body");
    RPC_REQUIRE(obstacle.radius > 0 && std::isfinite(obstacle.radius),
                "deck: \"" << path << "->Radius\" must be > 0 and finite [m], got " << obstacle.radius);
  }
  for (int c = 0; c < dim && obstacle.kind != Obstacle::Kind::none; ++c) obstacle.point[c] = obstacle.path[c]({});
  obstacle.origin = obstacle.point;
  return obstacle;
}

std::optional<Point> direction_into(const Obstacle &obstacle, const Point &x)
{
  if (obstacle.kind == Obstacle::Kind::plane) return scaled(-1, obstacle.normal);
  const Point from_centre = across(obstacle, difference(x, obstacle.point));
  const double distance = length(from_centre);
  if (!(distance > 0)) return std::nullopt;
  return scaled((obstacle.encloses ? 1 : -1) / distance, from_centre);
}

bool lies_in(const Obstacle &obstacle, const Point &x)
{
  const Point from = across(obstacle, difference(x, obstacle.point));
  const double distance = length(from);
  if (obstacle.kind == Obstacle::Kind::plane) return inner(from, obstacle.normal) < -rounding * distance;
  const double beyond = distance - obstacle.radius;
  return (obstacle.encloses ? beyond : -beyond) > rounding * obstacle.radius;
}

std::optional<double> distance_along(const Obstacle &obstacle, const Point &x, const Point &direction)
{
  const Point from = across(obstacle, difference(x, obstacle.point));
  if (obstacle.kind == Obstacle::Kind::plane) {
    const double descent = -inner(direction, obstacle.normal);
    if (!(descent > rounding)) return std::nullopt;
    return inner(from, obstacle.normal) / descent;
  }
  // |from + g way| = radius: the root that crosses the surface from the body's part of space. Of a cylinder only what is across
  // its axis counts.
  const Point way = across(obstacle, direction);
  const double square = inner(way, way);
  if (!(square > rounding * rounding)) return std::nullopt; // along the axis
  const double along = inner(from, way);
  double discriminant = along * along - square * (inner(from, from) - obstacle.radius * obstacle.radius);
  // A tangent meets the surface that encloses its point, whatever the rounding.
  if (obstacle.encloses && discriminant < 0 && !lies_in(obstacle, x)) discriminant = 0;
  const bool leads_in = obstacle.encloses || along < 0 || lies_in(obstacle, x);
  if (!(discriminant >= 0) || !leads_in) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return ((obstacle.encloses ? root : -root) - along) / square;
}

} // namespace rpc::contact
