// SPDX-License-Identifier: BSD-3-Clause
/// What the deck's `Rigid` may have.
#include "component_name.hpp"
#include "of_time_alone.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/fem/dirichlet.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::fem
{
namespace
{

std::vector<int> all_motions_of(const int dim, const Kinematics kinematics)
{
  if (kinematics == Kinematics::axisymmetric) return {1};
  return dim == 2 ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
}

/// Why a body has no such motion, and what it has.
std::string has_motions(const int dim, const Kinematics kinematics)
{
  if (kinematics == Kinematics::axisymmetric)
    return "a body of revolution does not have. Its rigid sides move along the axis: give Y, Force Y or Stiffness Y";
  return std::to_string(dim) + "D bodies do not have. Rigid sides in the plane have X, Y and Rotation Z";
}

Point point_option(const Teuchos::Array<double> &numbers, const std::string &path, const int dim)
{
  RPC_REQUIRE(numbers.size() == dim,
              "deck: \"" << path << "->Point\" must have " << dim << " numbers, got " << numbers.size() << ".");
  Point point{};
  for (int c = 0; c < dim; ++c) {
    RPC_REQUIRE(std::isfinite(numbers[c]), "deck: \"" << path << "->Point\" must be finite, got " << numbers[c] << ".");
    point[c] = numbers[c];
  }
  return point;
}

double stiffness_option(const double stiffness, const std::string &parameter)
{
  RPC_REQUIRE(std::isfinite(stiffness) && stiffness >= 0,
              "deck: \"" << parameter << "\" must be finite and >= 0, got " << stiffness << ".");
  return stiffness;
}

} // namespace

std::string name_of_motion(const int motion)
{
  return (motion < 3 ? "" : "Rotation ") + std::string(component_name[motion % 3]);
}

std::string name_of_force(const int motion)
{
  return (motion < 3 ? "Force " : "Moment ") + std::string(component_name[motion % 3]);
}

std::string name_of_stiffness(const int motion)
{
  return (motion < 3 ? "Stiffness " : "Rotation Stiffness ") + std::string(component_name[motion % 3]);
}

std::vector<int> RigidMotions::unknown() const
{
  std::vector<int> all;
  for (const int k : motions)
    if (!displacement[k]) all.push_back(k);
  return all;
}

bool RigidMotions::moves(const int component) const
{
  const std::vector<int> all = unknown();
  return std::any_of(all.begin(), all.end(), [&](const int k) { return k < 3 ? k == component : k - 3 != component; });
}

RigidMotions RigidMotions::seen_at(const double t) const
{
  RigidMotions now = *this;
  for (auto *const fields : {&now.displacement, &now.force})
    for (auto &field : *fields)
      if (field) field = field->seen_at(t);
  return now;
}

Teuchos::ParameterList valid_rigid_parameters()
{
  Teuchos::ParameterList entry;
  entry.set("Side", "", "Side of the mesh; by default the side that the entry is named after.");
  entry.set("Point", Teuchos::Array<double>(),
            "Reference point of rotations, forces and moments [m], 2 numbers, in space 3. By default the side's "
            "centroid.");
  for (int k = 0; k < 3; ++k)
    set_field(entry, name_of_motion(k), "",
              std::string("Displacement of the reference point in ") + component_name[k] +
                  " [m], a number or an expression of t. Without it the side moves as far as forces, springs and the "
                  "body move it.");
  for (int k = 3; k < 6; ++k)
    set_field(entry, name_of_motion(k), "",
              std::string("Rotation about ") + component_name[k % 3] +
                  " through the reference point [rad], a number or an expression of t. Without it the side turns as "
                  "far as moments, springs and the body turn it. In the plane only Rotation Z, from X to Y.");
  for (int k = 0; k < 3; ++k)
    set_field(entry, name_of_force(k), "",
              std::string("Force in ") + component_name[k] +
                  " at the reference point [N], in the plane per m, axisymmetric on the whole circumference. A number "
                  "or an expression of t. Instead of " +
                  component_name[k] + ".");
  for (int k = 3; k < 6; ++k)
    set_field(
        entry, name_of_force(k), "",
        std::string("Moment about ") + component_name[k % 3] +
            " through the reference point [N m], in the plane per m. A number or an expression of t. Instead of " +
            name_of_motion(k) + ".");
  for (int k = 0; k < 3; ++k)
    entry.set(name_of_stiffness(k), 0.,
              std::string("Stiffness of a spring in ") + component_name[k] +
                  " between the reference point and the ground [N/m], in the plane per m; >= 0. Instead of " +
                  component_name[k] + ", alone or with " + name_of_force(k) + ".");
  for (int k = 3; k < 6; ++k)
    entry.set(name_of_stiffness(k), 0.,
              std::string("Stiffness of a spring about ") + component_name[k % 3] +
                  " between the reference point and the ground [N m/rad], in the plane per m; >= 0. Instead of " +
                  name_of_motion(k) + ", alone or with " + name_of_force(k) + ".");
  Teuchos::ParameterList parent;
  set_named_entries(parent, "Rigid", entry,
                    "Sides that are held rigid, any number of entries with names of your choice. All nodes of such a "
                    "side move as one rigid piece; motions that are not named are free of force.");
  return parent.sublist("Rigid");
}

std::vector<DirichletCondition> rigid_options(const Teuchos::ParameterList &list, const int dim,
                                              const Kinematics kinematics, const FieldParser &parse)
{
  std::vector<DirichletCondition> conditions;
  for (auto it = list.begin(); it != list.end(); ++it) {
    DirichletCondition condition;
    condition.name = list.name(it);
    const Teuchos::ParameterList &entry = list.sublist(condition.name);
    const std::string path = "Rigid->" + condition.name;
    condition.side = entry.get<std::string>("Side").empty() ? condition.name : entry.get<std::string>("Side");
    RigidMotions rigid;
    rigid.motions = all_motions_of(dim, kinematics);
    const auto &point = entry.get<Teuchos::Array<double>>("Point");
    if (point.size() > 0) rigid.point = point_option(point, path, dim);
    for (int k = 0; k < 6; ++k) {
      const std::string motion = name_of_motion(k), force = name_of_force(k), stiffness = name_of_stiffness(k);
      const bool has = std::find(rigid.motions.begin(), rigid.motions.end(), k) != rigid.motions.end();
      for (const std::string &name : {motion, force, stiffness})
        RPC_REQUIRE(has || entry.getEntry(name).isDefault(), "deck: \"" << path << "->" << name
                                                                        << "\" is of a motion that "
                                                                        << has_motions(dim, kinematics) << ".");
      const auto field = [&](const std::string &name) -> std::optional<ScalarField> {
        const std::string text = field_text(entry, name), parameter = path + "->" + name;
        if (text.empty()) return std::nullopt;
        const ScalarField parsed = parse(text, parameter);
        require_of_time_alone(parsed, parameter, "Give a number or an expression of t.", "it is of the whole side");
        return parsed;
      };
      rigid.displacement[k] = field(motion);
      rigid.force[k] = field(force);
      rigid.stiffness[k] = stiffness_option(entry.get<double>(stiffness), path + "->" + stiffness);
      for (const std::string &name : {force, stiffness})
        RPC_REQUIRE(!rigid.displacement[k] || entry.getEntry(name).isDefault(),
                    "deck: \"" << path << "\" must have " << motion << " or " << name
                               << ", got both. Leave one of them out.");
    }
    condition.rigid = rigid;
    conditions.push_back(condition);
  }
  return conditions;
}

} // namespace rpc::fem
