// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/smoothed_functional.hpp"

#include "rpc/contact/line_models.hpp"

#include <utility>

namespace rpc::contact
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

/// This rank's sum_i w_i Psi_i(v_i); a point that takes no part has psi_i(v_i).
double energy_at_points(const SmoothedPoints &s, const Vector &u)
{
  const auto x = device_read(u);
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::smoothed_energy", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        const ContactNodes &c = s.points;
        part += c.fixed(i) ? c.weight(i) * foundation_energy(penetration(c, i, x), c.law(i))
                           : s.respond(i, motion(c, i, x)).energy;
      },
      sum);
  return sum;
}

/// F += the forces of all points.
void add_forces(const SmoothedPoints &s, const Vector &u, Vector &F)
{
  const auto x = device_read(u);
  const auto to = device_write(F);
  for_each_point_by_group(
      "rpc::contact::add_forces", s.points, KOKKOS_LAMBDA(const LO i) {
        const Response response = s.respond(i, motion(s.points, i, x));
        for (int k = 0; k < s.points.dim; ++k) to(s.points.dof(i, k)) += response.force[k];
      });
  Kokkos::fence();
}

/// F += the forces on the branches of an active set, less those of the law.
void add_differences(const SmoothedPoints &s, const ActiveSet &active, const Vector &u, Vector &F)
{
  const auto x = device_read(u);
  const auto to = device_write(F);
  for_each_point_by_group(
      "rpc::contact::add_differences", s.points, KOKKOS_LAMBDA(const LO i) {
        const Motion at = motion(s.points, i, x);
        const Response law = s.respond(i, at), branch = s.respond_on_branch(i, active, at);
        for (int k = 0; k < s.points.dim; ++k) to(s.points.dof(i, k)) += branch.force[k] - law.force[k];
      });
  Kokkos::fence();
}

/// The moves of a sweep, from the elastic gradient at u; those of two points of one node add up. With friction only moves along the
/// normals are made, of nodes with one point: any other is slip too, whose energy the move does not weigh.
void move_points(const SmoothedPoints &s, const DeviceView<double *> &stiffness, const Vector &G, Vector &u)
{
  const ContactNodes &c = s.points;
  const DeviceView<double *> move("rpc::contact::move", s.size());
  const auto count = points_of_nodes(c, static_cast<LO>(u.getLocalLength()) / c.dim);
  {
    const auto slope = device_read(G);
    const auto x = device_read(u);
    Kokkos::parallel_for(
        "rpc::contact::best_moves", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
          if (c.fixed(i)) return;
          const double length = squared_length(c, i);
          if (c.friction.exists() && (length < 1 - 1e-12 || (count.extent(0) > 0 && count(c.node(i)) > 1))) return;
          move(i) = best_move(along_direction(c, i, slope) / length, stiffness(i), c.weight(i), penetration(c, i, x),
                              s.multiplier.normal(i), s.penalty(i), c.law(i)) /
                    length;
        });
    Kokkos::fence();
  }
  const auto x = device_write(u);
  for_each_point_by_group(
      "rpc::contact::move_points", c, KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) x(c.dof(i, k)) += move(i) * c.direction(i, k);
      });
  Kokkos::fence();
}

/// (points) -v_i(u): what is left of the gaps once u is the origin.
DeviceView<double *> left_of_gap(const ContactNodes &points, const Vector &u)
{
  const ContactNodes c = points;
  DeviceView<double *> gap("rpc::contact::gap_left", c.size());
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::gap_left", device_range(c.size()), KOKKOS_LAMBDA(const LO i) { gap(i) = -penetration(c, i, x); });
  Kokkos::fence();
  return gap;
}

/// (points, dim) -e_i(u): what slip counts from once u is the origin.
DeviceView<double **> left_of_slip(const ContactNodes &points, const Vector &u)
{
  const ContactNodes c = points;
  DeviceView<double **> from("rpc::contact::slip_from", c.size(), c.dim);
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::slip_left", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { set_row(from, i, slip(c, i, x).scaled(-1)); });
  Kokkos::fence();
  return from;
}

} // namespace

void add_contact_force(const ContactNodes &points, const DeviceView<double *> &p, Vector &F)
{
  const ContactNodes c = points;
  const auto to = device_write(F);
  for_each_point_by_group(
      "rpc::contact::force", c, KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) to(c.dof(i, k)) += c.weight(i) * p(i) * c.direction(i, k);
      });
  Kokkos::fence();
}

SmoothedFunctional::SmoothedFunctional(RCP<const Operator> K, RCP<const Vector> load, const double offset,
                                       SmoothedPoints points)
    : K_(std::move(K)), load_(std::move(load)), offset_(offset), points_(std::move(points))
{
}

SmoothedFunctional SmoothedFunctional::from(const Vector &u, const Vector &out_of_balance) const
{
  const auto load = rcp(new Vector(u.getMap()));
  load->update(-1., out_of_balance, 0.);
  SmoothedPoints points = points_;
  points.points.free_gap = left_of_gap(points.points, u);
  if (points.has_friction()) points.points.friction.from = left_of_slip(points.points, u);
  return {K_, load, offset_, std::move(points)};
}

