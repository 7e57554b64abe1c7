// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/result.hpp"

#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/law/lent.hpp"
#include "rpc/contact/rounding.hpp"
#include "rpc/contact/smoothed_points.hpp"
#include "rpc/core/math.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::contact
{
namespace
{

/// Pressures at one side's nodes that take no part in the solution.
void complete_pressure(const fem::Discretization &d, const mesh::Side &side, const ContactNodes &c, const LO begin,
                       const LO end, const DeviceView<double *> &p)
{
  Vector value(d.mesh->owned_nodes), known(d.mesh->owned_nodes);
  known.putScalar(1); // a node of the side from which the normal misses the obstacle has no pressure
  const Kokkos::RangePolicy<ExecutionSpace, LO> points(begin, end);
  {
    const auto to = device_write(value);
    const auto flag = device_write(known);
    Kokkos::parallel_for(
        "rpc::contact::known_pressure", points, KOKKOS_LAMBDA(const LO i) {
          if (c.fixed(i)) p(i) = pressure_at(-c.free_gap(i), c.law(i));
          if (c.fixed(i) && c.free_gap(i) == 0 && (leaves_pressure_open(c.law(i)) || c.weight(i) == 0))
            flag(c.node(i)) = 0;
          else
            to(c.node(i)) = p(i);
        });
    Kokkos::fence();
  }
  fem::extend_to_unknown(d, side, value, known);
  const auto from = device_read(value);
  Kokkos::parallel_for(
      "rpc::contact::completed_pressure", points, KOKKOS_LAMBDA(const LO i) {
        if (!c.fixed(i)) return;
        const bool rests = c.weight(i) > 0 && c.free_gap(i) == 0; // and has made no dent
        p(i) = rests ? admissible_at_touch(from(c.node(i)), c.law(i)) : admissible_mean(from(c.node(i)), c.law(i));
      });
}

/// (owned nodes) The size of the largest facet around each node of a side, elsewhere 0 [m].
DeviceView<double *> size_around(const fem::Discretization &d, const mesh::Side &side)
{
  const LO num_owned = d.mesh->num_owned_nodes();
  const DeviceView<double *> size("rpc::contact::size_around", num_owned);
  const auto of_facet = fem::facet_size(d, side);
  const auto facets = side.facets;
  Kokkos::parallel_for(
      "rpc::contact::size_around", device_range(static_cast<LO>(facets.extent(0))), KOKKOS_LAMBDA(const LO f) {
        for (std::size_t a = 0; a < facets.extent(1); ++a)
          if (facets(f, a) < num_owned) Kokkos::atomic_fetch_max(&size(facets(f, a)), of_facet(f));
      });
  Kokkos::fence();
  return size;
}

/// Takes from one side's points without weight that lie clear of the foundation the pressure that they were lent. Collective.
void release_where_clear(const fem::Discretization &d, const mesh::Side &side, const ContactNodes &c, const LO begin,
                         const LO end, const Vector &u, const DeviceView<double *> &p)
{
  // A smooth contact opens on the first open facet by less than so many times p h/E, see (10.8).
  constexpr double smooth_gap = 4;
  const double diameter = d.diameter;
  const auto size = size_around(d, side);
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::release_where_clear", Kokkos::RangePolicy<ExecutionSpace, LO>(begin, end),
      KOKKOS_LAMBDA(const LO i) {
        if (c.weight(i) > 0) return;
        double distance = c.gap(i) + c.dent(i);
        for (int k = 0; k < c.dim; ++k) distance -= c.normal(i, k) * x(c.dof(i, k));
        const double modulus = c.scaling(i) * diameter;
        if (distance * modulus > smooth_gap * p(i) * size(c.node(i))) p(i) = 0; // (3.5a)
      });
  Kokkos::fence();
}

/// Displacement, penetration and state of each node, from its pressure.
void fill_fields(const ContactNodes &c, const Vector &u, const ContactResult &result)
{
  const auto u_nu = result.normal_displacement;
  const auto v = result.penetration, dent = result.dent;
  const auto p = result.pressure;
  const auto s = result.state;
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::result_fields", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        u_nu(i) = 0;
        for (int k = 0; k < c.dim; ++k) u_nu(i) += c.normal(i, k) * x(c.dof(i, k));
        v(i) = u_nu(i) - c.gap(i);
        const Foundation f = c.law(i);
        dent(i) = c.dent(i) + new_dent(v(i) - c.dent(i), p(i), f); // (11.2)
        s(i) = static_cast<int>(state_of_pressure(p(i), f));
      });
  Kokkos::fence();
}

