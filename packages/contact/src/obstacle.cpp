// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/obstacle.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "shapes_of_decks.hpp" // made by CMake from its list `surfaces`

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace rpc::contact
{
namespace
{

/// A kind of surface in a deck.
struct Choice {
  SurfaceKind kind;
  Surface (*read)(const Teuchos::ParameterList &list, int dim, const std::string &path, const FileReader &read_file);

  bool is(const std::string &type) const
  {
    return std::find(kind.types.begin(), kind.types.end(), type) != kind.types.end();
  }
  bool has(const std::string &parameter) const
  {
    return parameter == kind.point || std::any_of(kind.parameters.begin(), kind.parameters.end(),
                                                  [&](const SurfaceParameter &p) { return p.name == parameter; });
  }
};

/// "Centre, Radius, Encloses Body"
std::string names_with(const Choice &choice)
{
  std::string names = choice.kind.point;
  for (const SurfaceParameter &p : choice.kind.parameters) names += ", " + p.name;
  return names;
}

template <class Shape>
Surface read_surface(const Teuchos::ParameterList &list, const int dim, const std::string &path,
                     [[maybe_unused]] const FileReader &read_file)
{
  if constexpr (std::is_invocable_v<decltype(Shape::read), const Teuchos::ParameterList &, int, const std::string &,
                                    const FileReader &>)
    return Shape::read(list, dim, path, read_file);
  else
    return Shape::read(list, dim, path);
}

template <class... Shapes>
std::vector<Choice> choices_of(const std::tuple<Shapes...> *)
{
  return {{Shapes::kind(), read_surface<Shapes>}...};
}
std::vector<Choice> choices()
{
  return choices_of(static_cast<const ShapesOfDecks *>(nullptr));
}

/// "none, plane, sphere, circle, cylinder"
std::string types_of(const std::vector<Choice> &choices)
{
  std::string types = "none";
  for (const Choice &c : choices)
    for (const std::string &name : c.kind.types) types += ", " + name;
  return types;
}

/// "`plane`, `sphere` (in 2D also named `circle`), in 3D `cylinder`"
std::string types_help(const std::vector<Choice> &choices)
{
  std::string text;
  for (const Choice &c : choices) {
    text += (text.empty() ? "" : ", ") + std::string(c.kind.in_the_plane.empty() ? "" : "in 3D ") + "`" +
            c.kind.types.front() + "`";
    for (std::size_t k = 1; k < c.kind.types.size(); ++k)
      text += (k == 1 ? " (in 2D also named `" : ", `") + c.kind.types[k] + "`";
    if (c.kind.types.size() > 1) text += ")";
  }
  return text;
}

/// A parameter of the list, of one kind or several.
struct ListParameter {
  std::string name;
  bool is_point = false;
  SurfaceParameter parameter;                                  // of the first kind, but for points
  std::vector<std::pair<std::string, std::string>> kinds_help; // kinds, with a comma between them, that have one help

  void add(const std::string &kind, const std::string &help)
  {
    if (!kinds_help.empty() && kinds_help.back().second == help)
      kinds_help.back().first += ", " + kind;
    else
      kinds_help.emplace_back(kind, help);
  }
  /// "plane: a point on it; cylinder: a point on its axis"
  std::string help() const
  {
    std::string text;
    for (const auto &[kinds, each] : kinds_help) text += (text.empty() ? "" : "; ") + kinds + ": " + each;
    return text;
  }
};

/// Parameters other than `Type`, each once, in the order of the kinds.
std::vector<ListParameter> list_parameters(const std::vector<Choice> &choices)
{
  std::vector<ListParameter> all;
  const auto entry = [&](const std::string &name) -> ListParameter & {
    const auto found = std::find_if(all.begin(), all.end(), [&](const ListParameter &p) { return p.name == name; });
    return found != all.end() ? *found : all.emplace_back(ListParameter{name, false, {}, {}});
  };
  for (const Choice &c : choices) {
    ListParameter &point = entry(c.kind.point);
    point.is_point = true;
    point.add(c.kind.types.front(), c.kind.point_help);
    for (const SurfaceParameter &p : c.kind.parameters) {
      ListParameter &other = entry(p.name);
      if (other.kinds_help.empty()) other.parameter = p;
      other.add(c.kind.types.front(), p.help);
    }
  }
  return all;
}

void set_standard(Teuchos::ParameterList &valid, const ListParameter &p)
{
  const auto set = [&](const auto &standard) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(standard)>, std::vector<std::string>>)
      valid.set(p.name, standard, p.help() + ".");
  };
  std::visit(set, p.parameter.standard);
}

