// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/bound/goals.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <limits>

namespace rpc::bound
{
namespace
{

constexpr Goal::Type all_types[] = {Goal::Type::mean_displacement, Goal::Type::mean_pressure,
                                    Goal::Type::contact_force};

/// What is between the corners that "Box" gives.
std::optional<Box> part_option(const Teuchos::ParameterList &entry, const std::string &path, const int dim)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto &corners = entry.get<Teuchos::Array<double>>("Box");
  if (corners.empty()) return {};
  Box part{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  RPC_REQUIRE(static_cast<int>(corners.size()) == 2 * dim,
              "deck: \"" << path << "->Box\" must have " << 2 * dim
                         << " numbers, the lower corner and the upper one, got " << corners.size());
  for (int d = 0; d < dim; ++d) {
    part.low[d] = corners[d];
    part.high[d] = corners[dim + d];
    RPC_REQUIRE(part.low[d] <= part.high[d], "deck: \"" << path
                                                        << "->Box\" must have the lower corner before the upper one, "
                                                           "got "
                                                        << part.low[d] << " and " << part.high[d] << " in "
                                                        << "XYZ"[d]);
  }
  return part;
}

} // namespace

const char *name_of(const Goal::Type type)
{
  switch (type) {
  case Goal::Type::mean_displacement:
    return "mean displacement";
  case Goal::Type::mean_pressure:
    return "mean pressure";
  default:
    return "contact force";
  }
}

Unit unit_of(const Goal::Type type)
{
  switch (type) {
  case Goal::Type::mean_displacement:
    return unit::length;
  case Goal::Type::mean_pressure:
    return unit::pressure;
  default:
    return unit::force;
  }
}

Teuchos::ParameterList valid_goal_parameters()
{
  Teuchos::ParameterList entry, parent;
  set_words(entry, "Type", {"mean displacement", "mean pressure", "contact force"},
            "`mean displacement` of a side along an axis [m], `mean pressure` of a contact side or of a part of it "
            "[Pa], `contact force`: the integral of this pressure [N], in the plane per m.");
  entry.set("Side", "", "Side of the mesh; by default the side that the entry is named after.");
  set_words(entry, "Component", {"X", "Y", "Z"}, "Of a mean displacement: the axis.");
  entry.set("Box", Teuchos::Array<double>(),
            "Of pressures: lower and upper corner [m] of what they are taken in; 4 numbers, in space 6. By default the "
            "whole side.");
  set_named_entries(parent, "Goals", entry,
                    "Numbers to be told with an interval that certainly holds that of the exact solution, any number "
                    "of entries with names of your choice. They need \"Adapt->Error Bound\" = guaranteed.");
  return parent.sublist("Goals");
}

std::vector<Goal> goal_options(const Teuchos::ParameterList &list, const int dim)
{
  std::vector<Goal> goals;
  for (auto it = list.begin(); it != list.end(); ++it) {
    Goal goal;
    goal.name = list.name(it);
    const Teuchos::ParameterList &entry = list.sublist(goal.name);
    const auto &side = entry.get<std::string>("Side"), &type = entry.get<std::string>("Type"),
               &component = entry.get<std::string>("Component");
    goal.side = side.empty() ? goal.name : side;
    bool known = false;
    for (const Goal::Type each : all_types)
      if (type == name_of(each)) {
        goal.type = each;
        known = true;
      }
    RPC_REQUIRE(known, "deck: \"" << goal.path()
                                  << "->Type\" must be one of mean displacement, mean pressure, contact force, got \""
                                  << type << "\"");
    const bool of_displacement = goal.type == Goal::Type::mean_displacement;
    const std::size_t axis = std::string("XYZ").substr(0, dim).find(component);
    RPC_REQUIRE(component.size() == 1 && axis != std::string::npos,
                "deck: \"" << goal.path() << "->Component\" must be one of " << (dim == 2 ? "X, Y" : "X, Y, Z")
                           << ", got \"" << component << "\"");
    goal.component = static_cast<int>(axis);
    RPC_REQUIRE(of_displacement || entry.getEntry("Component").isDefault(),
                "deck: \"" << goal.path() << "->Component\" goes with mean displacements, and Type = " << type
                           << " is along the side's normal. Leave it out");
    RPC_REQUIRE(!of_displacement || entry.getEntry("Box").isDefault(),
                "deck: \"" << goal.path()
                           << "->Box\" goes with pressures; a mean displacement is that of a whole side. Leave it out, "
                              "or give the part a name in \"Mesh->Sides\"");
    goal.part = part_option(entry, goal.path(), dim);
    goals.push_back(goal);
  }
  return goals;
}

} // namespace rpc::bound