/// No traction, no slip.
void make_room_for_friction(const ContactNodes &c, ContactResult &result)
{
  result.traction = DeviceView<double **>("rpc::contact::result_traction", c.size(), c.dim);
  result.slip = DeviceView<double **>("rpc::contact::result_slip", c.size(), c.dim);
  result.used = DeviceView<double *>("rpc::contact::used_friction", c.size());
  result.slip_state = DeviceView<int *>("rpc::contact::slip_state", c.size());
}

/// Traction, slip and friction state of each node that takes part in the solution.
void fill_friction(const ContactNodes &c, const ContactState &state, const ContactResult &result)
{
  const auto lambda = state.multiplier.tangential, traction = result.traction, slipped = result.slip;
  const auto used = result.used;
  const auto p = result.pressure;
  const auto state_of = result.slip_state;
  const auto x = device_read(*state.displacement);
  Kokkos::parallel_for(
      "rpc::contact::friction_fields", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        const double s = friction_bound(p(i), c.friction(i));
        if (c.fixed(i) || !(s > 0)) return;
        double square = 0;
        const Along e = slip(c, i, x);
        for (int k = 0; k < c.dim; ++k) {
          traction(i, k) = lambda(i, k);
          slipped(i, k) = e(k);
          square += lambda(i, k) * lambda(i, k);
        }
        used(i) = math::sqrt(square) / s;
        state_of(i) = used(i) >= Rounding::full_use ? 2 : 1;
      });
  Kokkos::fence();
}

/// A column of one side's points; those without weight take their neighbours' mean. Collective.
template <class Get, class Set>
void lend_to_weightless(const fem::Discretization &d, const mesh::Side &side, const ContactNodes &c, const LO begin,
                        const LO end, const Get &get, const Set &set)
{
  Vector value(d.mesh->owned_nodes), known(d.mesh->owned_nodes);
  known.putScalar(1);
  const Kokkos::RangePolicy<ExecutionSpace, LO> points(begin, end);
  {
    const auto to = device_write(value);
    const auto flag = device_write(known);
    Kokkos::parallel_for(
        "rpc::contact::known_values", points, KOKKOS_LAMBDA(const LO i) {
          if (c.weight(i) > 0)
            to(c.node(i)) = get(i);
          else
            flag(c.node(i)) = 0;
        });
    Kokkos::fence();
  }
  fem::extend_to_unknown(d, side, value, known);
  const auto from = device_read(value);
  Kokkos::parallel_for(
      "rpc::contact::lent_values", points, KOKKOS_LAMBDA(const LO i) {
        if (!(c.weight(i) > 0)) set(i, from(c.node(i)));
      });
  Kokkos::fence();
}

/// New dents at points without weight of a foundation that hardens, as their pressures. Collective.
void complete_dents(const fem::Discretization &d, const mesh::Side &side, const ContactNodes &c, const LO begin,
                    const LO end, const ContactResult &result)
{
  const auto dent = result.dent, p = result.pressure;
  lend_to_weightless(
      d, side, c, begin, end, KOKKOS_LAMBDA(const LO i) { return dent(i) - c.dent(i); },
      KOKKOS_LAMBDA(const LO i, const double value) {
        if (!hardens(c.law(i))) return;
        const Lent own = lent(p(i), value, c.law(i));
        dent(i) = c.dent(i) + own.dent;
        p(i) = own.pressure;
      });
}