/// @throws rpc::Error (bad_input) where a field depends on place, or is not finite now
void require_finite_of_time(const ScalarField &field, const std::string &parameter, const std::string &text)
{
  const double here = field({0, 0, 0}), there = field({0.7, 1.3, 2.1});
  RPC_REQUIRE(here == there || (std::isnan(here) && std::isnan(there)),
              "deck: \"" << parameter << "\" must not depend on x, y or z, got " << text);
  RPC_REQUIRE(std::isfinite(here), "deck: \"" << parameter << "\" must be finite, got " << here
                                              << (field.is_constant() ? "" : " from " + text));
}

constexpr const char *force_names[] = {"Force X", "Force Y", "Force Z"};
constexpr const char *stiffness_names[] = {"Stiffness X", "Stiffness Y", "Stiffness Z"};

/// @throws rpc::Error (bad_input) where a parameter is to move the obstacle along a component that is not there, or that its path moves it along
void require_movable_along(const int c, const std::string &name, const Obstacle &obstacle, const int dim,
                           const std::string &path, const std::string &point)
{
  RPC_REQUIRE(c < dim, "deck: \"" << path << "->" << name << "\" moves along a component that a " << dim
                                  << "D mesh does not have. It has X and Y; of a body of revolution Y runs along the "
                                     "axis.");
  RPC_REQUIRE(obstacle.path[c].is_constant(),
              "deck: \"" << path << "->" << point << "\" must have a number as its coordinate along "
                         << "XYZ"[c] << ", where the obstacle starts, for \"" << name << "\" moves it; got "
                         << obstacle.path[c].text << ". Leave one of them out.");
}

/// The forces that move the obstacle, along the coordinates that have one.
std::array<std::optional<ScalarField>, 3> forces_of(const Teuchos::ParameterList &list, const Obstacle &obstacle,
                                                    const int dim, const std::string &path, const std::string &point,
                                                    const FieldParser &parse)
{
  std::array<std::optional<ScalarField>, 3> force;
  for (int c = 0; c < 3; ++c) {
    const std::string parameter = path + "->" + force_names[c], text = field_text(list, force_names[c]);
    if (text.empty()) continue;
    require_movable_along(c, force_names[c], obstacle, dim, path, point);
    force[c] = parse(text, parameter);
    require_finite_of_time(*force[c], parameter, text);
  }
  return force;
}

/// The stiffnesses of springs between the obstacle and the ground, along the coordinates that have one.
std::array<double, 3> stiffnesses_of(const Teuchos::ParameterList &list, const Obstacle &obstacle, const int dim,
                                     const std::string &path, const std::string &point)
{
  std::array<double, 3> stiffness{};
  for (int c = 0; c < 3; ++c) {
    stiffness[c] = list.get<double>(stiffness_names[c]);
    RPC_REQUIRE(std::isfinite(stiffness[c]) && stiffness[c] >= 0, "deck: \"" << path << "->" << stiffness_names[c]
                                                                             << "\" must be finite and >= 0, got "
                                                                             << stiffness[c] << ".");
    if (stiffness[c] > 0) require_movable_along(c, stiffness_names[c], obstacle, dim, path, point);
  }
  return stiffness;
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
    require_finite_of_time(fields[c], path + "->" + name, texts[c]);
  }
  return fields;
}

} // namespace

Teuchos::ParameterList valid_obstacle_parameters()
{
  Teuchos::ParameterList valid("Obstacle");
  const std::vector<Choice> all = choices();
  std::vector<std::string> types{"none"};
  for (const Choice &c : all) types.insert(types.end(), c.kind.types.begin(), c.kind.types.end());
  set_words(valid, "Type", types, "Shape of the foundation's surface: " + types_help(all) + ", or `none`: see Gap.");
  for (const ListParameter &p : list_parameters(all)) {
    if (p.is_point)
      set_fields(valid, p.name, p.help() + " [m]. Numbers, or expressions of t.");
    else if (const auto *const words = std::get_if<std::vector<std::string>>(&p.parameter.standard))
      set_words(valid, p.name, *words, p.help() + ".");
    else
      set_standard(valid, p);
  }
  for (const char *const name : force_names)
    set_field(valid, name, "",
              std::string("Force in ") + (name + 6) +
                  " on the obstacle [N], in the plane per m, axisymmetric on the whole circumference: it moves along " +
                  (name + 6) + " as far as the force moves it. A number or an expression of t.");
  for (const char *const name : stiffness_names)
    valid.set(name, 0.,
              std::string("Stiffness of a spring in ") + (name + 10) +
                  " between the obstacle and the ground [N/m], in the plane per m, axisymmetric on the whole "
                  "circumference; >= 0, alone or with Force " +
                  (name + 10) + ". At rest where the obstacle starts.");
  return valid;
}

