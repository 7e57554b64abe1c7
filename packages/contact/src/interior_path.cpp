// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/interior_path.hpp"

#include "rpc/core/math.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace rpc::contact
{
namespace
{

/// 1/(D + 1/r) of a point [Pa/m].                                                                              (5.18)
KOKKOS_INLINE_FUNCTION double linear_stiffness(const SmoothedPoints &s, const LO i, const InteriorPoint &at)
{
  return 1 / (linear_compliance(at, s.points.law(i)) + 1 / s.penalty(i));
}

double largest_penetration(const ContactNodes &c, const Vector &u)
{
  const auto x = device_read(u);
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_penetration", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) {
        if (!c.fixed(i)) most = math::larger(most, math::magnitude(penetration(c, i, x)));
      },
      Kokkos::Max<double>(largest));
  return max_all(*u.getMap()->getComm(), std::max(0., largest));
}

/// The least E/diameter of the points.
double softest(const Comm &comm, const ContactNodes &c)
{
  double least = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::softest", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &low) { low = math::fmin(low, c.scaling(i)); }, Kokkos::Min<double>(least));
  return min_all(comm, least);
}

void join_all(const ContactNodes &c, const Vector &u, const double pressure, const double mu, const double slope,
              const DeviceView<InteriorPoint *> &at)
{
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::join_path", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        at(i) = c.fixed(i) ? InteriorPoint{0, 0, 0} : join_path(pressure, penetration(c, i, x), mu, slope, c.law(i));
      });
  Kokkos::fence();
}

/// The changes of the points that go with one of the displacement.                                                (5.17)
DeviceView<InteriorPoint *> changes_along(const SmoothedPoints &points, const DeviceView<InteriorPoint *> &at,
                                          const DeviceView<InteriorTarget *> &aim, const Vector &u, const Vector &d)
{
  const SmoothedPoints s = points;
  const DeviceView<InteriorPoint *> change("rpc::contact::interior_change", s.size());
  const auto x = device_read(u), move = device_read(d);
  Kokkos::parallel_for(
      "rpc::contact::interior_change", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        if (c.fixed(i)) return;
        const Foundation f = c.law(i);
        const double dp = linear_stiffness(s, i, at(i)) *
                          (along_direction(c, i, move) + linear_excess(at(i), penetration(c, i, x), aim(i), f));
        change(i) = linear_change(at(i), dp, aim(i), f);
      });
  Kokkos::fence();
  return change;
}

/// F <- F + sum_i w_i m_i de_i/(D_i + 1/r_i) for targets that change from `aim` to `next`.                          (5.18)
void add_force_of(const DeviceView<InteriorTarget *> &next, const DeviceView<InteriorTarget *> &aim,
                  const SmoothedPoints &points, const DeviceView<InteriorPoint *> &at, Vector &F)
{
  const SmoothedPoints s = points;
  const DeviceView<double *> p("rpc::contact::interior_pressure_change", s.size());
  Kokkos::parallel_for(
      "rpc::contact::interior_pressure_change", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        if (s.points.fixed(i)) return;
        const InteriorTarget more{next(i).opening - aim(i).opening, next(i).dent - aim(i).dent};
        p(i) = linear_stiffness(s, i, at(i)) * excess_of(more, at(i), s.points.law(i));
      });
  Kokkos::fence();
  add_contact_force(s.points, p, F);
}

/// The part of a change, at most 1, that keeps the points of all ranks inside.                                      (5.19)
double longest_of_all(const Comm &comm, const SmoothedPoints &s, const DeviceView<InteriorPoint *> &change,
                      const DeviceView<InteriorPoint *> &at)
{
  double longest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::longest_step", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, double &least) {
        if (!s.points.fixed(i)) least = math::fmin(least, longest_step(at(i), change(i), s.points.law(i)));
      },
      Kokkos::Min<double>(longest));
  return std::min(1., interior_rules.to_boundary * min_all(comm, longest));
}

/// Over all ranks: sum_i w_i (p_i s_i + q_i d_i) [J], sum_i w_i p_i [N], and the sum of w_i times a point's number of pairs.
std::array<double, 3> sums(const Comm &comm, const ContactNodes &points, const DeviceView<InteriorPoint *> &at)
{
  const ContactNodes c = points;
  double products = 0, force = 0, pairs = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::complementarity", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &product, double &load, double &weight) {
        if (c.fixed(i)) return;
        const Foundation f = c.law(i);
        product += c.weight(i) * complementarity(at(i), f);
        load += c.weight(i) * at(i).pressure;
        weight += (can_yield(f) ? 2 : 1) * c.weight(i);
      },
      products, force, pairs);
  const double mine[3] = {products, force, pairs};
  std::array<double, 3> all;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 3, mine, all.data());
  return all;
}