/// Friction at points without weight, as their pressures, but no more than what they bear; collective.
void complete_friction(const fem::Discretization &d, const mesh::Side &side, const ContactNodes &c, const LO begin,
                       const LO end, const ContactResult &result)
{
  const auto p = result.pressure, used = result.used;
  const auto q = result.traction, e = result.slip;
  const auto state = result.slip_state;
  const DeviceView<double *> bound("rpc::contact::lent_bound", c.size());
  for (const auto &vectors : {result.traction, result.slip})
    for (int k = 0; k < c.dim; ++k)
      lend_to_weightless(
          d, side, c, begin, end, KOKKOS_LAMBDA(const LO i) { return vectors(i, k); },
          KOKKOS_LAMBDA(const LO i, const double value) { vectors(i, k) = value; });
  lend_to_weightless(
      d, side, c, begin, end, KOKKOS_LAMBDA(const LO i) { return friction_bound(p(i), c.friction(i)); },
      KOKKOS_LAMBDA(const LO i, const double value) { bound(i) = math::larger(value, 0); });
  Kokkos::parallel_for(
      "rpc::contact::lent_friction_state", Kokkos::RangePolicy<ExecutionSpace, LO>(begin, end),
      KOKKOS_LAMBDA(const LO i) {
        if (c.weight(i) > 0 || !c.friction.exists()) return;
        if (!(p(i) > 0)) bound(i) = math::fmin(bound(i), friction_bound(p(i), c.friction(i))); // it may lie clear
        set_row(e, i, along_side(c, i, row(e, i))); // neighbours of curved sides have other normals
        const Along borne = admissible_friction(along_side(c, i, row(q, i)), bound(i));
        set_row(q, i, borne);
        used(i) = bound(i) > 0 ? borne.length() / bound(i) : 0;
        state(i) = !(bound(i) > 0) ? 0 : used(i) >= Rounding::full_use ? 2 : 1;
      });
  Kokkos::fence();
}

/// What the ranks' shares come to; collective.
ContactSums over_all_ranks(const Comm &comm, ContactSums s)
{
  std::vector<double> sums{s.force[0], s.force[1], s.force[2], static_cast<double>(s.num_nodes)}, maxima;
  for (const auto &q : contact_quantities) (q.combine == Combine::sum ? sums : maxima).push_back(s.*q.value);
  sums = summed(comm, sums);
  maxima = largest(comm, maxima);
  std::copy_n(sums.begin(), 3, s.force.begin());
  s.num_nodes = static_cast<GO>(sums[3]);
  auto sum = sums.begin() + 4, maximum = maxima.begin();
  for (const auto &q : contact_quantities) s.*q.value = q.combine == Combine::sum ? *sum++ : *maximum++;
  return s;
}

/// This rank's sums and maxima of friction over the points [begin, end), and what it adds to the force.
void add_friction_sums(const ContactNodes &c, const ContactResult &result, const LO begin, const LO end, ContactSums &s)
{
  const auto q = result.traction, e = result.slip;
  const auto p = result.pressure;
  const auto state = result.slip_state;
  const Kokkos::RangePolicy<ExecutionSpace, LO> points(begin, end);
  std::array<double, 3> force{};
  Kokkos::parallel_reduce(
      "rpc::contact::friction_sums", points,
      KOKKOS_LAMBDA(const LO i, double &fx, double &fy, double &fz, double &stick, double &slips, double &work) {
        const double w = c.weight(i);
        fx -= w * q(i, 0);
        fy -= w * q(i, 1);
        if (c.dim == 3) fz -= w * q(i, 2);
        if (state(i) == 1) stick += w;
        if (state(i) == 2) slips += w;
        double square = 0;
        for (int k = 0; k < c.dim; ++k) square += e(i, k) * e(i, k);
        work += w * friction_bound(p(i), c.friction(i)) * math::sqrt(square);
      },
      force[0], force[1], force[2], s.stick_length, s.slip_length, s.friction_work);
  Kokkos::parallel_reduce(
      "rpc::contact::friction_maxima", points,
      KOKKOS_LAMBDA(const LO i, double &shear, double &slipped) {
        if (!(c.weight(i) > 0)) return;
        double traction = 0, moved = 0;
        for (int k = 0; k < c.dim; ++k) {
          traction += q(i, k) * q(i, k);
          moved += e(i, k) * e(i, k);
        }
        shear = math::larger(shear, math::sqrt(traction));
        if (p(i) > 0) slipped = math::larger(slipped, math::sqrt(moved));
      },
      Kokkos::Max<double>(s.max_shear), Kokkos::Max<double>(s.max_slip));
  for (int k = 0; k < 3; ++k) s.force[k] += force[k];
}

