#include "rpc/contact/active_set.hpp"

#include "rpc/contact/law/states.hpp"
#include "rpc/core/fingerprint.hpp"
#include "rpc/core/math.hpp"

#include <algorithm>

namespace rpc::contact
{
namespace
{

// Weight of penetration against pressure in the first choice of states, in E / diameter: where a coarser mesh predicts u and
// lambda, either may be the better known one.
constexpr double first_weight = 10;

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
  Kokkos::parallel_for(
      "rpc::contact::first_states", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        const double rho = first_weight * c.scaling(i);
        next(i) = c.fixed(i)  ? State::open
                  : all_close ? State::closed
                              : state(penetration(c, i, x), s.multiplier.normal(i), rho, c.law(i));
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

/// The choice with its number of changes and its fingerprint; collective.
ActiveSetChoice counted(const Comm &comm, ActiveSetChoice choice, const ActiveSet &present)
{
  choice.changes = sum_all(comm, GO(count_differences(choice.state, present.state)));
  choice.confirmed = choice.changes == 0 && present.chosen;
  choice.fingerprint = fingerprint_of(comm, choice.state);
  return choice;
}

} // namespace

ActiveSetChoice first_choice(const SmoothedFunctional &functional, const ActiveSet &present, const Vector &u,
                             const bool all_close)
{
  const SmoothedPoints &s = functional.points();
  ActiveSetChoice choice{DeviceView<State *>("rpc::contact::next_state", s.size()), s.multiplier.normal};
  choose_first(s, u, all_close, choice.state);
  return counted(*u.getMap()->getComm(), std::move(choice), present);
}

ActiveSetChoice next_choice(const SmoothedFunctional &functional, const ActiveSet &present, const Vector &u,
                            const DeviceView<double *> &own, const double negligible)
{
  const Comm &comm = *u.getMap()->getComm();
  const ContactNodes &c = functional.points().points;
  ActiveSetChoice choice{DeviceView<State *>("rpc::contact::next_state", c.size()),
                         functional.active_set_pressures(present.state, u)};
  const double bound = negligible * max_all(comm, largest_pressure(c, choice.pressure));
  choose_next(c, u, present.state, choice.pressure, own, bound, choice.state);
  choice.overshoot = overshoot(comm, c, present.state, choice.pressure);
  return counted(comm, std::move(choice), present);
}

void take_choice(const ActiveSetChoice &choice, const SmoothedFunctional &functional, ActiveSet &active, Vector &u)
{
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

double pressure_error(const SmoothedFunctional &functional, const ActiveSet &active, const Vector &u,
                      const DeviceView<double *> &own)
{
  const SmoothedPoints &s = functional.points();
  const auto state = active.state;
  const auto x = device_read(u);
  double error = 0, largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::pressure_error", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, double &worst, double &scale) {
        const ContactNodes &c = s.points;
        if (c.fixed(i)) return;
        const double lambda = s.multiplier.normal(i);
        scale = math::larger(scale, lambda);
        const double stretch = penalty_stretch(state(i), penetration(c, i, x), lambda, s.penalty(i), c.law(i));
        worst = math::larger(worst, own(i) * math::magnitude(stretch));
      },
      Kokkos::Max<double>(error), Kokkos::Max<double>(largest));
  const double mine[2] = {error, largest};
  double all[2];
  Teuchos::reduceAll(*u.getMap()->getComm(), Teuchos::REDUCE_MAX, 2, mine, all);
  return all[0] > 0 && all[1] > 0 ? all[0] / all[1] : 0;
}

DeviceView<double ***> added_blocks(const SmoothedPoints &points, const DeviceView<State *> &active,
                                    const double spring)
{
  const SmoothedPoints s = points;
  const int dim = s.points.dim;
  const DeviceView<double ***> block("rpc::contact::added_blocks", s.size(), dim, dim);
  Kokkos::parallel_for(
      "rpc::contact::added_blocks", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        if (c.fixed(i)) return;
        Response response =
            s.respond_on_branch(i, active(i), Motion{0}); // blocks do not depend on the place within a branch
        if (active(i) != State::closed)
          add_stiffness(c.weight(i), spring * c.scaling(i), DirectionAt{c, i}, dim, response);
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) block(i, k, l) = response.block[k][l];
      });
  Kokkos::fence();
  return block;
}

} // namespace rpc::contact