/// (points, dim, dim) What the linearized law adds to K [N/m].                                                  (5.18)
DeviceView<double ***> interior_blocks(const SmoothedPoints &points, const DeviceView<InteriorPoint *> &at)
{
  const SmoothedPoints s = points;
  const int dim = s.points.dim;
  const DeviceView<double ***> block("rpc::contact::interior_blocks", s.size(), dim, dim);
  Kokkos::parallel_for(
      "rpc::contact::interior_blocks", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        if (c.fixed(i)) return;
        Response response;
        add_stiffness(c.weight(i), linear_stiffness(s, i, at(i)), DirectionAt{c, i}, dim, response);
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) block(i, k, l) = response.block[k][l];
      });
  Kokkos::fence();
  return block;
}

} // namespace

InteriorPath::InteriorPath(const SmoothedFunctional &functional, RCP<UpdatedOperator> hessian, const Vector &u,
                           const double load)
    : functional_(functional), hessian_(std::move(hessian)), at_("rpc::contact::interior", functional.points().size()),
      aim_("rpc::contact::interior_target", functional.points().size()),
      state_("rpc::contact::interior_state", functional.points().size())
{
  const ContactNodes &c = functional.points().points;
  const double soft = softest(*u.getMap()->getComm(), c), largest = largest_penetration(c, u);
  pressure_ = load > 0 ? load : soft * largest;
  length_ = std::max(largest, pressure_ / soft);
  join(u);
}

void InteriorPath::join(const Vector &u)
{
  mu_ = interior_rules.first_mu * pressure_ * length_;
  join_all(functional_.points().points, u, pressure_, mu_, pressure_ * pressure_ / mu_, at_);
}

void InteriorPath::linearize(const Vector &u, Vector &F)
{
  if (short_steps_ >= interior_rules.many_short_steps) {
    short_steps_ = 0;
    pressure_ *= interior_rules.more_pressure;
    join(u);
  }
  hessian_->set(functional_.points().points, interior_blocks(functional_.points(), at_));
  gradient(u, F);
}

void InteriorPath::gradient(const Vector &u, Vector &F) const
{
  functional_.elastic_gradient(u, F);
  const SmoothedPoints s = functional_.points();
  const auto at = at_;
  const auto aim = aim_;
  const DeviceView<double *> p("rpc::contact::interior_pressure", s.size());
  {
    const auto x = device_read(u);
    Kokkos::parallel_for(
        "rpc::contact::interior_pressure", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
          const ContactNodes &c = s.points;
          if (c.fixed(i)) return;
          const Foundation f = c.law(i);
          p(i) = at(i).pressure + linear_stiffness(s, i, at(i)) * linear_excess(at(i), penetration(c, i, x), aim(i), f);
        });
    Kokkos::fence();
  }
  add_contact_force(s.points, p, F);
}

void InteriorPath::correct(const Vector &u, const Vector &d, Vector &F)
{
  const SmoothedPoints s = functional_.points();
  const auto change = changes_along(s, at_, aim_, u, d);
  const double t = longest_of_all(*u.getMap()->getComm(), s, change, at_);
  const double mu = aimed_mu(mu_, t);
  const DeviceView<InteriorTarget *> next("rpc::contact::interior_target", s.size());
  Kokkos::parallel_for(
      "rpc::contact::interior_target", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i) { next(i) = corrected_target(change(i), mu, t, s.points.law(i)); });
  Kokkos::fence();
  add_force_of(next, aim_, s, at_, F);
  aim_ = next;
}

double InteriorPath::advance(const Vector &u, const Vector &d)
{
  const SmoothedPoints s = functional_.points();
  const auto at = at_;
  const auto change = changes_along(s, at, aim_, u, d);
  const double t = longest_of_all(*u.getMap()->getComm(), s, change, at);
  const auto state = state_;
  LO changes = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::interior_step", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        if (s.points.fixed(i)) return;
        const InteriorPoint before = at(i), by = change(i);
        at(i) = moved(before, t, by);
        const State next = tends_to(before, at(i), s.points.law(i));
        count += next != state(i);
        state(i) = next;
      },
      changes);
  settled_ = sum_all(*u.getMap()->getComm(), GO(changes)) == 0;
  const auto [products, force, pairs] = sums(*u.getMap()->getComm(), s.points, at_);
  mu_ = products / pairs;
  gap_ = products / (force * length_);
  short_steps_ = t < interior_rules.short_step ? short_steps_ + 1 : 0;
  Kokkos::deep_copy(aim_, InteriorTarget{0, 0});
  return t;
}

ActiveSetChoice InteriorPath::choice() const
{
  const ContactNodes c = functional_.points().points;
  ActiveSetChoice choice{DeviceView<State *>("rpc::contact::next_state", c.size()),
                         DeviceView<double *>("rpc::contact::interior_pressure", c.size())};
  const auto at = at_;
  const auto state = state_, next = choice.state;
  const auto p = choice.pressure;
  Kokkos::parallel_for(
      "rpc::contact::interior_states", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        next(i) = state(i);
        p(i) = at(i).pressure;
      });
  Kokkos::fence();
  return choice;
}

} // namespace rpc::contact
