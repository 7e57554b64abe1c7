// SPDX-License-Identifier: BSD-3-Clause
#include "earlier_steps.hpp"
#include "rpc/adapt/observed_error.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <variant>

namespace rpc::adapt
{

std::optional<mesh::MeshOptions> with_larger_cells(const mesh::MeshOptions &options)
{
  constexpr double twice = 2;
  const auto *const gmsh = std::get_if<mesh::GmshOptions>(&options);
  if (!gmsh) return mesh::coarser(options, twice);
  mesh::GmshOptions larger = *gmsh;
  if (gmsh->refinements > 0) {
    --larger.refinements;
  } else if (gmsh->nested) {
    if (gmsh->sizes) { // on rank 0
      auto sizes = std::make_shared<mesh::SizeField>(*gmsh->sizes);
      for (double &size : sizes->size) size *= twice;
      larger.sizes = sizes;
    }
    if (larger.box) { // the first mesh, too
      larger.box = std::get<mesh::BoxOptions>(*mesh::coarser(*larger.box, twice));
      larger.base = nullptr;
    }
  } else {
    const auto coarse = mesh::coarser(options, twice);
    if (!coarse) return coarse;
    larger.size_factor = std::get<mesh::GmshOptions>(*coarse).size_factor;
  }
  return larger;
}

EarlierSteps earlier_steps(const Task &task, const Solution &s)
{
  EarlierSteps earlier;
  earlier.matter = contact::has_friction(task.model.contact);
  earlier.largest_estimate = s.largest_estimate;
  earlier.misread = s.earlier_misread;
  for (const analysis::StepRecord &step : s.history) {
    if (!step.converged || step.time > s.time) continue;
    const double force = force_at_work(step.contact.force, step.reactions);
    if (force > 0 && step.body.displacement > 0)
      earlier.moved_by = std::max(earlier.moved_by, std::min(2 * step.energies.strain / force, step.body.displacement));
    if (step.time < s.time && step.contact.max_dent > 0) earlier.matter = true;
  }
  return earlier;
}

LeftOpen misread_so_far(const Solution &s)
{
  LeftOpen most = s.earlier_misread;
  if (!s.adaptation || s.adaptation->cycles.empty()) return most;
  const auto own = left_by_misreading(s.adaptation->cycles[best_of(s.adaptation->cycles)]);
  return {std::max(most.force, own.force), std::max(most.energy, own.energy),
          std::max(most.penetration, own.penetration)};
}

analysis::HistoryState state_of(const Solution &s)
{
  const LeftOpen misread = misread_so_far(s);
  return {s.discretization,    s.mesh_options,     *s.memory,     std::nullopt,   s.history,
          s.matrix_assemblies, s.largest_estimate, misread.force, misread.energy, misread.penetration};
}

Solution step_of(analysis::HistoryState state)
{
  Solution s;
  s.time = state.last.time;
  s.discretization = std::move(state.discretization);
  s.mesh_options = std::move(state.mesh_options);
  s.memory = std::move(state.last);
  s.history = std::move(state.records);
  s.matrix_assemblies = state.matrix_assemblies;
  s.largest_estimate = state.largest_estimate;
  s.earlier_misread = {state.misread_force, state.misread_energy, state.misread_penetration};
  return s;
}

} // namespace rpc::adapt