/// Over the points [begin, end) of all ranks.
ContactSums sums_of(const Comm &comm, const ContactNodes &c, const ContactResult &result, const LO begin, const LO end)
{
  const auto v = result.penetration, dent = result.dent;
  const auto p = result.pressure;
  const Kokkos::RangePolicy<ExecutionSpace, LO> points(begin, end);
  ContactSums s;
  Kokkos::parallel_reduce(
      "rpc::contact::result_sums", points,
      KOKKOS_LAMBDA(const LO i, double &fx, double &fy, double &fz, double &touched, double &given_way) {
        const double share = c.weight(i) * p(i);
        fx -= share * c.normal(i, 0);
        fy -= share * c.normal(i, 1);
        if (c.dim == 3) fz -= share * c.normal(i, 2);
        if (p(i) > 0) touched += c.weight(i);
        if (state_of_pressure(p(i), c.law(i)) == State::yielding) given_way += c.weight(i);
      },
      s.force[0], s.force[1], s.force[2], s.contact_length, s.yielded_length);
  Kokkos::parallel_reduce(
      "rpc::contact::result_nodes", points, KOKKOS_LAMBDA(const LO i, GO &count) { count += c.weight(i) > 0 ? 1 : 0; },
      s.num_nodes);
  Kokkos::parallel_reduce(
      "rpc::contact::result_maxima", points,
      KOKKOS_LAMBDA(const LO i, double &most, double &deep, double &overlap, double &dented) {
        const bool weightless = !(c.weight(i) > 0); // the contact law does not hold there
        // In the plane only the axis of revolution has no weight, and pressures and penetrations are often largest there.
        if (weightless && c.dim > 2) return;
        if (p(i) > most) most = p(i);
        if (dent(i) > dented) dented = dent(i);
        const double pressed_in = weightless ? lent_penetration(v(i), dent(i), p(i), c.law(i)) : v(i);
        if (pressed_in > deep) deep = pressed_in;
        if (weightless) return;
        if (-c.gap(i) > overlap) overlap = -c.gap(i);
      },
      Kokkos::Max<double>(s.max_pressure), Kokkos::Max<double>(s.max_penetration),
      Kokkos::Max<double>(s.max_initial_penetration), Kokkos::Max<double>(s.max_dent));
  Kokkos::parallel_reduce(
      "rpc::contact::result_energies", points,
      KOKKOS_LAMBDA(const LO i, double &dents, double &lost, double &kept) {
        const Foundation f = c.law(i);
        dents += c.weight(i) * dent(i);
        lost += c.weight(i) * dissipation(dent(i) - c.dent(i), p(i), f);
        kept += c.weight(i) * stored_energy(p(i), f);
      },
      s.dent_volume, s.dissipated, s.foundation_energy);
  if (c.friction.exists()) add_friction_sums(c, result, begin, end, s);
  for (const auto &q : contact_quantities) // Kokkos' maximum over no nodes is -DBL_MAX
    if (q.combine == Combine::maximum) s.*q.value = std::max(0., s.*q.value);
  return over_all_ranks(comm, s);
}

/// The deepest displacement into a foundation that gives way at points on the axis without weight, to which no law holds [m]: by as much as it
/// differs from what they are lent, either may be off. Collective.                                              (3.5b)
double deepest_on_axis(const Comm &comm, const ContactNodes &points, const ContactResult &result)
{
  if (points.dim > 2) return 0;
  const ContactNodes c = points;
  const auto v = result.penetration, p = result.pressure;
  double deepest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::deepest_on_axis", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) {
        if (c.weight(i) > 0 || !(p(i) > 0)) return;
        if (p(i) >= gives_way_from(c.law(i)) && v(i) > most) most = v(i);
      },
      Kokkos::Max<double>(deepest));
  return max_all(comm, std::max(0., deepest)); // a maximum over no points is -DBL_MAX
}

} // namespace

ContactSums &ContactSums::operator+=(const ContactSums &other)
{
  num_nodes += other.num_nodes;
  for (int k = 0; k < 3; ++k) force[k] += other.force[k];
  add_numbers(contact_quantities, *this, other);
  return *this;
}

