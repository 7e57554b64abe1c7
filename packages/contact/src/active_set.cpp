// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/active_set.hpp"

#include "rpc/contact/law/states.hpp"
#include "rpc/contact/rules.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/core/math.hpp"

#include <algorithm>

namespace rpc::contact
{
namespace
{

/// This rank's largest pressure, as far as the law allows it [Pa].
double largest_pressure(const ContactNodes &c, const DeviceView<double *> &p)
{
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_pressure", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) { most = math::larger(most, admissible(p(i), c.law(i))); },
      Kokkos::Max<double>(largest));
  return std::max(0., largest);
}

void choose_first(const SmoothedPoints &s, const Vector &u, const bool all_close, const DeviceView<State *> &next)
{
  const auto x = device_read(u);
  const double weight =
      start_rules.first_weight; // where a coarser mesh predicts u and lambda, either may be the better known one
  Kokkos::parallel_for(
      "rpc::contact::first_states", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        const double rho = weight * c.scaling(i);
        next(i) = c.fixed(i)  ? State::open
                  : all_close ? State::closed
                              : state(penetration(c, i, x), s.multiplier.normal(i), rho, c.law(i));
      });
  Kokkos::fence();
}

/// Whether points stick, from multipliers and slips, once their states of contact are chosen.                     (12.8)
void choose_first_slip(const SmoothedPoints &s, const Vector &u, const ActiveSetChoice &choice)
{
  const auto x = device_read(u);
  const auto state = choice.state;
  const auto slips = choice.slip;
  const auto direction = choice.direction, traction = choice.traction;
  const double weight = start_rules.first_weight;
  Kokkos::parallel_for(
      "rpc::contact::first_slip", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        const double rho = weight * c.scaling(i);
        const Friction f = c.friction(i);
        const Motion at = motion(c, i, x);
        const Along a = row(s.multiplier.tangential, i).plus(rho, at.slip);
        const double p = state(i) == State::open ? 0 : pressure(at.penetration, s.multiplier.normal(i), rho, c.law(i));
        const bool held = acts(f) && (state(i) != State::open || f.bound > 0);
        const SlipBranch branch = held ? branch_of(a, friction_bound(p, f)) : SlipBranch{Slip::slip, {}};
        slips(i) = branch.state;
        set_row(direction, i, branch.direction);
        set_row(traction, i, a);
      });
  Kokkos::fence();
}

void choose_next(const ContactNodes &c, const Vector &u, const DeviceView<State *> &active,
                 const DeviceView<double *> &p, const DeviceView<double *> &own, const double bound,
                 const DeviceView<State *> &next)
{
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::next_states", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        next(i) = c.fixed(i) ? active(i) : next_state(active(i), penetration(c, i, x), p(i), own(i), bound, c.law(i));
      });
  Kokkos::fence();
}

/// Code of a friction state, for fingerprints: 0 sticks, 1 and 2 slips, in the plane by its direction.
KOKKOS_INLINE_FUNCTION int kind_of_slip(const Slip slip, const Along &h, const int dim)
{
  if (slip == Slip::stick) return 0;
  return dim == 2 && (h(0) != 0 ? h(0) : h(1)) < 0 ? 2 : 1;
}

/// What a point that cannot stick does: in the plane it slips along its slip, for it cannot turn by way of sticking; in space it slips on, or
/// begins with the direction of the traction that it bore.
/// @param e     slip [m]
/// @param q, s  traction on the branch of its present state, and what friction bears [Pa]
KOKKOS_INLINE_FUNCTION SlipBranch slip_instead(const SlipBranch &now, const Along &turned, const Along &e,
                                               const Along &q, const double s, const int dim)
{
  if (dim == 2) return {Slip::slip, e.unit()};
  if (now.state == Slip::slip) return {Slip::slip, turned};
  return {Slip::slip, s > 0 ? admissible_friction(q, s).scaled(1 / s) : q.unit()};
}

/// The lever by which a point may stick, unless it is so short that the standard penalty would amplify rounding too much. A higher penalty is
/// lowered along it: it goes like 1/|lever|^2.                                                                      (12.8a)
/// @param standard, stiffest  penalty over own stiffness: by default, at most
KOKKOS_INLINE_FUNCTION Along lever_at(const SmoothedPoints &s, const LO i, const State next, const double own,
                                      const double standard, const double stiffest)
{
  const ContactNodes &c = s.points;
  const Along by = lever(next, c.law(i), NormalAt{c, i}, FreeAt{c.friction, i}, c.dim);
  const double most = stiffest * own * by.length(), r = s.penalty(i);
  if (r > most && standard * own > most) return {};
  return r > most ? by.scaled(math::sqrt(r / most)) : by;
}

