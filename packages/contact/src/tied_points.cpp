// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/tied_points.hpp"

#include "rpc/contact/rounding.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace rpc::contact
{
namespace
{

/// What of a node is moved by a force, to end a sentence about it.
std::string moved_as(const std::vector<ContactOptions> &options)
{
  const bool by_obstacle =
      std::any_of(options.begin(), options.end(), [](const auto &side) { return side.obstacle.is_moved(); });
  return by_obstacle ? "is held along a direction in which a force moves the obstacle, which is not supported. Let the "
                       "contact side end before the side that is held, or "
                     : "is on a side that a force of \"Dirichlet\" or an entry of \"Rigid\" moves as one, which is not "
                       "supported. Let the contact side end before that side, or ";
}

/// "the node at (1, 0) of the contact side "bottom"" of the first point, side after side, that a test is true of; collective.
template <class Test>
std::optional<std::string> first_where(const fem::Discretization &d, const ContactNodes &points,
                                       const std::vector<ContactOptions> &options, const Test &test)
{
  const HostPoints x = fem::node_positions(*d.mesh, points.node);
  for (int side = 0; side < points.num_sides(); ++side)
    for (LO i = points.first(side); i < points.first(side + 1); ++i) {
      if (!test(i)) continue;
      std::ostringstream text;
      text << "the node at (" << x(i, 0) << ", " << x(i, 1);
      if (points.dim == 3) text << ", " << x(i, 2);
      text << ") of the contact side \"" << options[side].side << '"';
      return text.str();
    }
  return {};
}

} // namespace

void require_no_friction_on_tied(const fem::Discretization &d, const ContactNodes &points,
                                 const fem::DirichletDofs &dirichlet, const std::vector<ContactOptions> &options)
{
  if (!dirichlet.tied || !points.friction.anywhere) return;
  const auto group = to_host(dirichlet.tied->group);
  const auto node = to_host(points.node);
  const auto mu = to_host(points.friction.coefficient), bound = to_host(points.friction.bound);
  const auto found = first_where(d, points, options, [&](const LO i) {
    bool tied = false;
    for (int k = 0; k < points.dim; ++k) tied = tied || group(dof(points.dim, node(i), k)) >= 0;
    return tied && mu.extent(0) > 0 && (mu(i) > 0 || bound(i) > 0);
  });
  throw_if_any(
      d.mesh->comm(), ExitCode::bad_input,
      found ? std::optional("deck: " + *found + " has friction and " + moved_as(options) + "have friction 0 there.")
            : std::nullopt);
}

void settle_tied_points(const fem::Discretization &d, const ContactNodes &points, const fem::DirichletDofs &dirichlet,
                        const std::vector<ContactOptions> &options, const ContactState &state)
{
  if (!dirichlet.tied) return;
  const ContactNodes c = points;
  const auto group = dirichlet.tied->group;
  const auto pressure = state.multiplier.normal;
  const auto x = device_read(*state.displacement), prescribed = device_read(*dirichlet.value);
  const auto fixed = dirichlet.fixed;
  const DeviceView<char *> touches("rpc::contact::tied_touches", c.size());
  Kokkos::parallel_for(
      "rpc::contact::settle_tied", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        double moved = 0, taken = 0, part = 0; // taken: what free_gap has of it
        for (int k = 0; k < c.dim; ++k) {
          const LO unknown = c.dof(i, k);
          if (!fixed(unknown)) continue;
          moved += c.normal(i, k) * x(unknown);
          taken += c.normal(i, k) * prescribed(unknown);
          if (group(unknown) >= 0) part += c.normal(i, k) * c.normal(i, k);
        }
        if (!(part > Rounding::direction)) return;
        c.free_gap(i) = c.fixed(i) ? c.gap(i) + c.dent(i) - moved : c.free_gap(i) + taken - moved;
        touches(i) = c.weight(i) > 0 && (pressure(i) > 0 || penetration(c, i, x) > 0);
      });
  Kokkos::fence();
  const auto touching = to_host(touches);
  const auto found = first_where(d, points, options, [&](const LO i) { return touching(i) != 0; });
  throw_if_any(d.mesh->comm(), ExitCode::bad_input,
               found
                   ? std::optional("contact: " + *found + " touches, and " + moved_as(options) + "choose another side.")
                   : std::nullopt);
}

} // namespace rpc::contact
