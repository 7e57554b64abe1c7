// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/optimality_residuals.hpp"

#include "rpc/contact/energies.hpp"
#include "rpc/contact/rounding.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/fem/rigid_motion.hpp"
#include "rpc/fem/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::contact
{
namespace
{

/// |f|_2 over the unknowns that are not prescribed [N].
double free_norm(const fem::DirichletDofs &dirichlet, const Vector &load)
{
  Vector free(load, Teuchos::Copy);
  fem::clear_prescribed(dirichlet, free);
  return free.norm2();
}

/// u . f over the unknowns that are prescribed, or over the others; collective.
double work(const fem::DirichletDofs &dirichlet, const bool prescribed, const Vector &u, const Vector &f)
{
  const auto fixed = dirichlet.fixed;
  const auto x = device_read(u);
  const auto force = device_read(f);
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::work", device_range(static_cast<LO>(u.getLocalLength())),
      KOKKOS_LAMBDA(const LO dof, double &part) {
        if ((fixed(dof) != 0) == prescribed) part += x(dof) * force(dof);
      },
      sum);
  return sum_all(*u.getMap()->getComm(), sum);
}

/// part/whole, 0 where both are 0.
double ratio(const double part, const double whole)
{
  return part == 0 ? 0 : part / whole;
}

/// Whether J(u), of strains that are rounding, is no larger than where only prescribed displacements move the body.       (5.5c)
bool may_be_the_minimum(const fem::Discretization &d, const fem::Materials &materials,
                        const fem::ElasticProblem &elastic, const ContactNodes &points, const ContactState &state,
                        const double tolerance, const double least_energy)
{
  const RCP<const Vector> start = elastic.dirichlet.value;
  const bool at_rest = start->normInf() == 0;
  const double strain = at_rest ? 0 : 0.5 * fem::internal_work(d, materials, *start).energy_norm_squared;
  const double before = energy_at(strain - elastic.applied_load->dot(*start), points, state.multiplier, start);
  const double of_load = elastic.applied_load->dot(*state.displacement), now = energy(-of_load, points, state);
  const double size = std::max({std::abs(of_load), std::abs(now), std::abs(before)});
  return now <= before + std::max(tolerance * size, least_energy);
}

} // namespace

double OptimalityResiduals::worst() const
{
  double worst = 0;
  for (const double part : {equilibrium_residual, kkt_residual, energy_balance, duality_gap})
    if (!std::isnan(worst) && !(part <= worst)) worst = part;
  return worst;
}

OptimalityResiduals optimality_residuals(const fem::Discretization &d, const fem::Materials &materials,
                                         const fem::ElasticProblem &elastic, const ContactNodes &points,
                                         const ContactState &state, const double force_scale,
                                         const std::function<double(const Vector &)> &residual_energy,
                                         const double least_energy)
{
  const Vector &u = *state.displacement;
  const fem::DirichletDofs &dirichlet = elastic.dirichlet;
  OptimalityResiduals residuals;
  const auto work_of = [&](const Vector &rest) { // (5.2a)
    return fem::internal_work(d, materials, fem::strained_part(d, u, rest));
  };
  residuals.internal = state.rest.is_null() ? fem::internal_work(d, materials, u) : work_of(Vector(u.getMap()));
  const fem::InternalWork within = state.rest.is_null() ? residuals.internal : work_of(*state.rest);
  residuals.forces = within.forces;
  const Vector &internal = *within.forces;
  const double strain = within.energy_norm_squared;
  const Vector contact = multiplier_forces(points, state.multiplier, u.getMap());
  Vector external(*elastic.applied_load, Teuchos::Copy), residual(internal, Teuchos::Copy);
  external.update(-1., contact, 1.);
  // paper (5), a(u, v) = b(v) - (lambda, v_nu) for a lambda in the subdifferential of j
  residual.update(-1., external, 1.);
  fem::subtract_spring_forces(dirichlet, u, residual);
  fem::clear_prescribed(dirichlet, residual);

  residuals.kkt_residual = contact_law_residual(points, state);
  residuals.force_size = std::max({force_scale, contact.norm2(), residuals.internal.force_norm,
                                   Rounding::lifted_part * free_norm(dirichlet, *elastic.load)});
  residuals.equilibrium_residual = residual.norm2() / residuals.force_size;

  const bool at_rest = dirichlet.value->normInf() == 0; // the supports
  const Vector moved = at_rest ? Vector(u, Teuchos::View) : fem::without_rigid_motion(d, dirichlet, u);
  const double of_load = work(dirichlet, false, moved, *elastic.applied_load),
               of_contact = work(dirichlet, false, moved, contact),
               of_supports = work(dirichlet, true, moved, internal);
  const double lifted = std::abs(elastic.load->dot(u));
  const double at_work = std::max(
      {strain, std::abs(of_load), std::abs(of_contact), std::abs(of_supports), Rounding::lifted_part * lifted});
  residuals.energy_balance =
      ratio(std::abs(strain - of_load + of_contact - of_supports), std::max(at_work, least_energy));

  const ContactEnergy energy = contact_energy(points, state);
  residuals.duality_gap = ratio(energy.duality_gap + 0.5 * std::max(0., residual_energy(residual)),
                                std::max({0.5 * strain, energy.dissipated, 1e-12 * lifted, least_energy}));
  residuals.energy_at_work = std::max(at_work, energy.dissipated);
  return residuals;
}

void forgive_energies_of_rounding(const fem::Discretization &d, const fem::Materials &materials,
                                  const fem::ElasticProblem &elastic, const ContactNodes &points,
                                  const ContactState &state, const double tolerance, const double least_energy,
                                  OptimalityResiduals &residuals)
{
  if (residuals.energy_at_work > fem::rounding_energy(d, materials, *state.displacement)) return;
  if (!may_be_the_minimum(d, materials, elastic, points, state, tolerance, least_energy)) return;
  residuals.energy_balance = residuals.duality_gap = 0;
}

double residual_of_rounding(const fem::Discretization &d, const fem::Materials &materials,
                            const fem::DirichletDofs &dirichlet, const Vector &u, const double force_size)
{
  Vector rounded(u.getMap());
  {
    const auto map = u.getMap()->getLocalMap();
    const auto x = device_read(u);
    const auto to = device_write(rounded);
    constexpr double eps = std::numeric_limits<double>::epsilon();
    Kokkos::parallel_for(
        "rpc::contact::rounded", device_range(static_cast<LO>(u.getLocalLength())), KOKKOS_LAMBDA(const LO dof) {
          const bool up = splitmix64(static_cast<std::uint64_t>(map.getGlobalElement(dof))) % 2 == 0;
          to(dof) = (up ? eps : -eps) * x(dof);
        });
    Kokkos::fence();
  }
  Vector forces(*fem::internal_work(d, materials, rounded).forces, Teuchos::Copy);
  fem::clear_prescribed(dirichlet, forces);
  return ratio(forces.norm2(), force_size);
}

} // namespace rpc::contact