/// (12.8)
void choose_next_slip(const SmoothedPoints &s, const Vector &u, const ActiveSet &active,
                      const DeviceView<double *> &own, const double bound, const ActiveSetChoice &choice)
{
  const ActiveSet now = active;
  const auto x = device_read(u);
  const auto next = choice.state;
  const auto p = choice.pressure;
  const auto slips = choice.slip;
  const auto direction = choice.direction, traction = choice.traction;
  const auto violated = choice.violation;
  const auto cannot_stick = choice.cannot_stick;
  const auto levers = choice.lever;
  const double share = lag_rules.least_held, standard = penalty_rules.standard, stiffest = penalty_rules.largest;
  Kokkos::parallel_for(
      "rpc::contact::next_slip", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        const Motion at = motion(c, i, x);
        const Friction f = c.friction(i);
        const Along direction_now = row(now.direction, i);
        const Along turned = c.dim == 2 ? direction_now
                                        : turned_direction(direction_now, row(now.linearized_at, i),
                                                           s.trial_traction(i, at, now.branch(i)));
        SlipBranch branch = next_slip(now.branch(i), turned, now.state(i), next(i), at.slip, row(traction, i),
                                      at.penetration, admissible(p(i), c.law(i)), own(i), bound, f);
        const double held = prescribed_slip(at.slip, NormalAt{c, i}, FreeAt{c.friction, i}, c.dim).length();
        const bool is_held = own(i) * held > bound;
        const Along by = lever_at(s, i, next(i), own(i), standard, stiffest);
        if (branch.state == Slip::stick && is_held && by.length() == 0)
          branch = slip_instead(now.branch(i), turned, at.slip, row(traction, i),
                                friction_bound(admissible(p(i), c.law(i)), f), c.dim);
        const bool sticks = branch.state == Slip::stick;
        cannot_stick(i) =
            is_held && !sticks && s.penalty(i) * held > share * friction_bound(admissible(p(i), c.law(i)), f);
        set_row(levers, i, sticks ? by : Along{});
        slips(i) = branch.state;
        set_row(direction, i, branch.direction);
        if (c.fixed(i)) return;
        const double by_friction =
            kind_of_slip(branch.state, branch.direction, c.dim) !=
                    kind_of_slip(now.slip(i), row(now.direction, i), c.dim)
                ? violation(now.branch(i), at.slip, row(traction, i), admissible(p(i), c.law(i)), own(i), f)
                : 0;
        const double by_contact =
            next(i) != now.state(i) ? violation(now.state(i), at.penetration, p(i), own(i), c.law(i)) : 0;
        violated(i) = math::larger(by_contact, by_friction);
      });
  Kokkos::fence();
}

/// Forces of closed points beyond 0 and xi, over those between.
double overshoot(const Comm &comm, const ContactNodes &c, const DeviceView<State *> &active,
                 const DeviceView<double *> &p)
{
  double beyond = 0, within = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::overshoot", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &out, double &in) {
        if (c.fixed(i)) return;
        const double borne = active(i) == State::closed ? multiplier_of(State::closed, p(i), c.law(i)) : p(i);
        in += c.weight(i) * borne;
        out += c.weight(i) * math::magnitude(p(i) - borne);
      },
      beyond, within);
  const double mine[2] = {beyond, within};
  double all[2];
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 2, mine, all);
  return all[0] > 0 ? all[0] / std::max(all[1], 1e-300) : 0;
}

LO count_differences(const DeviceView<State *> &a, const DeviceView<State *> &b)
{
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::count_differences", device_range(static_cast<LO>(a.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &part) { part += a(i) != b(i); }, count);
  return count;
}

/// The same of states of contact and of friction.
LO count_differences(const ActiveSetChoice &a, const ActiveSet &b)
{
  const auto state = a.state, other = b.state;
  const auto slip = a.slip, other_slip = b.slip;
  const auto direction = a.direction, other_direction = b.direction;
  const int dim = static_cast<int>(direction.extent(1));
  LO count = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::count_differences", device_range(static_cast<LO>(state.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &part) {
        part += state(i) != other(i) || kind_of_slip(slip(i), row(direction, i), dim) !=
                                            kind_of_slip(other_slip(i), row(other_direction, i), dim);
      },
      count);
  return count;
}