DeviceView<double *> completed_pressure(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides,
                                        const ContactNodes &c, const DeviceView<double *> &multiplier)
{
  const DeviceView<double *> pressure("rpc::contact::pressure", c.size());
  Kokkos::deep_copy(pressure, multiplier);
  for (int k = 0; k < c.num_sides() && c.num_fixed + c.num_weightless > 0; ++k)
    complete_pressure(d, *sides[k], c, c.first(k), c.first(k + 1), pressure);
  return pressure;
}

ContactResult contact_result(const fem::Discretization &d, const std::vector<const mesh::Side *> &sides,
                             const ContactNodes &points, const ContactState &state, const bool with_friction)
{
  const ContactNodes c = points;
  const LO n = c.size();
  ContactResult result;
  result.normal_displacement = DeviceView<double *>("rpc::contact::u_nu", n);
  result.penetration = DeviceView<double *>("rpc::contact::penetration", n);
  result.dent = DeviceView<double *>("rpc::contact::dent", n);
  result.state = DeviceView<int *>("rpc::contact::state", n);
  result.pressure = completed_pressure(d, sides, c, state.multiplier.normal);
  for (int k = 0; k < c.num_sides() && c.num_weightless > 0; ++k)
    release_where_clear(d, *sides[k], c, c.first(k), c.first(k + 1), *state.displacement, result.pressure);
  fill_fields(c, *state.displacement, result);
  for (int k = 0; k < c.num_sides() && c.num_weightless > 0; ++k)
    complete_dents(d, *sides[k], c, c.first(k), c.first(k + 1), result);
  if (with_friction || c.friction.anywhere) make_room_for_friction(c, result);
  if (c.friction.exists() && state.multiplier.has_tangential()) fill_friction(c, state, result);
  for (int k = 0; k < c.num_sides() && c.friction.anywhere && c.num_weightless > 0; ++k)
    complete_friction(d, *sides[k], c, c.first(k), c.first(k + 1), result);
  for (int k = 0; k < c.num_sides(); ++k) {
    result.sides.push_back(sums_of(d.mesh->comm(), c, result, c.first(k), c.first(k + 1)));
    if (d.axisymmetric()) result.sides.back().force[0] = 0; // around the axis radial forces cancel
    result.total += result.sides.back();
  }
  if (c.num_weightless > 0) result.deepest_on_axis = deepest_on_axis(d.mesh->comm(), c, result);
  return result;
}

double pressure_distance(const Comm &comm, const ContactNodes &contact, const DeviceView<double *> &p,
                         const DeviceView<double *> &q)
{
  const ContactNodes c = contact;
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::pressure_distance", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        const double difference = p(i) - (q.extent(0) > 0 ? admissible(q(i), c.law(i)) : 0);
        if (!c.fixed(i)) part += c.weight(i) * difference * difference;
      },
      sum);
  return std::sqrt(sum_all(comm, sum));
}

DeviceView<double **> point_forces(const ContactNodes &points, const ContactResult &result)
{
  const ContactNodes c = points;
  const auto p = result.pressure;
  const auto q = result.traction;
  const bool friction = q.extent(0) > 0;
  const DeviceView<double **> force("rpc::contact::point_forces", c.size(), c.dim);
  Kokkos::parallel_for(
      "rpc::contact::point_forces", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) force(i, k) = -c.weight(i) * (p(i) * c.normal(i, k) + (friction ? q(i, k) : 0));
      });
  Kokkos::fence();
  return force;
}

DeviceView<double **> tangential_displacements(const ContactNodes &points, const Vector &u)
{
  const ContactNodes c = points;
  const DeviceView<double **> along("rpc::contact::tangential_displacements", c.size(), c.dim);
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::tangential_displacements", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        Along moved;
        for (int k = 0; k < c.dim; ++k) moved.x[k] = x(c.dof(i, k));
        set_row(along, i, along_side(c, i, moved));
      });
  Kokkos::fence();
  return along;
}

Vector contact_forces(const fem::Discretization &d, const ContactNodes &contact, const ContactResult &result)
{
  Vector force(d.owned_dofs);
  const ContactNodes c = contact;
  const auto of_point = point_forces(contact, result);
  const auto to = device_write(force);
  for_each_point_by_group(
      "rpc::contact::forces", c, KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k) to(c.dof(i, k)) += of_point(i, k);
      });
  Kokkos::fence();
  return force;
}

} // namespace rpc::contact
