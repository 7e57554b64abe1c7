// SPDX-License-Identifier: BSD-3-Clause
#include "output/history.hpp"

#include "output/quantities.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/io/contact_csv.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

namespace rpc
{
namespace
{

/// The counts of a step that are columns, in their places.
auto count_columns(const ResultScope &scope)
{
  std::vector<Quantity<analysis::StepRecord, int>> counts(analysis::step_parts.begin(), analysis::step_parts.end());
  counts.insert(counts.end(), analysis::step_work.begin(), analysis::step_work.end());
  return history_columns(counts, scope);
}

/// The rotations that a condition has: those of a rigid side.
std::vector<int> rotations_of(const fem::DirichletCondition &condition)
{
  std::vector<int> rotations;
  if (condition.rigid)
    std::copy_if(condition.rigid->motions.begin(), condition.rigid->motions.end(), std::back_inserter(rotations),
                 [](const int motion) { return motion >= 3; });
  return rotations;
}

/// Whether a force or a spring moves an obstacle.
bool is_moved(const Scene &scene)
{
  const auto &sides = scene.model.contact;
  return std::any_of(sides.begin(), sides.end(), [](const auto &side) { return side.obstacle.is_moved(); });
}

std::string heading(const Scene &scene, const int dim, const ResultScope &scope)
{
  const std::string axes = "xyz";
  std::ostringstream text;
  text << "time";
  write_names(text, history_columns(analysis::energy_quantities, scope), scope);
  write_names(text, history_columns(contact::contact_quantities, scope), scope);
  const auto in = [&](const Unit &unit) { return scope.units.heading(unit, scope.per_length); };
  for (int c = 0; c < dim; ++c) text << ",contact_force_" << axes[c] << in(unit::force);
  if (scene.model.contact.size() > 1)
    for (const auto &side : scene.model.contact)
      for (int c = 0; c < dim; ++c)
        text << ',' << io::csv_quoted(side.name_in_results() + "_contact_force_" + axes[c] + in(unit::force));
  for (const auto &condition : scene.model.dirichlet)
    for (const auto &[what, unit] : {std::pair("_displacement_", unit::length), std::pair("_reaction_", unit::force)})
      for (int c = 0; c < dim; ++c) text << ',' << io::csv_quoted(condition.name + what + axes[c] + in(unit));
  const std::string moment =
      scope.units.is_default() ? ""
                               : " [" + scope.units.moment() + (scope.per_length ? "/" + scope.units.length : "") + "]";
  for (const auto &condition : scene.model.dirichlet)
    for (const auto &[what, unit] : {std::pair("_rotation_", std::string()), std::pair("_moment_", moment)})
      for (const int k : rotations_of(condition))
        text << ',' << io::csv_quoted(condition.name + what + axes[k - 3] + unit);
  if (is_moved(scene))
    for (int c = 0; c < dim; ++c) text << ",obstacle_displacement_" << axes[c] << in(unit::length);
  if (analysis::spring_force_on_obstacle(scene.model, {}))
    for (int c = 0; c < dim; ++c) text << ",obstacle_spring_force_" << axes[c] << in(unit::force);
  write_names(text, count_columns(scope), scope);
  text << ",seconds,converged,reason";
  write_names(text, history_columns(analysis::body_quantities, scope), scope);
  write_names(text, history_columns(contact::patch_quantities, scope), scope);
  text << '\n';
  return text.str();
}

std::string row(const Scene &scene, const analysis::StepRecord &step, const int dim, const ResultScope &scope)
{
  std::ostringstream text;
  text.precision(17);
  text << step.time;
  write_values(text, history_columns(analysis::energy_quantities, scope), step.energies);
  write_values(text, history_columns(contact::contact_quantities, scope), step.contact);
  for (int c = 0; c < dim; ++c) text << ',' << step.contact.force[c];
  if (step.side_forces.size() > 1)
    for (const auto &force : step.side_forces)
      for (int c = 0; c < dim; ++c) text << ',' << force[c];
  for (std::size_t k = 0; k < step.reactions.size(); ++k) {
    for (int c = 0; c < dim; ++c) text << ',' << step.displacements[k][c];
    for (int c = 0; c < dim; ++c) text << ',' << step.reactions[k][c];
  }
  std::size_t rigid = 0;
  for (const auto &condition : scene.model.dirichlet) {
    if (!condition.rigid) continue;
    for (const auto *const of_steps : {&step.rigid_motions, &step.rigid_forces})
      for (const int k : rotations_of(condition)) text << ',' << (*of_steps)[rigid][k];
    ++rigid;
  }
  for (int c = 0; c < dim && is_moved(scene); ++c) text << ',' << step.obstacle[c];
  const auto drawn = analysis::spring_force_on_obstacle(scene.model, step.obstacle);
  for (int c = 0; c < dim && drawn; ++c) text << ',' << (*drawn)[c];
  write_values(text, count_columns(scope), step);
  text << ',' << step.seconds << ',' << (step.converged ? 1 : 0) << ',' << io::csv_quoted(step.reason);
  write_values(text, history_columns(analysis::body_quantities, scope), step.body);
  write_values(text, history_columns(contact::patch_quantities, scope), step.patches);
  text << '\n';
  return text.str();
}

} // namespace

void HistoryFile::update(const std::string &path, const Scene &scene, const analysis::Solution &s)
{
  const int dim = s.discretization.dim();
  const ResultScope scope = analysis::result_scope(scene.model, s.discretization);
  on_root(s.discretization.mesh->comm(), ExitCode::internal_error, [&] {
    std::string rows;
    for (std::size_t k = rows_; k < s.history.size(); ++k) rows += row(scene, s.history[k], dim, scope);
    if (!file_)
      file_ = std::make_unique<io::GrowingFile>(path, heading(scene, dim, scope) + rows);
    else
      file_->append(rows);
  });
  rows_ = s.history.size();
}

} // namespace rpc
