// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "boundary.hpp"
#include "bounded.hpp"
#include "cells.hpp"
#include "constant_field.hpp"
#include "galerkin.hpp"
#include "local_terms.hpp"
#include "rpc/bound/bound.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>

/// What bounds in the plane and in space share, for sides, inputs and contact terms of both.
namespace rpc::bound
{

/// Of a solution, on the host.
inline PointTractions tractions_of(const contact::ContactResult &contact)
{
  const auto along = to_host(contact.traction);
  PointTractions on_host{HostView<double *>("rpc::bound::pressure", contact.pressure.extent(0)),
                         HostView<double **>("rpc::bound::friction", along.extent(0), along.extent(1))};
  Kokkos::deep_copy(on_host.pressure, contact.pressure);
  for (std::size_t i = 0; i < along.extent(0); ++i)
    for (std::size_t d = 0; d < along.extent(1); ++d) on_host.along(i, d) = along(i, d);
  return on_host;
}

/// What J counts with the friction of a side.
inline EnergyBound::Of kind_of_friction(const contact::ContactOptions &options)
{
  const auto coefficient = value_everywhere(options.friction_coefficient);
  return coefficient == 0. ? EnergyBound::Of::energy_and_friction : EnergyBound::Of::energy_and_fixed_friction;
}

/// The solution's displacement out of rigid foundations: the bound takes how far that is, and what J counts.
template <class Side>
HostView<double *> moved_out(const analysis::Problem &problem, const analysis::Model &model,
                             const analysis::StepSolution &s, const std::vector<Side> &sides, EnergyBound &bound)
{
  const fem::Discretization &d = problem.discretization();
  for (std::size_t k = 0; k < sides.size(); ++k)
    if (sides[k].friction.acts) bound.of = std::max(bound.of, kind_of_friction(model.contact[k]));
  const HostView<double *> moved = host_copy(*s.u);
  for (const Side &side : sides) move_out(side, *d.mesh, moved);
  Vector way(*vector_of(moved, d.owned_dofs), Teuchos::Copy);
  way.update(-1, *s.u, 1);
  if (way.norm2() > 0)
    bound.moved = std::sqrt(std::max(0., fem::internal_work(d, model.materials, way).energy_norm_squared));
  return moved;
}

/// The Galerkin solution: the bound takes its time and iterations, and why there is none.
template <class Input>
Solved timed_galerkin_solution(const analysis::Problem &problem, const analysis::StepSolution &s,
                               const solver::LinearSolverOptions &options, const Input &in,
                               const BoundaryTractions &tractions, EnergyBound &bound)
{
  const double start = Teuchos::Time::wallTime();
  Solved galerkin = galerkin_solution(problem, s, options, in, tractions);
  bound.solve_seconds = Teuchos::Time::wallTime() - start;
  bound.linear_iterations = galerkin.iterations;
  if (!galerkin.failure.empty()) bound.missing = galerkin.failure;
  return galerkin;
}

/// What contact misses in each owned cell of contact facets.
template <class Input, class Side, class Terms>
std::vector<std::pair<LO, double>> gaps_of_cells(const Input &in, const std::vector<Side> &sides, const Terms &contact)
{
  const auto cell = to_host(in.facets.cell);
  std::vector<std::pair<LO, double>> gaps;
  for (std::size_t k = 0; k < sides.size(); ++k)
    for (std::size_t f = 0; f < sides[k].facet.size(); ++f) {
      const LO facet = sides[k].facet[f], at = facet < 0 ? -1 : cell(facet, 0);
      if (at >= 0 && at < in.num_owned_cells) gaps.push_back({at, contact.gap_of[k][f]});
    }
  return gaps;
}

/// The interval, norms and local terms that the descent leads to.                          doc/bounds.md (13.8), (13.10)
/// @param left     at its end   @param falls  of the energy by its steps [J]
/// @param lift     norm of the stresses that take up loads beyond the order
/// @param of_cell  (owned cells) parts of left.energy
/// @return rho of (13.13) [J^(1/2)]
template <class Input, class Side, class Terms>
double take_descent(const Comm &comm, const Input &in, const std::vector<Side> &sides, const Terms &contact,
                    const StressDifference &left, const std::vector<double> &falls, const double lift,
                    const DeviceView<double *> &of_cell, EnergyBound &bound)
{
  bound.imbalance = left.force > 0 ? left.imbalance / left.force : 0;
  double energy = left.energy;
  const double stress_norm = std::sqrt(2 * energy) + lift;
  for (auto fall = falls.rbegin();; ++fall) {
    const double norm = std::sqrt(2 * energy) + lift;
    bound.steps.insert(bound.steps.begin(), norm * norm / 2 + contact.gap);
    if (fall == falls.rend()) break;
    energy += *fall;
  }
  const double best = bound.steps.back();
  bound.lower = bound.upper - best;
  bound.energy_norm = std::sqrt(2 * best) + bound.moved;
  bound.squared = local_terms(comm, of_cell, left.energy > 0 ? stress_norm * stress_norm / (2 * left.energy) : 0,
                              gaps_of_cells(in, sides, contact), bound.energy_norm * bound.energy_norm);
  if (!(bound.imbalance <= 1e-8))
    bound.missing = "cells are out of balance by " + shown(bound.imbalance) + " of their forces";
  return std::sqrt(stress_norm * stress_norm / 4 + contact.gap);
}

/// @param loads, all  tractions on the boundary without and with those of contact   @param squared  bounds of |w|^2
template <class Input>
Works works_of(const analysis::Problem &problem, const Input &in, const BoundaryTractions &loads,
               const BoundaryTractions &all, const std::function<Squared(const Vector &)> &squared)
{
  const fem::Discretization &d = problem.discretization();
  const auto work_with = [&d, in](const BoundaryTractions &tractions) {
    return [&d, in, tractions](const Vector &w) { return work_of(d, known_moments(in, tractions), in, w); };
  };
  return {work_with(loads), work_with(all), squared};
}

/// |w|^2 by the elements' integrals, which are exact.
inline std::function<Squared(const Vector &)> squared_by_elements(const analysis::Problem &problem)
{
  return [&problem](const Vector &w) {
    return fem::internal_work(problem.discretization(), problem.model().materials, w).energy_norm_squared;
  };
}

} // namespace rpc::bound
