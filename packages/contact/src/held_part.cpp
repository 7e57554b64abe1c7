// SPDX-License-Identifier: BSD-3-Clause
#include "held_part.hpp"

#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/rounding.hpp"
#include "rpc/core/sums.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rpc::contact
{
namespace
{

using fem::dot;
using fem::RigidMotion;
using Coefficients = Kokkos::Array<double, 6>;
using Location = Kokkos::MaxLoc<double, LO>;

Coefficients coefficients_of(const RigidMotion &motion)
{
  Coefficients r;
  for (int k = 0; k < 6; ++k) r[k] = motion[k];
  return r;
}

/// m . r at contact node i.
template <class Along>
KOKKOS_INLINE_FUNCTION double speed(const Along &along, const LO i, const Coefficients &r)
{
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += along(i, k) * r[k];
  return sum;
}

/// What a point does most against a motion: the pressure and the tangential force, times its weight, which is along the slip.  (12.10)
struct Answer {
  double pressure = 0;  // w p
  double friction = 0;  // w s
  bool endless = false; // both grow without end: a rigid point; then they are the ray's parts
};
/// @param speed, slip  m . r and |T r|   @param limit  w xi
KOKKOS_INLINE_FUNCTION Answer most_against(const double speed, const double slip, const double limit,
                                           const double weight, const Friction &f)
{
  if (!acts(f)) return {speed > 0 && !is_rigid(limit) ? limit : 0, 0, speed > 0 && is_rigid(limit)};
  const double start = math::fmin(f.bound, f.limit);
  if (speed + f.coefficient * slip <= 0) return {0, weight * start};
  const double bend =
      is_rigid(f.limit) || f.coefficient == 0 ? math::infinity<double> : (f.limit - start) / f.coefficient;
  if (speed <= 0 && bend < limit / weight)
    return {weight * bend, weight * f.limit}; // friction grows up to its limit only
  if (is_rigid(limit)) return {1, is_rigid(f.limit) ? f.coefficient : 0, true};
  return {limit, weight * friction_bound(limit / weight, f)};
}

/// T r at point i and its length; 0 where there is no friction.
struct Slide {
  double along[3] = {0, 0, 0}, length = 0;
};
KOKKOS_INLINE_FUNCTION Slide slide_of(const DeviceView<double *[3][6]> &slide, const LO i, const Coefficients &r)
{
  Slide s;
  if (slide.extent(0) == 0) return s;
  double square = 0;
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 6; ++k) s.along[c] += slide(i, c, k) * r[k];
    square += s.along[c] * s.along[c];
  }
  s.length = math::sqrt(square);
  return s;
}

/// out_k += p m . r_k + q h . T r_k.
KOKKOS_INLINE_FUNCTION void add_answer(const Reactions &reactions, const LO i, const double pressure,
                                       const double friction, const Slide &slide, double *const out)
{
  for (int k = 0; k < 6; ++k) {
    out[k] += pressure * reactions.along(i, k);
    for (int c = 0; c < 3 && slide.length > 0 && friction > 0; ++c)
      out[k] += friction * slide.along[c] / slide.length * reactions.slide(i, c, k);
  }
}

KOKKOS_INLINE_FUNCTION Friction friction_of(const Reactions &reactions, const LO i)
{
  return reactions.friction.exists() ? reactions.friction(i) : Friction{};
}

/// The ray of point i, along which its forces grow without end: m . r_k and, with friction, its share of h . T r_k; 0 if it has none.
KOKKOS_INLINE_FUNCTION void add_ray(const Reactions &reactions, const LO i, const Coefficients &r, double *const row)
{
  const Slide slide = slide_of(reactions.slide, i, r);
  const Answer answer = most_against(speed(reactions.along, i, r), slide.length, reactions.limit(i),
                                     reactions.weight(i), friction_of(reactions, i));
  if (!answer.endless) return;
  add_answer(reactions, i, answer.pressure > 0 ? answer.pressure : 1, answer.friction, slide, row);
}

/// The ray of the rigid point that is the most against a motion, for the ray's size; 0 if there is none. Collective.
RigidMotion steepest(const Comm &comm, const Reactions &reactions, const int mine, const RigidMotion &motion)
{
  const Coefficients r = coefficients_of(motion);
  const Reactions all_reactions = reactions;
  Location::value_type worst;
  Kokkos::parallel_reduce(
      "rpc::contact::steepest", device_range(static_cast<LO>(reactions.part.extent(0))),
      KOKKOS_LAMBDA(const LO i, Location::value_type &most) {
        if (all_reactions.part(i) != mine) return;
        double row[6] = {}, squares = 0, along = 0;
        add_ray(all_reactions, i, r, row);
        for (int k = 0; k < 6; ++k) {
          squares += row[k] * row[k];
          along += row[k] * r[k];
        }
        const double relative = squares > 0 ? along / math::sqrt(squares) : 0;
        if (!(relative > most.val)) return;
        most.val = relative;
        most.loc = i;
      },
      Location(worst));
  RigidMotion local{}, all{};
  const double most = max_all(comm, std::max(0., worst.val)); // a maximum over no nodes is -DBL_MAX
  if (!(most > Rounding::pressed * std::sqrt(dot(motion, motion)))) return all;
  if (min_all(comm, worst.val == most ? comm.getRank() : comm.getSize()) == comm.getRank()) {
    const DeviceView<double[6]> row("rpc::contact::ray");
    const LO i = worst.loc;
    Kokkos::parallel_for(
        "rpc::contact::ray", device_range(1), KOKKOS_LAMBDA(const LO) { add_ray(all_reactions, i, r, row.data()); });
    const auto values = to_host(row);
    for (int k = 0; k < 6; ++k) local[k] = values(k);
  }
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 6, local.data(), all.data());
  return all;
}

} // namespace

