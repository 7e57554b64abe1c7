// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/active_set.hpp"
#include "rpc/contact/law/states.hpp"

// What penalties and directions of slip leave to be done once states are right.

namespace rpc::contact
{
namespace
{

/// A point's traction along the side on the branch of an active set. @param a  lambda_tau + r e
KOKKOS_INLINE_FUNCTION Along traction_at(const SmoothedPoints &s, const ActiveSet &active, const LO i, const double v,
                                         const Along &a)
{
  const Foundation law = s.points.law(i);
  const double p = branch_pressure(active.state(i), v, s.multiplier.normal(i), s.penalty(i), law);
  return traction_on_branch(active.branch(i), a, p, s.points.friction(i), s.points.dim);
}

/// Moves a point along its normal, and if it sticks along the side, to where its penalties bear nothing.
/// @param z  lambda + r v before any point was moved [Pa]
template <class X>
KOKKOS_INLINE_FUNCTION void move_to_rest(const SmoothedPoints &s, const ActiveSet &active, const LO i, const double z,
                                         const X &x)
{
  const ContactNodes &c = s.points;
  if (active.slip(i) == Slip::stick) {
    const Along e = slip(c, i, x);
    for (int k = 0; k < c.dim; ++k) x(c.dof(i, k)) -= e(k);
  }
  const State state = active.state(i);
  const double r = s.penalty(i), stiffness = branch_stiffness(state, r, c.law(i));
  if (stiffness == 0) return;
  const double p = branch_pressure(state, z / r, 0, r, c.law(i));
  const double move = (penetration(c, i, x) - (z - p) / r) / squared_length(c, i);
  for (int k = 0; k < c.dim; ++k) x(c.dof(i, k)) -= move * c.direction(i, k);
}

} // namespace

void turn_slip(const SmoothedPoints &points, const ActiveSet &active, const Vector &u)
{
  const SmoothedPoints s = points;
  const ActiveSet to = active;
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::turn_slip", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        if (to.slip(i) != Slip::slip) return;
        const SlipBranch branch = to.branch(i);
        const Along a = s.trial_traction(i, motion(s.points, i, x), branch);
        set_row(to.direction, i, turned_direction(branch.direction, row(to.linearized_at, i), a));
      });
  Kokkos::fence();
}

void rest_on_multipliers(const SmoothedPoints &points, const ActiveSet &active, Vector &u)
{
  const SmoothedPoints s = points;
  const ActiveSet now = active;
  const DeviceView<double *> z("rpc::contact::smoothed_pressure", s.size());
  const DeviceView<double **> a("rpc::contact::smoothed_traction", s.size(), s.points.dim);
  const auto count = points_of_nodes(s.points, static_cast<LO>(u.getLocalLength()) / s.points.dim);
  const auto x = device_write(u);
  Kokkos::parallel_for(
      "rpc::contact::note_smoothed", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const Motion at = motion(s.points, i, x);
        z(i) = s.multiplier.normal(i) + s.penalty(i) * at.penetration;
        set_row(a, i, s.trial_traction(i, at, now.branch(i)));
      });
  Kokkos::parallel_for(
      "rpc::contact::move_to_rest", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        if (is_free(s.points, i, count)) move_to_rest(s, now, i, z(i), x);
      });
  Kokkos::fence();
  Kokkos::parallel_for(
      "rpc::contact::keep_forces", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        if (!is_free(c, i, count)) return;
        const Motion at = motion(c, i, x);
        if (branch_stiffness(now.state(i), s.penalty(i), c.law(i)) > 0)
          s.multiplier.normal(i) = z(i) - s.penalty(i) * at.penetration;
        const Along held = row(s.multiplier.tangential, i), before = row(a, i);
        const bool sticks = now.slip(i) == Slip::stick;
        const Along after = sticks ? held.plus(1, before).plus(-1, s.trial_traction(i, at, now.branch(i)))
                                   : traction_at(s, now, i, at.penetration, before);
        set_row(s.multiplier.tangential, i, after);
      });
  Kokkos::fence();
}

double pressure_error(const SmoothedFunctional &functional, const ActiveSet &active, const Vector &u,
                      const DeviceView<double *> &own)
{
  const SmoothedPoints &s = functional.points();
  const ActiveSet now = active;
  const auto x = device_read(u);
  double error = 0, largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::pressure_error", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, double &worst, double &scale) {
        const ContactNodes &c = s.points;
        if (c.fixed(i)) return;
        const double lambda = s.multiplier.normal(i);
        scale = math::larger(scale, lambda);
        const double stretch = penalty_stretch(now.state(i), penetration(c, i, x), lambda, s.penalty(i), c.law(i));
        worst = math::larger(worst, own(i) * math::magnitude(stretch));
        if (!s.has_friction()) return;
        const Motion at = motion(c, i, x);
        if (now.slip(i) == Slip::stick) worst = math::larger(worst, own(i) * at.slip.length());
        if (now.slip(i) == Slip::stick || c.dim == 2 || now.cannot_stick(i)) return;
        const Along q = traction_at(s, now, i, at.penetration, s.trial_traction(i, at, now.branch(i)));
        const double left = q.plus(-1, row(s.multiplier.tangential, i)).length() / s.penalty(i);
        worst = math::larger(worst, own(i) * left);
      },
      Kokkos::Max<double>(error), Kokkos::Max<double>(largest));
  const double mine[2] = {error, largest};
  double all[2];
  Teuchos::reduceAll(*u.getMap()->getComm(), Teuchos::REDUCE_MAX, 2, mine, all);
  return all[0] > 0 && all[1] > 0 ? all[0] / all[1] : 0;
}

} // namespace rpc::contact