/// Sum over all ranks of a number for each point that slips and how.
std::uint64_t fingerprint_of_slip(const Comm &comm, const ActiveSetChoice &choice)
{
  const std::uint64_t rank = comm.getRank();
  const auto slip = choice.slip;
  const auto direction = choice.direction;
  const int dim = static_cast<int>(direction.extent(1));
  std::uint64_t sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::fingerprint_of_slip", device_range(static_cast<LO>(slip.extent(0))),
      KOKKOS_LAMBDA(const LO i, std::uint64_t &part) {
        const int kind = kind_of_slip(slip(i), row(direction, i), dim);
        if (kind > 0) part += scrambled((rank << 44) + 16 * static_cast<std::uint64_t>(i) + 8 + kind);
      },
      sum);
  return sum_of_bits(comm, sum);
}

/// Sum over all ranks of a number for each point and its state.
std::uint64_t fingerprint_of(const Comm &comm, const DeviceView<State *> &state)
{
  constexpr std::uint64_t room = 16; // for the states of a point
  const std::uint64_t rank = comm.getRank();
  std::uint64_t sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::fingerprint", device_range(static_cast<LO>(state.extent(0))),
      KOKKOS_LAMBDA(const LO i, std::uint64_t &part) {
        part +=
            scrambled((rank << 44) + room * static_cast<std::uint64_t>(i) + static_cast<std::uint64_t>(state(i)) + 1);
      },
      sum);
  return sum_of_bits(comm, sum);
}

/// The update with its number of changes and its fingerprint; collective.
ActiveSetChoice counted(const Comm &comm, ActiveSetChoice choice, const ActiveSet &present, const bool with_friction)
{
  const bool friction = choice.slip.extent(0) > 0;
  const LO differences = friction ? count_differences(choice, present) : count_differences(choice.state, present.state);
  choice.changes = sum_all(comm, GO(differences));
  choice.confirmed = choice.changes == 0 && present.chosen;
  choice.fingerprint = fingerprint_of(comm, choice.state);
  if (with_friction) choice.fingerprint += fingerprint_of_slip(comm, choice);
  return choice;
}

/// Points that violate the law by less than `bound` keep their present state.
void keep_states(const ActiveSet &present, const ActiveSetChoice &choice, const double bound)
{
  const ActiveSet now = present;
  const auto state = choice.state;
  const auto slip = choice.slip;
  const auto direction = choice.direction;
  const auto lever = choice.lever;
  const auto cannot_stick = choice.cannot_stick;
  const auto violated = choice.violation;
  Kokkos::parallel_for(
      "rpc::contact::keep_states", device_range(static_cast<LO>(state.extent(0))), KOKKOS_LAMBDA(const LO i) {
        if (!(violated(i) < bound)) return;
        state(i) = now.state(i);
        set_row(lever, i, row(now.lever, i));
        if (slip(i) == now.slip(i)) return; // directions in space follow the slip
        slip(i) = now.slip(i);
        cannot_stick(i) = now.cannot_stick(i);
        set_row(direction, i, row(now.direction, i));
      });
  Kokkos::fence();
}

double largest_violation(const DeviceView<double *> &violation)
{
  double most = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_violation", device_range(static_cast<LO>(violation.extent(0))),
      KOKKOS_LAMBDA(const LO i, double &largest) { largest = math::larger(largest, violation(i)); },
      Kokkos::Max<double>(most));
  return std::max(0., most);
}

void make_room_for_slip(const ContactNodes &c, ActiveSetChoice &choice)
{
  choice.slip = DeviceView<Slip *>("rpc::contact::next_slip", c.size());
  choice.direction = DeviceView<double **>("rpc::contact::next_slip_direction", c.size(), c.dim);
  choice.cannot_stick = DeviceView<bool *>("rpc::contact::cannot_stick", c.size());
  choice.lever = DeviceView<double **>("rpc::contact::next_lever", c.size(), c.dim);
  choice.violation = DeviceView<double *>("rpc::contact::violation", c.size());
  if (choice.traction.extent(0) == 0)
    choice.traction = DeviceView<double **>("rpc::contact::chosen_by_traction", c.size(), c.dim);
}

} // namespace

ActiveSetChoice first_choice(const SmoothedFunctional &functional, const ActiveSet &present, const Vector &u,
                             const bool all_close)
{
  const SmoothedPoints &s = functional.points();
  ActiveSetChoice choice{DeviceView<State *>("rpc::contact::next_state", s.size()), s.multiplier.normal};
  choose_first(s, u, all_close, choice.state);
  if (s.has_friction()) {
    make_room_for_slip(s.points, choice);
    choose_first_slip(s, u, choice);
  }
  return counted(*u.getMap()->getComm(), std::move(choice), present, s.points.friction.anywhere);
}