Reactions reactions_of(const fem::Discretization &d, const fem::Parts &parts, const ContactNodes &contact)
{
  Reactions reactions{DeviceView<double *[6]>("rpc::contact::along_modes", contact.size()),
                      DeviceView<double *>("rpc::contact::limit", contact.size()),
                      {},
                      contact.friction,
                      contact.weight,
                      DeviceView<int *>("rpc::contact::part", contact.size()),
                      std::vector<double>(parts.size())};
  if (contact.friction.anywhere)
    reactions.slide = DeviceView<double *[3][6]>("rpc::contact::slide_modes", contact.size());
  const auto slide = reactions.slide;
  const DeviceView<double *> strength("rpc::contact::strength", parts.size());
  const ContactNodes c = contact;
  const auto along = reactions.along;
  const auto limit = reactions.limit;
  const auto part = reactions.part;
  const auto coords = d.mesh->coords;
  const auto of_node = parts.of_node;
  const auto centre = parts.centre;
  const auto radius = parts.radius;
  Kokkos::parallel_for(
      "rpc::contact::along_modes", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        const int p = of_node(c.node(i));
        part(i) = c.fixed(i) ? -1 : p;
        if (c.fixed(i)) return;
        double arm[3] = {0, 0, 0}, m[3] = {0, 0, 0}, row[6];
        for (int k = 0; k < c.dim; ++k) {
          arm[k] = (coords(c.node(i), k) - centre(p, k)) / radius(p);
          m[k] = c.direction(i, k);
        }
        fem::along_modes(c.dim, arm, m, row);
        for (int k = 0; k < 6; ++k) along(i, k) = row[k];
        for (int component = 0; component < c.dim && slide.extent(0) > 0 && acts(c.friction(i)); ++component) {
          double t[3] = {0, 0, 0};
          for (int k = 0; k < c.dim; ++k) // prescribed motions are none
            if (c.friction.free(i, k)) t[k] = (k == component ? 1 : 0) - c.normal(i, k) * c.normal(i, component);
          fem::along_modes(c.dim, arm, t, row);
          for (int k = 0; k < 6; ++k) slide(i, component, k) = row[k];
        }
        limit(i) = c.weight(i) * largest_bearable(c.law(i));
        if (!is_rigid(limit(i))) add_shared(strength(p), limit(i));
      });
  const auto mine = to_host(strength);
  Teuchos::reduceAll(d.mesh->comm(), Teuchos::REDUCE_SUM, parts.size(), mine.data(), reactions.strength.data());
  return reactions;
}

HeldPart::HeldPart(const Comm &comm, const Reactions &reactions, const int part, std::vector<RigidMotion> motions)
    : comm_(comm), reactions_(reactions), part_(part), motions_(std::move(motions))
{
}

RigidMotion HeldPart::motion(const std::vector<double> &q) const
{
  RigidMotion r{};
  for (std::size_t j = 0; j < q.size(); ++j)
    for (int k = 0; k < 6; ++k) r[k] += q[j] * motions_[j][k];
  return r;
}

std::vector<double> HeldPart::coordinates(const RigidMotion &force) const
{
  std::vector<double> q;
  for (const RigidMotion &r : motions_) q.push_back(dot(force, r));
  return q;
}

Furthest HeldPart::furthest(const std::vector<double> &q) const
{
  const RigidMotion r = motion(q);
  Furthest endless{coordinates(steepest(comm_, reactions_, part_, r)), true};
  double squares = 0;
  for (const double entry : endless.at) squares += entry * entry;
  if (squares == 0) return {coordinates(carried(r)), false};
  for (double &entry : endless.at) entry /= std::sqrt(squares);
  if (reactions_.friction.anywhere) endless.bounded = coordinates(carried(r));
  return endless;
}

RigidMotion HeldPart::carried(const RigidMotion &motion, const LO begin, const LO end) const
{
  const Coefficients r = coefficients_of(motion);
  const Reactions reactions = reactions_;
  const int mine = part_;
  const double rounding = Rounding::speed * std::sqrt(dot(motion, motion));
  const auto local = sums_over(
      "rpc::contact::carried", Kokkos::RangePolicy<ExecutionSpace, LO>(begin, end), 6,
      KOKKOS_LAMBDA(const LO i, double sum[]) {
        if (reactions.part(i) != mine) return;
        const double towards = speed(reactions.along, i, r);
        Slide slide = slide_of(reactions.slide, i, r);
        if (!(slide.length > rounding)) slide.length = 0;
        const Friction f = friction_of(reactions, i);
        const Answer answer = most_against(math::magnitude(towards) > rounding ? towards : 0, slide.length,
                                           reactions.limit(i), reactions.weight(i), f);
        double row[6] = {}; // a point's forces together: near the limit rounding counts
        if (answer.endless) // by rounding, or steepest() has found its ray: what is left is the bound without pressure
          add_answer(reactions, i, 0, reactions.weight(i) * math::fmin(f.bound, f.limit), slide, row);
        else
          add_answer(reactions, i, answer.pressure, answer.friction, slide, row);
        for (int k = 0; k < 6; ++k) sum[k] += row[k];
      });
  RigidMotion all;
  Teuchos::reduceAll(comm_, Teuchos::REDUCE_SUM, 6, local.data(), all.data());
  return all;
}

RigidMotion HeldPart::carried(const RigidMotion &motion) const
{
  return carried(motion, 0, static_cast<LO>(reactions_.part.extent(0)));
}

} // namespace rpc::contact
