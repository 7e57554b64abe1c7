// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/penalties.hpp"

#include "rpc/contact/rounding.hpp"
#include "rpc/contact/rules.hpp"
#include "rpc/core/math.hpp"

namespace rpc::contact
{
namespace
{

/// Whether a direction lies along an axis, up to rounding.
KOKKOS_INLINE_FUNCTION bool along_an_axis(const ContactNodes &c, const LO i)
{
  double length = 0, largest = 0;
  for (int k = 0; k < c.dim; ++k) {
    const double square = c.direction(i, k) * c.direction(i, k);
    length += square;
    largest = math::larger(largest, square);
  }
  return length - largest <= Rounding::sum * length;
}

/// The penalty of a point where none is given.
struct OpenPenalty {
  double standard = penalty_rules.standard, slanting = penalty_rules.slanting,
         rubbing = penalty_rules.raise * penalty_rules.standard;

  KOKKOS_INLINE_FUNCTION double operator()(const ContactNodes &c, const LO i, const double own) const
  {
    const bool rubs = c.friction.anywhere && c.dim == 2; // in space directions of slip depend on the penalty
    return (rubs ? rubbing : along_an_axis(c, i) ? standard : slanting) * own;
  }
};

} // namespace

DeviceView<double *> chosen_penalties(const ContactNodes &points, const DeviceView<double *> &own)
{
  const ContactNodes c = points;
  DeviceView<double *> penalty("rpc::contact::penalty", c.size());
  const OpenPenalty open_penalty;
  const double largest = penalty_rules.largest;
  Kokkos::parallel_for(
      "rpc::contact::choose_penalty", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        penalty(i) = c.given_penalty(i) > 0 ? c.given_penalty(i) : open_penalty(c, i, own(i));
        if (own(i) > 0 && penalty(i) > largest * own(i)) penalty(i) = largest * own(i);
      });
  Kokkos::fence();
  return penalty;
}

bool raise_penalties(const Comm &comm, const DeviceView<double *> &own, const DeviceView<double *> &penalty)
{
  LO raised = 0;
  const double standard = penalty_rules.standard, largest = penalty_rules.largest, raise = penalty_rules.raise;
  Kokkos::parallel_reduce(
      "rpc::contact::raise_penalty", device_range(static_cast<LO>(penalty.extent(0))),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        double next = math::larger(raise * penalty(i), standard * own(i));
        if (next > largest * own(i)) next = largest * own(i);
        if (!(next > penalty(i))) return;
        penalty(i) = next;
        ++count;
      },
      raised);
  return sum_all(comm, GO(raised)) > 0;
}

GO raise_weak_penalties(const ContactNodes &points, const DeviceView<double *> &own,
                        const DeviceView<double *> &penalty, const Comm &comm)
{
  const ContactNodes c = points;
  const OpenPenalty open_penalty;
  LO raised = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::raise_weak_penalty", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, LO &count) {
        const double open = open_penalty(c, i, own(i));
        if (!(penalty(i) < open)) return;
        penalty(i) = open;
        ++count;
      },
      raised);
  return sum_all(comm, GO(raised));
}

void lower_penalties(const ContactNodes &points, const DeviceView<double *> &penalty)
{
  const auto scaling = points.scaling;
  Kokkos::parallel_for(
      "rpc::contact::lower_penalty", device_range(points.size()), KOKKOS_LAMBDA(const LO i) {
        if (penalty(i) > scaling(i)) penalty(i) = scaling(i);
      });
  Kokkos::fence();
}

} // namespace rpc::contact