ActiveSetChoice next_choice(const SmoothedFunctional &functional, const ActiveSet &present, const Vector &u,
                            const DeviceView<double *> &own, const double negligible)
{
  const Comm &comm = *u.getMap()->getComm();
  const ContactNodes &c = functional.points().points;
  ActiveSetChoice choice{DeviceView<State *>("rpc::contact::next_state", c.size()),
                         functional.active_set_pressures(present, u)};
  const double bound = negligible * max_all(comm, largest_pressure(c, choice.pressure));
  choose_next(c, u, present.state, choice.pressure, own, bound, choice.state);
  choice.overshoot = overshoot(comm, c, present.state, choice.pressure);
  if (functional.points().has_friction()) {
    choice.traction = active_set_tractions(functional.points(), present, u);
    make_room_for_slip(c, choice);
    choose_next_slip(functional.points(), u, present, own, bound, choice);
  }
  return counted(comm, std::move(choice), present, c.friction.anywhere);
}

ActiveSetChoice largest_changes(const SmoothedFunctional &functional, const ActiveSet &present,
                                const ActiveSetChoice &choice, const double part)
{
  const ContactNodes &c = functional.points().points;
  const Comm &comm = functional.comm();
  keep_states(present, choice, part * max_all(comm, largest_violation(choice.violation)));
  return counted(comm, choice, present, c.friction.anywhere);
}

namespace
{

/// Takes the update's friction states; points that begin to stick are moved back to where their slip is 0. In space those that begin to slip
/// are moved on by what their own stiffness takes of the traction that friction does not bear, for what their branch resists across depends on
/// their slip.                                                                                                       (12.16)
void take_slip(const ActiveSetChoice &choice, const SmoothedPoints &points, const DeviceView<double *> &own,
               const ActiveSet &active, Vector &u)
{
  const SmoothedPoints s = points;
  const ActiveSet to = active;
  const auto state = choice.state;
  const auto p = choice.pressure;
  const auto slips = choice.slip;
  const auto direction = choice.direction, traction = choice.traction;
  const auto cannot_stick = choice.cannot_stick;
  const auto lever = choice.lever;
  const auto count = points_of_nodes(s.points, static_cast<LO>(u.getLocalLength()) / s.points.dim);
  const auto x = device_write(u);
  for_each_point_by_group(
      "rpc::contact::take_slip", s.points, KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        const Friction f = c.friction(i);
        const SlipBranch branch{slips(i), row(direction, i)};
        const bool changes = branch.state != to.slip(i), sticks = branch.state == Slip::stick;
        const bool may_go_on =
            c.dim == 3 && to.chosen && to.state(i) != State::open && own(i) > 0 && is_free(c, i, count);
        const double pressure = state(i) == State::open ? 0 : multiplier_of(state(i), p(i), c.law(i));
        to.slip(i) = branch.state;
        to.cannot_stick(i) = cannot_stick(i);
        set_row(to.lever, i, row(lever, i));
        set_row(to.direction, i, branch.direction);
        set_row(s.multiplier.tangential, i, multiplier_of(branch, row(traction, i), pressure, f));
        s.bound(i) = friction_bound(pressure, f);
        if (!changes || (!sticks && !may_go_on)) return;
        const double beyond = math::larger(row(traction, i).length() - s.bound(i), 0);
        const Along move = sticks ? slip(c, i, x).scaled(-1) : branch.direction.scaled(beyond / own(i));
        for (int k = 0; k < c.dim; ++k)
          if (c.friction.free(i, k)) x(c.dof(i, k)) += move(k);
      });
  Kokkos::fence();
}

} // namespace

void take_choice(const ActiveSetChoice &choice, const SmoothedFunctional &functional, const DeviceView<double *> &own,
                 ActiveSet &active, Vector &u)
{
  if (choice.slip.extent(0) > 0) take_slip(choice, functional.points(), own, active, u);
  const SmoothedPoints &s = functional.points();
  const auto state = active.state, next = choice.state;
  const auto p = choice.pressure;
  active.chosen = true;
  const auto x = device_write(u);
  for_each_point_by_group( // a node of two sides is moved for one after the other
      "rpc::contact::take_active_set", s.points, KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        if (c.fixed(i)) return;
        const Foundation f = c.law(i);
        const bool closes = next(i) == State::closed && state(i) != State::closed;
        const double lambda = multiplier_of(next(i), p(i), f);
        state(i) = next(i);
        s.multiplier.normal(i) = lambda;
        if (!closes) return;
        const double move = (penetration(c, i, x) - resting_penetration(lambda, f)) / squared_length(c, i);
        for (int k = 0; k < c.dim; ++k) x(c.dof(i, k)) -= move * c.direction(i, k);
      });
  Kokkos::fence();
}

} // namespace rpc::contact
