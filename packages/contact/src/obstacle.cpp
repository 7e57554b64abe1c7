// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/obstacle.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace rpc::contact
{
namespace
{

using Teuchos::Array;

/// Parameters of obstacles other than `Type`, in the order in which those that do not go with it are refused.
const std::vector<std::string> parameters_of_types = {"Centre", "Point", "Normal", "Axis", "Radius", "Encloses Body"};

/// A kind of surface in a deck.
struct Choice {
  SurfaceKind kind;
  Surface (*read)(const Teuchos::ParameterList &list, int dim, const std::string &path);

  bool is(const std::string &type) const
  {
    return std::find(kind.types.begin(), kind.types.end(), type) != kind.types.end();
  }
  bool has(const std::string &parameter) const
  {
    return parameter == kind.point ||
           std::find(kind.parameters.begin(), kind.parameters.end(), parameter) != kind.parameters.end();
  }
};

/// "Centre, Radius, Encloses Body"
std::string names_with(const Choice &choice)
{
  std::string names = choice.kind.point;
  for (const auto &name : choice.kind.parameters) names += ", " + std::string(name);
  return names;
}

template <class Shape>
Surface read_surface(const Teuchos::ParameterList &list, const int dim, const std::string &path)
{
  return Shape::read(list, dim, path);
}

template <std::size_t... Which>
std::vector<Choice> choices(std::index_sequence<Which...>)
{
  return {{std::variant_alternative_t<Which, Surface>::kind(),
           read_surface<std::variant_alternative_t<Which, Surface>>}...};
}
std::vector<Choice> choices()
{
  return choices(std::make_index_sequence<std::variant_size_v<Surface>>());
}

/// The coordinates of a point as functions of time alone.
std::array<ScalarField, 3> path_of(const Teuchos::ParameterList &list, const std::string &name, const int dim,
                                   const std::string &path, const FieldParser &parse)
{
  const auto texts = field_texts(list, name);
  RPC_REQUIRE(static_cast<int>(texts.size()) == dim,
              "deck: \"" << path << "->" << name << "\" must hold " << dim << " numbers or expressions of t, got "
                         << texts.size() << (texts.empty() ? ". It has no default: add it." : ""));
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

} // namespace

Teuchos::ParameterList valid_obstacle_parameters()
{
  Teuchos::ParameterList valid("Obstacle");
  std::vector<std::string> types{"none"};
  for (const Choice &c : choices())
    for (const std::string &name : c.kind.types) types.push_back(name);
  set_words(valid, "Type", types,
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

Obstacle obstacle_options(const Teuchos::ParameterList &list, const int dim, const std::string &path,
                          const FieldParser &parse)
{
  const auto &type = list.get<std::string>("Type");
  const std::vector<Choice> all = choices();
  std::string types = "none";
  for (const Choice &c : all)
    for (const std::string &name : c.kind.types) types += ", " + name;
  if (list.getEntry("Type").isDefault())
    for (const std::string &name : parameters_of_types)
      RPC_REQUIRE(list.getEntry(name).isDefault(),
                  "deck: \"" << path << "\" has a \"" << name
                             << "\" and no \"Type\", so that there is no obstacle. Types: " << types);
  if (type == "none") return {}; // switches an obstacle off, whatever it was
  const auto choice = std::find_if(all.begin(), all.end(), [&](const Choice &c) { return c.is(type); });
  RPC_REQUIRE(choice != all.end(),
              "deck: \"" << path << "->Type\" must be one of " << types << ", got \"" << type << "\"");
  RPC_REQUIRE(choice->kind.in_the_plane.empty() || dim == 3,
              "deck: \"" << path << "->Type\" = " << type << " goes with a body in space; use "
                         << choice->kind.in_the_plane << " in the plane");
  for (const std::string &name : parameters_of_types)
    RPC_REQUIRE(choice->has(name) || list.getEntry(name).isDefault(),
                "deck: \"" << path << "->" << name << "\" does not go with \"" << path << "->Type\" = " << type
                           << ", which has " << names_with(*choice)
                           << (name == "Point" || name == "Centre"
                                   ? ". Write \"" + std::string(choice->kind.point) + "\" for \"" + name + "\""
                                   : ". Remove it, or change the type"));
  Obstacle obstacle;
  obstacle.path = path_of(list, choice->kind.point, dim, path, parse);
  obstacle.surface = choice->read(list, dim, path);
  for (int c = 0; c < dim; ++c) obstacle.point[c] = obstacle.path[c]({});
  obstacle.origin = obstacle.point;
  return obstacle;
}

bool Obstacle::moves() const
{
  return std::any_of(path.begin(), path.end(), [](const ScalarField &coordinate) { return !coordinate.is_constant(); });
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

std::optional<Point> direction_into(const Obstacle &obstacle, const Point &x)
{
  return std::visit([&](const auto &surface) { return surface.direction_into(difference(x, obstacle.point)); },
                    obstacle.surface.value());
}

std::string no_direction_at(const Obstacle &obstacle)
{
  return std::visit([](const auto &surface) { return surface.no_direction_at; }, obstacle.surface.value());
}

std::string point_name(const Obstacle &obstacle)
{
  return std::visit([](const auto &surface) { return std::string(surface.kind().point); }, obstacle.surface.value());
}

bool lies_in(const Obstacle &obstacle, const Point &x)
{
  return std::visit([&](const auto &surface) { return surface.lies_in(difference(x, obstacle.point)); },
                    obstacle.surface.value());
}

std::optional<double> distance_along(const Obstacle &obstacle, const Point &x, const Point &direction)
{
  return std::visit(
      [&](const auto &surface) { return surface.distance_along(difference(x, obstacle.point), direction); },
      obstacle.surface.value());
}

} // namespace rpc::contact