/// The paper's M of v and l after theorem 5; (4.1)
double SmoothedFunctional::value(const Vector &u) const
{
  Vector Ku(u.getMap());
  K_->apply(u, Ku);
  return 0.5 * u.dot(Ku) - load_->dot(u) + offset_ + sum_all(*u.getMap()->getComm(), energy_at_points(points_, u));
}

void SmoothedFunctional::gradient(const Vector &u, Vector &F) const
{
  elastic_gradient(u, F);
  add_forces(points_, u, F);
}

void SmoothedFunctional::elastic_gradient(const Vector &u, Vector &G) const
{
  K_->apply(u, G);
  G.update(-1., *load_, 1.);
}

void SmoothedFunctional::active_set_gradient(const ActiveSet &active, const Vector &u, const Vector &gradient,
                                             Vector &F) const
{
  F.update(1., gradient, 0.);
  add_differences(points_, active, u, F);
}

void SmoothedFunctional::sweep(const DeviceView<double *> &coupled, Vector &u) const
{
  Vector G(u.getMap());
  elastic_gradient(u, G);
  move_points(points_, coupled, G, u);
}

std::unique_ptr<LineFunction> SmoothedFunctional::along(const Vector &u, const Vector &d, const Vector &F) const
{
  Vector Kd(d.getMap());
  K_->apply(d, Kd);
  return line_model(u.getMap()->getComm(), d.dot(F), d.dot(Kd), points_, u, d);
}

std::unique_ptr<SubspaceFunction>
SmoothedFunctional::within(const Vector &u, const std::vector<RCP<const Vector>> &directions, const Vector &F) const
{
  const std::size_t n = directions.size();
  std::vector<double> at_0(n), elastic(n * n);
  Vector Kd(u.getMap());
  for (std::size_t k = 0; k < n; ++k) {
    const Vector &d = *directions[k];
    K_->apply(d, Kd);
    for (std::size_t l = 0; l <= k; ++l) elastic[n * k + l] = elastic[n * l + k] = Kd.dot(*directions[l]);
    at_0[k] = d.dot(F);
  }
  return subspace_model(u.getMap()->getComm(), std::move(at_0), std::move(elastic), points_, u, directions);
}

DeviceView<double *> SmoothedFunctional::pressures(const Vector &u) const
{
  const SmoothedPoints s = points_;
  DeviceView<double *> p("rpc::contact::pressure", s.size());
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::pressure", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        p(i) = pressure(penetration(s.points, i, x), s.multiplier.normal(i), s.penalty(i), s.points.law(i));
      });
  Kokkos::fence();
  return p;
}

DeviceView<double *> SmoothedFunctional::active_set_pressures(const ActiveSet &active, const Vector &u) const
{
  const SmoothedPoints s = points_;
  DeviceView<double *> p("rpc::contact::active_set_pressure", s.size());
  const auto state = active.state;
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::active_set_pressure", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        p(i) = branch_pressure(state(i), penetration(s.points, i, x), s.multiplier.normal(i), s.penalty(i),
                               s.points.law(i));
      });
  Kokkos::fence();
  return p;
}

void SmoothedFunctional::take_states(const Vector &u, const ActiveSet &active) const
{
  const SmoothedPoints s = points_;
  const ActiveSet to = active;
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::take_states", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        if (s.points.fixed(i)) return;
        const Motion at = motion(s.points, i, x);
        to.state(i) = s.respond(i, at).state;
        if (!s.has_friction()) return;
        const Along a = s.trial_traction(i, at);
        to.slip(i) = slip_state(a, s.bound(i));
        set_row(to.direction, i, a.unit());
        to.cannot_stick(i) = false;
        set_row(to.lever, i, {});
        set_row(to.linearized_at, i, a);
      });
  Kokkos::fence();
}

DeviceView<double **> SmoothedFunctional::tractions(const Vector &u) const
{
  const SmoothedPoints s = points_;
  DeviceView<double **> q("rpc::contact::traction", s.size(), s.points.dim);
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::traction", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        set_row(q, i, admissible_friction(s.trial_traction(i, motion(s.points, i, x)), s.bound(i)));
      });
  Kokkos::fence();
  return q;
}

StateCounts SmoothedFunctional::count_states(const Vector &u) const
{
  const SmoothedPoints s = points_;
  const auto x = device_read(u);
  GO counts[3] = {0, 0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::count_states", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, GO &open, GO &closed, GO &yielding) {
        if (s.points.fixed(i)) return;
        const State now = s.respond(i, motion(s.points, i, x)).state;
        open += now == State::open;
        closed += now == State::closed;
        yielding += now == State::yielding;
      },
      counts[0], counts[1], counts[2]);
  GO all[3];
  Teuchos::reduceAll(*u.getMap()->getComm(), Teuchos::REDUCE_SUM, 3, counts, all);
  return {all[0], all[1], all[2]};
}

GO SmoothedFunctional::count_sticking(const Vector &u) const
{
  const SmoothedPoints s = points_;
  const auto x = device_read(u);
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::count_sticking", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, LO &sticking) {
        if (!s.points.fixed(i) && s.has_friction())
          sticking += slip_state(s.trial_traction(i, motion(s.points, i, x)), s.bound(i)) == Slip::stick;
      },
      count);
  return sum_all(*u.getMap()->getComm(), GO(count));
}

} // namespace rpc::contact
