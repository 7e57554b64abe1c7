// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/contact_options.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace rpc::contact
{

const std::array<LawParameter, 6> law_parameters{
    {{&ContactOptions::yield_stress, "Yield Stress", "> 0 [Pa] (inf for a rigid foundation)", false, true},
     {&ContactOptions::hardening, "Hardening", "finite and >= 0 [Pa/m]", true, false},
     {&ContactOptions::stiffness, "Stiffness", "> 0 [Pa/m] (inf for a foundation that is rigid until it yields)", false,
      true},
     {&ContactOptions::friction_coefficient, "Friction Coefficient", "finite and >= 0 (0: no friction)", true, false},
     {&ContactOptions::friction_bound, "Friction Bound", "finite and >= 0 [Pa]", true, false},
     {&ContactOptions::friction_limit, "Friction Limit", "> 0 [Pa] (inf: none)", false, true}}};

bool LawParameter::allows(const double value) const
{
  return (value > 0 || (may_be_zero && value == 0)) && (may_be_infinite || std::isfinite(value));
}

std::string LawParameter::rule(const std::string &path) const
{
  return "deck: \"" + path + "->" + name + "\" must be " + bound + ", got ";
}

bool has_friction(const std::vector<ContactOptions> &options)
{
  return std::any_of(options.begin(), options.end(), [](const ContactOptions &side) { return side.has_friction(); });
}

namespace
{

/// Parameters of one contact side.
void add_side_parameters(Teuchos::ParameterList &valid)
{
  set_field(valid, "Yield Stress", "inf",
            "xi > 0 [Pa]: pressure at which the foundation gives way; `inf`: rigid (Signorini). Number or expression.");
  set_field(valid, "Hardening", "0",
            "H >= 0 [Pa/m]: what the yield stress grows by with the depth of the dent. Number or expression.");
  set_field(valid, "Stiffness", "inf",
            "k > 0 [Pa/m]: the foundation is a spring before it yields, p = k v; `inf`: rigid. Number or expression.");
  set_field(
      valid, "Friction Coefficient", "0",
      "mu >= 0: a point sticks up to the traction mu p along the side, p the pressure, and slips at it. Number or "
      "expression.");
  set_field(
      valid, "Friction Bound", "0",
      "s_0 >= 0 [Pa]: what friction bears whatever the pressure, where the body does not touch too (Tresca); adds "
      "to mu p. Number or expression.");
  set_field(valid, "Friction Limit", "inf",
            "s_max > 0 [Pa]: the most that friction bears; `inf`: no limit. Number or expression.");
  set_field(valid, "Gap", "0",
            "g [m]: distance to the foundation along the normal, where there is no obstacle; < 0: initial penetration. "
            "Number or expression.");
  valid.set("Normal", "",
            "Direction in which contact acts: `surface` (outward normal of the body), `foundation` (normal of the "
            "obstacle), or a fixed one as numbers, `0, -1`. Default: `foundation` with an obstacle, else `surface`.");
  valid.sublist("Obstacle", false, "Surface of the foundation, from which the gap follows.") =
      valid_obstacle_parameters();
  set_words(valid, "Remembers", {"auto", "true", "false"},
            "Whether the foundation keeps its dents from one of `Steps` to the next: `auto` (it does), `true`, or "
            "`false` for a law "
            "that is reversible.");
  set_words(valid, "Dents Move With", {"body", "foundation"},
            "Where dents stay if the body slides or the obstacle moves along itself, between `Steps`: `body`, at the "
            "body's points (small motions), or `foundation`, where they lie: a point meets the dents at its place.");
  set_field(valid, "Penalty", "auto",
            "r of the modified Lagrangian: `auto` (from the stiffness and the weight of each node), or a number > 0 "
            "[Pa/m] to "
            "start from. It is raised where the iteration is slow; the solution does not depend on it.");
}

/// Unit vector from a text like "0, -1".
std::optional<Point> direction_from(const std::string &text, const int dim)
{
  std::istringstream in(text);
  Point direction{};
  char comma = ',';
  for (int c = 0; c < dim; ++c)
    if ((c > 0 && !(in >> comma)) || comma != ',' || !(in >> direction[c])) return std::nullopt;
  const double length = std::hypot(direction[0], direction[1], direction[2]);
  if (in >> comma || !(length > 0) || !std::isfinite(length)) return std::nullopt;
  for (double &component : direction) component /= length;
  return direction;
}

/// @return 0 for auto
double penalty_from(const std::string &text, const std::string &path)
{
  if (text == "auto") return 0;
  std::istringstream in(text);
  double penalty = 0;
  const bool number = (in >> penalty) && in.eof();
  RPC_REQUIRE(number && penalty > 0 && std::isfinite(penalty),
              "deck: \"" << path << "->Penalty\" must be `auto` or a finite number > 0 [Pa/m], got " << text);
  return penalty;
}

ContactOptions side_options(const Teuchos::ParameterList &list, const std::string &path, const std::string &side,
                            const int dim, const FieldParser &parse, const FileReader &read_file)
{
  ContactOptions options;
  options.path = path;
  options.side = side;
  options.yield_stress = parse(field_text(list, "Yield Stress"), path + "->Yield Stress");
  options.hardening = parse(field_text(list, "Hardening"), path + "->Hardening");
  options.stiffness = parse(field_text(list, "Stiffness"), path + "->Stiffness");
  options.friction_coefficient = parse(field_text(list, "Friction Coefficient"), path + "->Friction Coefficient");
  options.friction_bound = parse(field_text(list, "Friction Bound"), path + "->Friction Bound");
  options.friction_limit = parse(field_text(list, "Friction Limit"), path + "->Friction Limit");
  options.gap = parse(field_text(list, "Gap"), path + "->Gap");
  options.obstacle = obstacle_options(list.sublist("Obstacle"), dim, path + "->Obstacle", parse, read_file);
  const auto &remembers = list.get<std::string>("Remembers");
  RPC_REQUIRE(remembers == "auto" || remembers == "true" || remembers == "false",
              "deck: \"" << path << "->Remembers\" must be one of auto, true, false, got \"" << remembers << "\"");
  options.remembers = remembers != "false";
  const auto &carrier = list.get<std::string>("Dents Move With");
  RPC_REQUIRE(carrier == "body" || carrier == "foundation",
              "deck: \"" << path << "->Dents Move With\" must be body or foundation, got \"" << carrier << "\"");
  RPC_REQUIRE(carrier == "body" || options.remembers,
              "deck: \"" << path << "->Dents Move With\" = foundation does not go with \"" << path
                         << "->Remembers\" = false: there are no dents");
  options.dents_move_with = carrier == "body" ? DentsMoveWith::body : DentsMoveWith::foundation;
  options.penalty = penalty_from(field_text(list, "Penalty"), path);
  const bool obstacle = options.obstacle.exists();
  const auto &normal = list.get<std::string>("Normal");
  for (const LawParameter &parameter : law_parameters)
    RPC_REQUIRE(!(options.*parameter.field).is_constant() || parameter.allows((options.*parameter.field).constant),
                parameter.rule(path) << (options.*parameter.field).text);
  RPC_REQUIRE(!obstacle || list.getEntry("Gap").isDefault(), "deck: \"" << path << "->Gap\" does not go with \"" << path
                                                                        << "->Obstacle\", from which the gap follows");
  RPC_REQUIRE(obstacle || normal != "foundation",
              "deck: \"" << path << "->Normal\" = foundation needs an \"" << path << "->Obstacle\"");
  if (normal.empty()) {
    options.normal = obstacle ? Normal::foundation : Normal::surface;
  } else if (normal == "surface" || normal == "foundation") {
    options.normal = normal == "surface" ? Normal::surface : Normal::foundation;
  } else {
    const auto direction = direction_from(normal, dim);
    RPC_REQUIRE(direction, "deck: \"" << path << "->Normal\" must be surface, foundation or " << dim
                                      << " numbers that are not all 0, as in \"" << (dim == 2 ? "0, -1" : "0, 0, -1")
                                      << "\", got \"" << normal << "\"");
    options.normal = Normal::fixed;
    options.direction = *direction;
  }
  return options;
}

/// The last name of a path.
std::string entry_of(const std::string &path)
{
  const std::size_t arrow = path.rfind("->");
  return arrow == std::string::npos ? path : path.substr(arrow + 2);
}

/// Names several foundations of one side after their entries, and proves that all names in the results differ.
void name_for_results(std::vector<ContactOptions> &options)
{
  for (ContactOptions &own : options) {
    for (const ContactOptions &other : options) {
      if (&other == &own || other.side != own.side) continue;
      own.name = entry_of(own.path);
      RPC_REQUIRE(own.obstacle.exists() || other.obstacle.exists(),
                  "deck: \"" << own.path << "\" and \"" << other.path << "\" both name the side \"" << own.side
                             << "\"; give it one contact law, or each an \"Obstacle\" of its own");
    }
  }
  for (std::size_t a = 0; a < options.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      RPC_REQUIRE(options[a].name_in_results() != options[b].name_in_results(),
                  "deck: \"" << options[b].path << "\" and \"" << options[a].path << "\" both stand as \""
                             << options[a].name_in_results() << "\" in the results; give one of them another name");
}

} // namespace

Teuchos::ParameterList valid_contact_parameters()
{
  Teuchos::ParameterList valid("Contact"), entry;
  valid.set("Side", "", "Side of the body that may touch the foundation; empty: none but those of `Sides`.");
  add_side_parameters(valid);
  entry.set(
      "Side", "",
      "Side of the body; by default the side that the entry is named after. Several entries may name one side, each "
      "with an `Obstacle` of its own, such as the flanks of a groove.");
  add_side_parameters(entry);
  set_named_entries(valid, "Sides", entry, "Further contact sides, any number of entries with names of your choice.");
  return valid;
}

std::vector<ContactOptions> contact_options(const Teuchos::ParameterList &list, const int dim, const FieldParser &parse,
                                            const FileReader &read_file)
{
  std::vector<ContactOptions> options;
  // Read even where it names no side: a wrong value is wrong in any case.
  const ContactOptions first = side_options(list, "Contact", list.get<std::string>("Side"), dim, parse, read_file);
  if (!first.side.empty()) options.push_back(first);
  if (list.getEntry("Side").isDefault()) // empty by hand: contact is switched off, whatever it was
    for (auto it = list.begin(); it != list.end(); ++it)
      RPC_REQUIRE(list.isSublist(list.name(it)) || list.entry(it).isDefault(),
                  "deck: \"Contact->"
                      << list.name(it)
                      << "\" acts nowhere: \"Contact\" has no \"Side\". Name the side that may touch the foundation");
  const Teuchos::ParameterList &sides = list.sublist("Sides");
  for (auto it = sides.begin(); it != sides.end(); ++it) {
    const std::string name = sides.name(it);
    const Teuchos::ParameterList &entry = sides.sublist(name);
    const std::string side = entry.get<std::string>("Side").empty() ? name : entry.get<std::string>("Side");
    options.push_back(side_options(entry, "Contact->Sides->" + name, side, dim, parse, read_file));
  }
  name_for_results(options);
  return options;
}

} // namespace rpc::contact
