// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/active_set.hpp"

// What the branches of an active set answer: blocks and tractions.

namespace rpc::contact
{
namespace
{

/// A point's blocks, with a weak spring where the point is not closed, and along the side where it slips.
KOKKOS_INLINE_FUNCTION void write_blocks(const ContactNodes &c, const LO i, const State state, const bool slips,
                                         const double spring, Response response, const AddedBlocks &to)
{
  if (state != State::closed) add_stiffness(c.weight(i), spring * c.scaling(i), DirectionAt{c, i}, c.dim, response);
  if (spring > 0 && slips && acts(c.friction(i))) {
    const double stiffness = spring * c.scaling(i);
    add_traction(c.weight(i), {}, {stiffness, stiffness}, {}, NormalAt{c, i}, FreeAt{c.friction, i}, c.dim, response);
  }
  const bool coupled = to.coupling.extent(0) > 0;
  for (int k = 0; k < c.dim; ++k)
    for (int l = 0; l < c.dim; ++l) {
      to.block(i, k, l) = response.block[k][l];
      if (coupled) to.coupling(i, k, l) = response.coupling[k][l];
    }
}

} // namespace

AddedBlocks added_blocks(const SmoothedPoints &points, const ActiveSet &active, const Vector &u, const double spring)
{
  const SmoothedPoints s = points;
  const ActiveSet states = active;
  const int dim = s.points.dim;
  AddedBlocks blocks{DeviceView<double ***>("rpc::contact::added_blocks", s.size(), dim, dim)};
  if (s.has_friction()) blocks.coupling = DeviceView<double ***>("rpc::contact::coupling", s.size(), dim, dim);
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::added_blocks", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        const Motion at = motion(c, i, x);
        if (s.has_friction()) set_row(states.linearized_at, i, s.trial_traction(i, at, states.branch(i)));
        if (!c.fixed(i))
          write_blocks(c, i, states.state(i), s.has_friction() && states.slip(i) == Slip::slip, spring,
                       s.respond_on_branch(i, states, at), blocks);
      });
  Kokkos::fence();
  return blocks;
}

AddedBlocks functional_blocks(const SmoothedPoints &points, const Vector &u, const double spring)
{
  const SmoothedPoints s = points;
  const int dim = s.points.dim;
  const AddedBlocks blocks{DeviceView<double ***>("rpc::contact::functional_blocks", s.size(), dim, dim)};
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::functional_blocks", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        if (c.fixed(i)) return;
        const Response response = s.respond(i, motion(c, i, x));
        const bool slips =
            s.has_friction() && slip_state(s.trial_traction(i, motion(c, i, x)), s.bound(i)) == Slip::slip;
        write_blocks(c, i, response.state, slips, spring, response, blocks);
      });
  Kokkos::fence();
  return blocks;
}

DeviceView<double **> active_set_tractions(const SmoothedPoints &points, const ActiveSet &active, const Vector &u)
{
  const SmoothedPoints s = points;
  const ActiveSet states = active;
  const DeviceView<double **> q("rpc::contact::active_set_traction", s.size(), s.points.dim);
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::contact::active_set_traction", device_range(s.size()), KOKKOS_LAMBDA(const LO i) {
        const ContactNodes &c = s.points;
        const Motion at = motion(c, i, x);
        const double p =
            branch_pressure(states.state(i), at.penetration, s.multiplier.normal(i), s.penalty(i), c.law(i));
        set_row(
            q, i,
            traction_on_branch(states.branch(i), s.trial_traction(i, at, states.branch(i)), p, c.friction(i), c.dim));
      });
  Kokkos::fence();
  return q;
}

} // namespace rpc::contact
