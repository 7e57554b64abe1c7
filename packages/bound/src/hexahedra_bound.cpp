// SPDX-License-Identifier: BSD-3-Clause
#include "hexahedra_bound.hpp"

#include "bound_parts.hpp"
#include "hexahedra.hpp"
#include "space_bound.hpp"
#include "space_boundary.hpp"
#include "space_contact_terms.hpp"
#include "space_descent.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rpc::bound
{
namespace
{

/// Forces of the points are those of their pressures over a third of each triangle around them: an even pressure has to have its own.
void take_areas_of_halves(SpaceContact &c)
{
  std::vector<double> area(c.points.size(), 0.);
  for (std::size_t e = 0; e < c.point.size(); ++e)
    for (int v = 0; v < 3; ++v) area[c.point[e][v]] += c.area[e] / 3;
  for (std::size_t i = 0; i < area.size(); ++i) {
    c.force[i] = area[i] * c.points[i].pressure;
    for (int k = 0; k < 2; ++k) c.friction.force[k][i] = area[i] * c.friction.traction[i][k];
  }
}

Works works_of_hexahedra(const fem::Discretization &of_run, const HexahedraInput &in, const BoundaryTractions &loads,
                         const BoundaryTractions &all)
{
  const auto work_with = [&of_run, in](const BoundaryTractions &tractions) {
    return [&of_run, in, tractions](const Vector &w) {
      const Comm &comm = of_run.mesh->comm();
      const RCP<const Vector> x = fem::on_overlap(of_run, w);
      return work_of_loads(in, comm, tractions, *x) +
             work_of_hexahedra(in, comm, field_of_hexahedra(in, *x)).of_body_force;
    };
  };
  return {work_with(loads), work_with(all), [&of_run, in](const Vector &w) {
            const RCP<const Vector> x = fem::on_overlap(of_run, w);
            return 2 * work_of_hexahedra(in, of_run.mesh->comm(), field_of_hexahedra(in, *x)).energy;
          }};
}

} // namespace

std::string not_covered_of_hexahedra(const analysis::Problem &problem, const analysis::Step &step, FacetsOfMesh &facets)
{
  const analysis::Model model = problem.model().seen_at(step.time);
  const SplitHexahedra split = split_hexahedra(problem.discretization());
  constexpr double least = 1e-3;
  if (!(split.smallest > least))
    return "a part of a hexahedron that is split into six tetrahedra has " + shown(split.smallest) +
           " times the volume of a sixth of it; it has to be more than " + shown(least);
  const fem::Discretization d = fem::discretize(split.mesh);
  facets = std::make_shared<SpaceFacets>(space_facets_of(d));
  SpaceInput in = space_input(d, model, *facets);
  in.of_hexahedra = true;
  boundary_of(d, model, step, in, {HostView<double *>("rpc::bound::none", step.contact.size()), {}});
  return "";
}

Bounded<SpaceContact> bounded_hexahedra(const analysis::Problem &problem, const analysis::StepSolution &s,
                                        const solver::LinearSolverOptions &options, const int steps,
                                        const SpaceFacets &facets, const std::vector<std::string> &flat)
{
  const fem::Discretization &of_run = problem.discretization();
  const Comm &comm = of_run.mesh->comm();
  const analysis::Model model = problem.model().seen_at(s.step.time);
  const SplitHexahedra split = split_hexahedra(of_run);
  const fem::Discretization d = fem::discretize(split.mesh);
  SpaceInput tetrahedra = space_input(d, model, facets);
  tetrahedra.reference = reference_stress(d.mesh->element);
  find_kinds(tetrahedra, comm);
  HexahedraInput in = hexahedra_input(of_run, d, split, tetrahedra, flat);
  SpaceBoundary boundary = boundary_of(d, model, s.step, in, tractions_of(s.contact));
  for (SpaceContact &side : boundary.sides) take_areas_of_halves(side);

  Bounded<SpaceContact> bounded;
  bounded.sides = boundary.sides;
  EnergyBound &bound = bounded.bound;
  const HostView<double *> moved = moved_out(problem, model, s, boundary.sides, bound);
  const RCP<const Vector> u = vector_of(moved, of_run.owned_dofs);
  const RCP<const Vector> on_overlap = fem::on_overlap(of_run, *u);
  const FieldOfHexahedra field = field_of_hexahedra(in, *on_overlap);
  Vector way(*u, Teuchos::Copy);
  way.update(-1, *s.u, 1);
  const RCP<const Vector> way_on_overlap = fem::on_overlap(of_run, way);
  const FieldOfHexahedra moved_by{in, device_read(*way_on_overlap), device_read(*on_overlap), true};
  bound.moved = std::sqrt(std::max(0., 2 * work_of_hexahedra(in, comm, moved_by).energy));
  const SpaceContactTerms contact = contact_terms(boundary.sides, *d.mesh, moved);
  bound.missing = contact.missing;
  const WorkOfHexahedra work = work_of_hexahedra(in, comm, field);
  const double lift =
      boundary.beyond ? norm_of_lifted_loads(in, comm, lifted_loads(d.mesh->element), boundary.tractions.load) : 0;
  bound.upper =
      work.energy - work.of_body_force - work_of_loads(in, comm, boundary.tractions, *on_overlap) + contact.energy;

  const BoundaryTractions all = with_contact(in, boundary, contact.tractions);
  in.shift = shift_of_loads(in, all);
  bounded.u = u;
  bounded.squared = 2 * work.energy;
  bounded.works = works_of_hexahedra(of_run, in, boundary.tractions, all);
  Solved galerkin = timed_galerkin_solution(problem, s, options, in, all, bound);
  if (!bound.missing.empty()) return bounded;

  const SpaceForms forms = cell_forms(in, *on_overlap);
  add_bends_of_faces(in, *on_overlap, forms);
  const Descended after = descended(in, *d.mesh, in.around, all, forms, galerkin.Q,
                                    mean_moments(in, *fem::on_overlap(of_run, *galerkin.u)), steps);
  const DeviceView<double *> of_part("rpc::bound::of_part", in.num_owned_cells);
  const StressDifference left = stress_difference(in, comm, forms, after.t, field, of_part);
  bounded.rho = take_descent(comm, in, boundary.sides, contact, left, after.falls, lift, of_part, bound);
  const DeviceView<double *> of_cell("rpc::bound::of_cell", of_run.mesh->num_owned_cells);
  const auto parts = bound.squared;
  Kokkos::parallel_for(
      "rpc::bound::sum_parts", device_range(of_run.mesh->num_owned_cells), KOKKOS_LAMBDA(const LO h) {
        for (LO c = 6 * h; c < 6 * (h + 1); ++c) of_cell(h) += parts(c);
      });
  Kokkos::fence();
  bound.squared = of_cell;
  return bounded;
}

} // namespace rpc::bound
