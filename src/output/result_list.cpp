// SPDX-License-Identifier: BSD-3-Clause
#include "output/result_list.hpp"

#include "rpc/contact/highest_pressure.hpp"
#include "rpc/io/error_bar.hpp"
#include "rpc/mesh/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

namespace rpc
{
namespace
{

constexpr const char *no_bar_at_all = "no error of this number is estimated";

Result vector_result(const std::string &key, const std::array<double, 3> &v, const int dim, const std::string &unit)
{
  Result result;
  result.key = key;
  result.value.assign(v.begin(), v.begin() + dim);
  result.is_vector = true;
  result.unit = unit;
  result.no_bar = no_bar_at_all;
  return result;
}

/// The numbers of a record that the summary shows. A line of the console none of whose numbers is > 0 may be left out.
template <class Table, class Record>
void add_results(std::vector<Result> &all, const Table &table, const Record &record, const ResultScope &scope)
{
  const auto numbers = defined_numbers(table, scope);
  const auto heading = [](const auto &q) { return std::string(q.shown.heading ? q.shown.heading : ""); };
  for (const auto &q : numbers) {
    if (!q.shown.summary) continue;
    Result result;
    result.key = q.name(scope);
    const bool shown = std::any_of(numbers.begin(), numbers.end(), [&](const auto &other) {
      return heading(other) == heading(q) && (!other.shown.only_positive || record.*other.value > 0);
    });
    if (shown) result.line = heading(q);
    result.label = q.shown.label;
    result.value = {record.*q.value};
    result.unit = q.unit_name(scope);
    result.no_bar = no_bar_at_all;
    all.push_back(result);
  }
}

std::vector<Result> contact_results(const contact::ContactSums &sums, const ResultScope &scope, const int dim)
{
  Result force = vector_result("contact_force", sums.force, dim, scope.units.of(unit::force, scope.per_length));
  force.line = "contact force";
  std::vector<Result> all{force};
  add_results(all, contact::contact_quantities, sums, scope);
  return all;
}

/// Gives the components of the contact force error bars of their own, where some are smaller than that of the vector.          (10.7f)
void add_bars_of_components(Result &force, const std::vector<double> &bars)
{
  const std::size_t dim = force.value.size();
  if (bars.size() < dim || !(force.error_bar > 0)) return;
  double squares = 0;
  std::string fixed;
  for (std::size_t c = 0; c < dim; ++c) {
    squares += bars[c] * bars[c];
    if (bars[c] == 0 && force.value[c] != 0) fixed += std::string(fixed.empty() ? "" : ", ") + "XYZ"[c];
  }
  if (std::all_of(bars.begin(), bars.begin() + dim, [&](const double bar) { return bar == force.error_bar; })) return;
  force.error_bars.assign(bars.begin(), bars.begin() + dim);
  force.error_bar = std::min(force.error_bar, std::sqrt(squares));
  if (!fixed.empty()) force.more += ", along " + fixed + " fixed by the load";
}

/// Gives results that have an error bar theirs, and the others of those that may have one their reasons.
void add_error_bars(std::vector<Result> &all, const adapt::ObservedErrors &errors, const ResultScope &scope,
                    const bool told)
{
  for (const auto &q : defined_numbers(adapt::error_bars, scope))
    for (Result &result : all) {
      if (result.key != q.name(scope)) continue;
      result.error_bar = errors.*q.value;
      const bool any = std::any_of(result.value.begin(), result.value.end(), [](const double x) { return x != 0; });
      if (result.key == "contact_force" && result.error_bar == 0 && any) result.more += ", fixed by the load";
      const auto reason = errors.unknown.find(q.key);
      result.no_bar = reason == errors.unknown.end() ? "" : reason->second;
      result.tells_why = told && std::isnan(result.error_bar);
    }
}

/// An interval that certainly holds J gives its bar, where the estimate is not the shorter one. Of a box alone: the interval of another
/// mesh is that of a body whose curved sides are polygons.
void add_bounded_energy(std::vector<Result> &all, const Scene &scene, const Solution &s)
{
  if (!s.bound || !s.bound->missing.empty() || !std::holds_alternative<mesh::BoxOptions>(scene.mesh)) return;
  if (s.bound->of != bound::EnergyBound::Of::energy) return; // the interval counts friction's work, which J is without
  const double bar = std::max(s.bound->upper - s.energy, s.energy - s.bound->lower);
  for (Result &result : all) {
    if (result.key != "energy_J" || result.error_bar <= bar) continue;
    result.error_bar = bar;
    result.no_bar.clear();
    result.tells_why = false;
  }
}

/// Of those that an obstacle is on [N/m]; 0: there is none.
double stiffest_spring(const Scene &scene)
{
  double most = 0;
  for (const auto &side : scene.model.contact)
    for (const double stiffness : side.obstacle.stiffness) most = std::max(most, stiffness);
  return most;
}

/// Those of supports and of what forces move, which are unknown where that of the contact force is.
void add_bars_of_entries(std::vector<Result> &all, const Scene &scene, const Solution &s,
                         const adapt::ObservedErrors &errors)
{
  const auto reason = errors.unknown.find("contact_force");
  const auto &conditions = scene.model.dirichlet;
  const auto &sides = s.step.elastic.dirichlet.rigid;
  const adapt::MotionErrors &motions = errors.motions;
  const auto of_condition = [&](const Result &result, const std::vector<double> &bars) {
    for (std::size_t k = 0; k < bars.size(); ++k)
      if (conditions[k].name == result.entry) return bars[k];
    return std::numeric_limits<double>::quiet_NaN();
  };
  const auto of_rigid_side = [&](const Result &result, const std::vector<double> &bars) {
    for (std::size_t j = 0; j < bars.size() && j < sides.size(); ++j)
      if (conditions[sides[j].condition].name == result.entry) return bars[j];
    return std::numeric_limits<double>::quiet_NaN();
  };
  for (Result &result : all) {
    const std::string &key = result.key;
    const bool moves = key == "force_displacement" || key == "rigid_rotation" || key == "rigid_moment";
    const bool of_obstacle = key == "obstacle_displacement" || key == "obstacle_spring_force";
    if (!moves && key != "reaction_force" && !of_obstacle) continue;
    result.no_bar = reason == errors.unknown.end() ? "" : reason->second;
    if (!result.no_bar.empty()) continue;
    result.error_bar = key == "reaction_force"          ? of_condition(result, errors.reactions)
                       : key == "force_displacement"    ? of_condition(result, motions.displacements)
                       : key == "rigid_rotation"        ? of_rigid_side(result, motions.rotations)
                       : key == "rigid_moment"          ? of_rigid_side(result, motions.moments)
                       : key == "obstacle_spring_force" ? motions.obstacle * stiffest_spring(scene)
                                                        : motions.obstacle;
    if (!std::isinf(result.error_bar)) continue;
    result.error_bar = std::numeric_limits<double>::quiet_NaN();
    result.no_bar = "how soft the body is against its load is not known: the last step took no linear solve";
  }
}

double length_of(const std::vector<double> &vector)
{
  double length = 0;
  for (const double component : vector) length = std::hypot(length, component);
  return length;
}

/// A foundation that does not give way is penetrated by what the solver's tolerance leaves of displacements, and a support that bears nothing
/// has what rounding leaves of the other forces, as the sum of sides has whose forces cancel.
/// @param largest  force of a side [N]
void mark_nothing(std::vector<Result> &all, const double max_displacement, const double tolerance, double largest = 0)
{
  constexpr double rounding = 1e-11; // of the largest force
  const auto is_force = [](const Result &result) {
    return result.key == "contact_force" || result.key == "reaction_force";
  };
  for (const Result &result : all)
    if (is_force(result)) largest = std::max(largest, length_of(result.value));
  for (Result &result : all) {
    if (!is_force(result) && result.key != "max_penetration") continue;
    const double bar = std::isfinite(result.error_bar) ? result.error_bar : 0, value = length_of(result.value);
    if (value > 0 && value + bar <= (result.is_vector ? rounding * largest : tolerance * max_displacement))
      result.nothing_to = result.is_vector ? "to rounding" : "to the solver's tolerance";
  }
}

/// The estimates that the console shows on a line of their own, relative to the norms of the estimated quantities.
void add_estimates(std::vector<Result> &all, const Scene &scene, const Solution &s, const adapt::ObservedErrors &errors)
{
  if (!s.estimate) return;
  const auto add = [&](const char *const key, const double share) {
    Result estimate;
    estimate.key = key;
    estimate.value = {share};
    estimate.no_bar = "it is an estimate of an error";
    all.push_back(estimate);
  };
  add("estimated_error", relative_estimate(s));
  if (std::isfinite(errors.contact_pressure) && !scene.model.contact.empty())
    add("contact_pressure_error", errors.contact_pressure);
}

/// "(0.5, 0) m"
std::string place_text(const std::vector<double> &place, const double size, const std::string &unit)
{
  std::string text;
  for (const double coordinate : place) {
    char number[40];
    std::snprintf(number, sizeof number, "%.6g", std::abs(coordinate) > 1e-9 * size ? coordinate : 0);
    text += (text.empty() ? "(" : ", ") + std::string(number);
  }
  return text + ") " + unit;
}

/// Tells where the largest pressure is. Collective.
void add_place(std::vector<Result> &all, const Scene &scene, const Solution &s)
{
  const auto pressure =
      std::find_if(all.begin(), all.end(), [](const Result &result) { return result.key == "max_pressure"; });
  if (pressure == all.end() || !s.has_results()) return;
  const auto highest = contact::highest_pressure(s.discretization, s.step.contact, s.contact);
  if (highest.num_places == 0) return;
  pressure->num_places = highest.num_places;
  pressure->place.assign(highest.place.begin(), highest.place.begin() + s.discretization.dim());
  pressure->more = " at " + place_text(pressure->place, s.discretization.diameter, scene.model.units.length);
  if (scene.model.contact.size() > 1)
    pressure->more += " on \"" + scene.model.contact[highest.side].name_in_results() + "\"";
  if (const GO others = highest.num_places - 1; others > 0)
    pressure->more += " and " + std::to_string(others) + " other node" + (others > 1 ? "s" : "");
}

/// Rotations and moments of rigid sides, whose displacements and forces are those of the other conditions.
void add_rigid_results(std::vector<Result> &all, const Scene &scene, const Solution &s, const ResultScope &scope)
{
  const auto &sides = s.step.elastic.dirichlet.rigid;
  const int dim = s.discretization.dim();
  const double size = s.discretization.diameter;
  double largest = 0;
  for (const auto &force : s.reactions) largest = std::max(largest, length(force));
  for (std::size_t j = 0; j < sides.size() && j < s.rigid_forces.size(); ++j) {
    if (sides[j].motions.back() < 3) continue; // of a body of revolution
    const auto add = [&](const char *const key, const std::string &line, const fem::SixNumbers &six,
                         const std::string &unit, const double nothing, const char *const why) {
      Result result = vector_result(key, {six[3], six[4], six[5]}, 3, unit);
      if (dim == 2) {
        result.value = {six[5]};
        result.is_vector = false;
      }
      result.entry = scene.model.dirichlet[sides[j].condition].name;
      result.line = line + " \"" + result.entry + "\"";
      const double value = length_of(result.value);
      if (value > 0 && value <= nothing) result.nothing_to = why;
      all.push_back(result);
    };
    add("rigid_rotation", "rotation of", s.rigid_motions[j], "rad",
        scene.step.uzawa.tolerance * s.body.displacement / size, "to the solver's tolerance");
    add("rigid_moment", "moment at", s.rigid_forces[j],
        scope.units.moment() + (scope.per_length ? "/" + scope.units.length : ""), 1e-11 * largest * size,
        "to rounding");
  }
}

} // namespace

std::optional<Point> obstacle_moved(const Scene &scene, const Solution &s)
{
  const auto &sides = scene.model.contact;
  if (std::none_of(sides.begin(), sides.end(), [](const auto &side) { return side.obstacle.is_moved(); })) return {};
  if (s.has_results()) return analysis::obstacle_displacement(scene.model, s.time, s.step.obstacle);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  return Point{unknown, unknown, unknown};
}

std::optional<Point> obstacle_spring_force(const Scene &scene, const Solution &s)
{
  auto force = analysis::spring_force_on_obstacle(scene.model, s.step.obstacle);
  if (force && !s.has_results()) force->fill(std::numeric_limits<double>::quiet_NaN());
  return force;
}

std::vector<Result> result_list(const Scene &scene, const Solution &s)
{
  const ResultScope scope = analysis::result_scope(scene.model, s.discretization);
  const int dim = s.discretization.dim();
  std::vector<Result> all;
  if (!scene.model.contact.empty()) all = contact_results(s.contact.total, scope, dim);
  if (scene.model.contact.size() > 1)
    all.front().more =
        ", the vector sum of " + std::to_string(scene.model.contact.size()) + " sides, each of which stands below";
  for (std::size_t k = 0; k < scene.model.dirichlet.size() && k < s.reactions.size(); ++k) {
    Result reaction =
        vector_result("reaction_force", s.reactions[k], dim, scope.units.of(unit::force, scope.per_length));
    reaction.entry = scene.model.dirichlet[k].name;
    reaction.line = "reaction at \"" + reaction.entry + "\"";
    all.push_back(reaction);
  }
  for (std::size_t k = 0; k < scene.model.dirichlet.size() && k < s.displacements.size(); ++k) {
    const fem::DirichletCondition &condition = scene.model.dirichlet[k];
    if (!condition.is_moved()) continue;
    Result displacement = vector_result("force_displacement", s.displacements[k], dim, scope.units.length);
    displacement.entry = condition.name;
    displacement.line = "displacement of \"" + condition.name + "\"";
    all.push_back(displacement);
  }
  add_rigid_results(all, scene, s, scope);
  if (const auto moved = obstacle_moved(scene, s)) {
    Result displacement = vector_result("obstacle_displacement", *moved, dim, scope.units.length);
    displacement.line = "displacement of the obstacle";
    all.push_back(displacement);
  }
  if (const auto drawn = obstacle_spring_force(scene, s)) {
    Result force = vector_result("obstacle_spring_force", *drawn, dim, scope.units.of(unit::force, scope.per_length));
    force.line = "spring of the obstacle";
    all.push_back(force);
  }
  add_results(all, analysis::body_quantities, s.body, scope);
  Result energy;
  energy.key = "energy_J";
  energy.line = "energy J";
  energy.value = {s.energy};
  energy.unit = scope.units.of(unit::energy, scope.per_length);
  all.push_back(energy);
  const auto last = std::find_if(s.history.rbegin(), s.history.rend(), [](const auto &step) { return step.converged; });
  if (s.has_results() && last != s.history.rend()) add_results(all, analysis::energy_quantities, last->energies, scope);
  // Of a sequence of meshes each number has its own reason, else one holds for all.
  const adapt::ObservedErrors errors = adapt::errors_of(scene, s);
  add_place(all, scene, s);
  add_bars_of_entries(all, scene, s, errors);
  add_error_bars(all, errors, scope, s.adaptation && std::isfinite(s.adaptation->errors.energy));
  for (Result &result : all)
    if (result.key == "contact_force") add_bars_of_components(result, adapt::contact_force_bars(scene, s));
  add_bounded_energy(all, scene, s);
  double largest = 0;
  for (const auto &side : s.contact.sides) largest = std::max(largest, length(side.force));
  mark_nothing(all, s.body.displacement, scene.step.uzawa.tolerance, largest);
  add_estimates(all, scene, s, errors);
  return all;
}

std::vector<Result> side_results(const Scene &scene, const Solution &s, const std::size_t side)
{
  auto all = contact_results(s.contact.sides[side], analysis::result_scope(scene.model, s.discretization),
                             s.discretization.dim());
  mark_nothing(all, s.body.displacement, scene.step.uzawa.tolerance);
  return all;
}

std::string text_of(const Result &result)
{
  if (!result.nothing_to.empty())
    return "0" + (result.unit.empty() ? "" : " " + result.unit) + " (" + result.nothing_to + ")" + result.more;
  const std::string number = result.is_vector ? io::with_error_bar(result.value, result.error_bar, result.unit)
                                              : io::with_error_bar(result.value.front(), result.error_bar, result.unit);
  return number + result.more;
}

} // namespace rpc
