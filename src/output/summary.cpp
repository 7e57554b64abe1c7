// SPDX-License-Identifier: BSD-3-Clause
#include "output/summary.hpp"

#include "output/quantities.hpp"
#include "output/result_list.hpp"
#include "rpc/analysis/side_displacements.hpp"
#include "rpc/contact/contact_patches.hpp"

#include <cmath>

namespace rpc
{
namespace
{

nlohmann::ordered_json vector_json(const std::array<double, 3> &v, const int dim)
{
  return std::vector<double>(v.begin(), v.begin() + dim);
}

void add_sums(nlohmann::ordered_json &json, const contact::ContactSums &sums, const ResultScope &scope, const int dim)
{
  json["contact_nodes"] = sums.num_nodes;
  json["contact_force"] = vector_json(sums.force, dim);
  add_shown(json, contact::contact_quantities, sums, scope);
}

/// Where the body lies in the foundation between contact points.
nlohmann::ordered_json place_json(const Scene &scene, const contact::PlaceBetweenNodes &at, const int dim)
{
  return {{"penetration", at.depth},
          {"side", scene.model.contact[at.side].name_in_results()},
          {"place", vector_json(at.place, dim)},
          {"width", at.width},
          {"facet", at.facet}};
}

/// How contact is spread over each contact side. Collective.
nlohmann::ordered_json patches_json(const Scene &scene, const Solution &s)
{
  auto json = nlohmann::ordered_json::object();
  if (!s.has_results()) return json;
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto patches =
      contact::contact_patches(mesh, contact::contact_sides(mesh, scene.model.contact), s.step.contact, s.contact);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const contact::ContactPatches &of_side = patches[k];
    std::vector<double> ends;
    for (int bin = 0; bin <= contact::ContactPatches::bins; ++bin)
      ends.push_back(of_side.max_pressure * bin / contact::ContactPatches::bins);
    json[scene.model.contact[k].name_in_results()] = {
        {"mean_gap", of_side.mean_gap},
        {"count", of_side.size.size()},
        {"sizes", of_side.size},
        {"pressure_histogram", {{"ends", ends}, {"sizes", of_side.size_by_pressure}}}};
  }
  return json;
}

/// Names of the units of this file's numbers.
nlohmann::ordered_json units_json(const ResultScope &scope)
{
  const auto name = [&](const Unit &unit) { return scope.units.of(unit, scope.per_length); };
  return {{"length", name(unit::length)},
          {"force", name(unit::force)},
          {"stress", name(unit::pressure)},
          {"energy", name(unit::energy)}};
}

/// A number that may be unknown: null then.
nlohmann::ordered_json maybe(const double value)
{
  return std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
}

/// Each result by its key, those of a list's entries by their names.
nlohmann::ordered_json results_json(const std::vector<Result> &results)
{
  auto json = nlohmann::ordered_json::object();
  for (const Result &result : results) {
    nlohmann::ordered_json entry;
    entry["value"] = result.is_vector ? nlohmann::ordered_json(result.value) : nlohmann::ordered_json(result.value[0]);
    entry["unit"] = result.unit.empty() ? "1" : result.unit;
    entry["error_bar"] = maybe(result.error_bar);
    if (!result.error_bars.empty()) entry["error_bars"] = result.error_bars;
    if (std::isnan(result.error_bar)) entry["reason"] = result.no_bar;
    if (!result.place.empty()) {
      entry["place"] = result.place;
      entry["nodes"] = result.num_places;
    }
    (result.entry.empty() ? json[result.key] : json[result.key][result.entry]) = entry;
  }
  return json;
}

void add_results(nlohmann::ordered_json &json, const Scene &scene, const Solution &s)
{
  json["results"] = results_json(result_list(scene, s));
  const auto &sides = scene.model.contact;
  for (std::size_t k = 0; k < sides.size() && sides.size() > 1; ++k)
    json["results"]["contact_sides"][sides[k].name_in_results()] = results_json(side_results(scene, s, k));
}

void add_steps(nlohmann::ordered_json &json, const Solution &s, const ResultScope &scope)
{
  auto &steps = json["steps"] = nlohmann::ordered_json::array();
  for (const analysis::StepRecord &step : s.history) {
    nlohmann::ordered_json entry = {{"time", step.time}, {"converged", step.converged}};
    if (!step.converged) entry["reason"] = step.reason;
    add_shown(entry, analysis::energy_quantities, step.energies, scope);
    add_shown(entry, analysis::body_quantities, step.body, scope);
    add_sums(entry, step.contact, scope, s.discretization.dim());
    add_shown(entry, contact::patch_quantities, step.patches, scope);
    add_shown(entry, analysis::step_parts, step, scope);
    add_shown(entry, analysis::step_work, step, scope);
    entry["seconds"] = step.seconds;
    steps.push_back(entry);
  }
}

void add_balance(nlohmann::ordered_json &json, const Scene &scene, const Solution &s)
{
  if (!s.out_of_balance) return;
  const analysis::OutOfBalance &off = *s.out_of_balance;
  const double tolerance = scene.steps.energy_tolerance;
  json["energy_tolerance"] = {{"tolerance", tolerance},
                              {"kept", off.steps == 0},
                              {"reason", analysis::not_kept(off, tolerance, s.history.size())}};
  if (off.steps == 0) return;
  json["energy_tolerance"]["steps"] = off.steps;
  json["energy_tolerance"]["largest"] = off.share;
  json["energy_tolerance"]["at"] = off.at;
}

nlohmann::ordered_json goals_json(const std::vector<bound::GoalBound> &goals)
{
  auto json = nlohmann::ordered_json::object();
  for (const bound::GoalBound &b : goals) {
    nlohmann::ordered_json &goal = json[b.goal.name];
    goal["type"] = bound::name_of(b.goal.type);
    goal["value"] = maybe(b.value);
    goal["estimated_error"] = maybe(b.estimated_error);
    goal["interval"] = b.missing.empty() ? nlohmann::ordered_json({b.lower, b.upper}) : nlohmann::ordered_json();
    goal["reason"] = b.missing;
  }
  return json;
}

nlohmann::ordered_json bound_json(const bound::EnergyBound &b)
{
  nlohmann::ordered_json json;
  const bool known = b.missing.empty();
  json["kind"] = "guaranteed";
  json["of"] = bound::name_of(b.of);
  json["energy_J"] = known ? nlohmann::ordered_json({b.lower, b.upper}) : nlohmann::ordered_json();
  json["energy_norm"] = known ? nlohmann::ordered_json(b.energy_norm) : nlohmann::ordered_json();
  json["reason"] = b.missing;
  json["contact_force"] = nlohmann::ordered_json::array();
  json["contact_force_reasons"] = nlohmann::ordered_json::array();
  for (const bound::ForceBound &force : b.contact_force) {
    const bool has_bound = force.missing.empty();
    json["contact_force"].push_back(has_bound ? nlohmann::ordered_json({force.lower, force.upper})
                                              : nlohmann::ordered_json());
    json["contact_force_reasons"].push_back(force.missing);
  }
  json["moved_by"] = b.moved;
  json["by_step"] = b.steps;
  json["imbalance"] = b.imbalance;
  json["linear_iterations"] = b.linear_iterations;
  json["solve_seconds"] = b.solve_seconds;
  json["seconds"] = b.seconds;
  return json;
}

void add_bound_and_goals(nlohmann::ordered_json &json, const bound::EnergyBound &b)
{
  json["error_bound"] = bound_json(b);
  if (!b.goals.empty()) json["goals"] = goals_json(b.goals);
}

void add_bound(nlohmann::ordered_json &json, const Scene &scene, const Solution &s)
{
  if (s.bound) add_bound_and_goals(json, *s.bound);
  if (scene.adapt.bound != adapt::ErrorBound::estimated || !s.has_results() || !s.estimate) return;
  const double bar = errors_of(scene, s).energy;
  const bool known = !std::isnan(bar);
  json["error_bound"] = {{"kind", "estimated"}};
  json["error_bound"]["energy_J"] =
      known ? nlohmann::ordered_json({s.energy - bar, s.energy + bar}) : nlohmann::ordered_json();
  json["error_bound"]["energy_norm"] = std::sqrt(s.estimate->total());
}

nlohmann::ordered_json cycle_json(const adapt::Cycle &c, const ResultScope &scope, const int dim)
{
  nlohmann::ordered_json json = {{"dofs", c.dofs},
                                 {"relative_estimate", c.estimate},
                                 {"energy_J", c.energy},
                                 {"contact_force", vector_json(c.contact.force, dim)}};
  for (const auto &q : defined_numbers(contact::contact_quantities, scope))
    if (q.shown.meshes) json[q.name(scope)] = c.contact.*q.value;
  json["newton_iterations"] = c.newton_iterations;
  json["linear_iterations"] = c.linear_iterations;
  if (c.bound) add_bound_and_goals(json, *c.bound);
  json["seconds"] = c.seconds;
  return json;
}

void add_errors(nlohmann::ordered_json &json, const Scene &scene, const Solution &s)
{
  if (!s.estimate) return;
  const double relative = relative_estimate(s), exact = exact_error(scene, s);
  auto &estimate = json["error_estimate"];
  estimate["energy_norm"] = std::sqrt(s.estimate->total());
  estimate["relative"] = relative;
  estimate["at_least"] = s.estimate->misses_contact();
  for (const adapt::ErrorPart &part : s.estimate->parts) estimate[part.key] = std::sqrt(part.squared);
  estimate["rounding"] = std::sqrt(s.estimate->rounding);
  estimate["exact_relative"] = maybe(exact);
  estimate["effectivity"] = maybe(relative / exact);
  if (!s.adaptation) return;
  const adapt::Adaptation &a = *s.adaptation;
  json["adaptation"] = {{"target", scene.adapt.target}, {"reached", a.reached}, {"reason", a.reason}};
  const ResultScope scope = analysis::result_scope(scene.model, s.discretization);
  add_shown(json["adaptation"]["errors"], adapt::error_bars, a.errors, scope);
  auto &unknown = json["adaptation"]["errors_unknown"] = nlohmann::ordered_json::object();
  for (const auto &[key, reason] : a.errors.unknown) unknown[adapt::error_bar_name(key, scope)] = reason;
  auto &cycles = json["adaptation"]["cycles"] = nlohmann::ordered_json::array();
  for (const adapt::Cycle &c : a.cycles) cycles.push_back(cycle_json(c, scope, s.discretization.dim()));
}

/// Of each rigid side its motion, and the force and moment with which what holds it acts on the body. In the plane rotations and moments are
/// numbers.
nlohmann::ordered_json rigid_json(const Scene &scene, const Solution &s)
{
  const int dim = s.discretization.dim();
  auto all = nlohmann::ordered_json::object();
  const auto &sides = s.step.elastic.dirichlet.rigid;
  for (std::size_t j = 0; j < sides.size() && j < s.rigid_forces.size(); ++j) {
    auto &json = all[scene.model.dirichlet[sides[j].condition].name];
    const auto part = [&](const fem::SixNumbers &six, const int first) {
      return vector_json({six[first], six[first + 1], six[first + 2]}, dim);
    };
    const fem::SixNumbers &q = s.rigid_motions[j], &f = s.rigid_forces[j];
    json["point"] = vector_json(sides[j].point, dim);
    json["displacement"] = part(q, 0);
    if (dim == 3) json["rotation"] = part(q, 3);
    if (sides[j].motions.back() == 5 && dim == 2) json["rotation"] = q[5];
    json["force"] = part(f, 0);
    if (dim == 3) json["moment"] = part(f, 3);
    if (sides[j].motions.back() == 5 && dim == 2) json["moment"] = f[5];
  }
  return all;
}

} // namespace