Obstacle obstacle_options(const Teuchos::ParameterList &list, const int dim, const std::string &path,
                          const FieldParser &parse, const FileReader &read_file)
{
  const auto &type = list.get<std::string>("Type");
  const std::vector<Choice> all = choices();
  const std::vector<ListParameter> parameters = list_parameters(all);
  const std::string types = types_of(all);
  if (list.getEntry("Type").isDefault())
    for (const ListParameter &p : parameters)
      RPC_REQUIRE(list.getEntry(p.name).isDefault(),
                  "deck: \"" << path << "\" has a \"" << p.name
                             << "\" and no \"Type\", so that there is no obstacle. Types: " << types);
  for (const auto *const names : {&force_names, &stiffness_names})
    for (const char *const name : *names)
      RPC_REQUIRE(!list.getEntry("Type").isDefault() || list.getEntry(name).isDefault(),
                  "deck: \"" << path << "\" has a \"" << name
                             << "\" and no \"Type\", so that there is no obstacle to move. Types: " << types);
  if (type == "none") return {}; // switches an obstacle off, whatever it was
  const auto choice = std::find_if(all.begin(), all.end(), [&](const Choice &c) { return c.is(type); });
  RPC_REQUIRE(choice != all.end(),
              "deck: \"" << path << "->Type\" must be one of " << types << ", got \"" << type << "\"");
  RPC_REQUIRE(choice->kind.in_the_plane.empty() || dim == 3,
              "deck: \"" << path << "->Type\" = " << type << " goes with a body in space; use "
                         << choice->kind.in_the_plane << " in the plane");
  for (const ListParameter &p : parameters)
    RPC_REQUIRE(choice->has(p.name) || list.getEntry(p.name).isDefault(),
                "deck: \"" << path << "->" << p.name << "\" does not go with \"" << path << "->Type\" = " << type
                           << ", which has " << names_with(*choice)
                           << (p.is_point ? ". Write \"" + choice->kind.point + "\" for \"" + p.name + "\""
                                          : ". Remove it, or change the type"));
  Obstacle obstacle;
  obstacle.path = path_of(list, choice->kind.point, dim, path, parse);
  obstacle.surface = choice->read(list, dim, path, read_file);
  for (int c = 0; c < dim; ++c) obstacle.point[c] = obstacle.path[c]({});
  obstacle.origin = obstacle.point;
  obstacle.force = forces_of(list, obstacle, dim, path, choice->kind.point, parse);
  obstacle.stiffness = stiffnesses_of(list, obstacle, dim, path, choice->kind.point);
  return obstacle;
}

bool Obstacle::moves() const
{
  return is_moved() ||
         std::any_of(path.begin(), path.end(), [](const ScalarField &coordinate) { return !coordinate.is_constant(); });
}

Obstacle Obstacle::seen_at(const double t) const
{
  Obstacle seen = *this;
  for (int c = 0; c < 3; ++c) {
    seen.path[c] = path[c].seen_at(t);
    if (!path[c].is_constant()) seen.point[c] = seen.path[c]({});
    if (force[c]) seen.force[c] = force[c]->seen_at(t);
  }
  return seen;
}

std::optional<Point> direction_into(const Obstacle &obstacle, const Point &x)
{
  return obstacle.surface.value().direction_into(difference(x, obstacle.point));
}

std::string no_direction_at(const Obstacle &obstacle)
{
  return obstacle.surface.value().no_direction_at;
}

std::string point_name(const Obstacle &obstacle)
{
  return obstacle.surface.value().point;
}

bool lies_in(const Obstacle &obstacle, const Point &x)
{
  return obstacle.surface.value().lies_in(difference(x, obstacle.point));
}

std::optional<double> distance_along(const Obstacle &obstacle, const Point &x, const Point &direction)
{
  return obstacle.surface.value().distance_along(difference(x, obstacle.point), direction);
}

} // namespace rpc::contact