nlohmann::ordered_json summary(const Scene &scene, const Solution &s)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const ResultScope scope = analysis::result_scope(scene.model, s.discretization);
  nlohmann::ordered_json json;
  json["rpc_version"] = RPC_VERSION;
  json["deck"] = scene.name;
  json["converged"] = s.uzawa.converged && !s.failure;
  json["reason"] = s.failure ? s.failure->reason : s.uzawa.reason;
  if (s.failure || (!s.history.empty() && !s.uzawa.converged)) json["failed_at"] = s.failure ? s.failure->time : s.time;
  if (mesh.dim() == 2) json["kinematics"] = fem::name_of(s.discretization.kinematics);
  json["element"] = mesh.element.name();
  json["cells"] = sum_all(mesh.comm(), GO(mesh.num_owned_cells));
  json["dofs"] = s.discretization.owned_dofs->getGlobalNumElements();
  json["fixed_contact_nodes"] = s.step.contact.num_fixed;
  json["ranks"] = mesh.comm().getSize();
  json["execution_space"] = ExecutionSpace::name();
  json["time"] = s.has_results() ? nlohmann::ordered_json(s.time) : nlohmann::ordered_json();
  json["units"] = units_json(scope);
  add_results(json, scene, s);
  json["energy_J"] = s.energy;
  json["strain_energy"] = 0.5 * s.energy_norm_squared;
  json["energy_norm_squared"] = s.energy_norm_squared;
  add_shown(json, analysis::body_quantities, s.body, scope);
  add_sums(json, s.contact.total, scope, mesh.dim());
  json["contact_sides"] = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < scene.model.contact.size(); ++k)
    add_sums(json["contact_sides"][scene.model.contact[k].name_in_results()], s.contact.sides[k], scope, mesh.dim());
  json["contact_patches"] = patches_json(scene, s);
  auto &between = json["between_nodes"] = nlohmann::ordered_json::object();
  if (s.contact.between.deepest.depth > 0)
    between["deepest"] = place_json(scene, s.contact.between.deepest, mesh.dim());
  if (s.contact.between.unseen.depth > 0) between["unseen"] = place_json(scene, s.contact.between.unseen, mesh.dim());
  json["reaction_force"] = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < scene.model.dirichlet.size(); ++k)
    json["reaction_force"][scene.model.dirichlet[k].name] = vector_json(s.reactions[k], mesh.dim());
  json["force_displacement"] = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < s.displacements.size(); ++k)
    if (scene.model.dirichlet[k].is_moved())
      json["force_displacement"][scene.model.dirichlet[k].name] = vector_json(s.displacements[k], mesh.dim());
  json["rigid"] = rigid_json(scene, s);
  if (const auto moved = obstacle_moved(scene, s)) json["obstacle_displacement"] = vector_json(*moved, mesh.dim());
  if (const auto drawn = obstacle_spring_force(scene, s))
    json["obstacle_spring_force"] = vector_json(*drawn, mesh.dim());
  json["side_displacement"] = nlohmann::ordered_json::object();
  std::vector<std::string> sides;
  for (const mesh::Side &side : mesh.sides) sides.push_back(side.name);
  if (s.has_results() && s.u != Teuchos::null)
    for (const auto &side : analysis::side_displacements(s.discretization, *s.u, sides))
      json["side_displacement"][side.side] = {{"mean", vector_json(side.mean, mesh.dim())}, {"max", side.largest}};
  add_shown(json, analysis::residual_quantities, s.uzawa.residuals, scope);
  json["residual_tolerance"] = scene.step.uzawa.tolerance;
  json["multiplier_change"] = s.uzawa.multiplier_change;
  json["uzawa_iterations"] = s.uzawa.iterations;
  json["newton_iterations"] = s.uzawa.newton_iterations;
  json["coarse_choices"] = s.coarse_choices;
  json["line_search_steps"] = s.line_search_steps;
  json["linear_solves"] = s.linear.iterations.size();
  json["linear_iterations"] = s.linear.iterations;
  json["preconditioner_setups"] = s.linear.preconditioner_setups;
  json["local_corrections"] = s.linear.local_corrections;
  json["solver"] = s.linear.description;
  json["solver_path"] = solver::solver_path(s.linear);
  json["candidates"] = nlohmann::ordered_json::array();
  for (const solver::CandidateCounts &c : s.linear.candidates)
    json["candidates"].push_back({{"name", c.name},
                                  {"tried", c.tried},
                                  {"setups", c.setups},
                                  {"solves", c.solves},
                                  {"iterations", c.iterations},
                                  {"left", c.left}});
  json["matrix_assemblies"] = s.matrix_assemblies;
  if (!s.history.empty()) add_steps(json, s, scope);
  add_balance(json, scene, s);
  add_errors(json, scene, s);
  add_bound(json, scene, s);
  json["notes"] = s.notes;
  json["skipped"] = s.skipped;
  json["levels"] = nlohmann::ordered_json::array();
  for (const auto &level : s.levels)
    json["levels"].push_back({{"dofs", level.dofs},
                              {"newton_iterations", level.newton_iterations},
                              {"linear_iterations", level.linear_iterations},
                              {"preconditioner_setups", level.preconditioner_setups},
                              {"seconds", level.seconds}});
  add_shown(json["seconds"], analysis::phase_seconds, s.seconds, scope);
  return json;
}

} // namespace rpc
