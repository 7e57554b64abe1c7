// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/contact_state.hpp"
#include "rpc/contact/law/response.hpp"

namespace rpc::contact
{

/// The direction of one point, by components, for kernels.
struct DirectionAt {
  const NodePoints &points;
  LO point;

  KOKKOS_INLINE_FUNCTION double operator()(const int k) const { return points.direction(point, k); }
};

/// The normal of one point, and where its displacement is free, by components, for kernels.
struct NormalAt {
  const ContactNodes &points;
  LO point;

  KOKKOS_INLINE_FUNCTION double operator()(const int k) const { return points.normal(point, k); }
};
struct FreeAt {
  const FrictionPoints &points;
  LO point;

  KOKKOS_INLINE_FUNCTION bool operator()(const int k) const { return points.free(point, k) != 0; }
};

/// The first components of a row, for kernels. @param rows  (points, dim)
KOKKOS_INLINE_FUNCTION Along row(const DeviceView<double **> &rows, const LO i)
{
  Along along;
  for (int k = 0; k < static_cast<int>(rows.extent(1)); ++k) along.x[k] = rows(i, k);
  return along;
}
KOKKOS_INLINE_FUNCTION void set_row(const DeviceView<double **> &rows, const LO i, const Along &along)
{
  for (int k = 0; k < static_cast<int>(rows.extent(1)); ++k) rows(i, k) = along(k);
}

/// The states that the Hessian belongs to. Plain data.
struct ActiveSet {
  DeviceView<State *> state;    ///< (points)
  bool chosen = false;          ///< else the states are those of K itself, all open, and say nothing about pressures
  DeviceView<Slip *> slip = {}; ///< (points) of friction; empty: there is none
  DeviceView<double **> direction = {};     ///< (points, dim) where a point slips: h in the plane, g in space
  DeviceView<bool *> cannot_stick = {};     ///< (points) slips: a part of its slip is prescribed
  DeviceView<double **> linearized_at = {}; ///< (points, dim) lambda_tau + r e where the branches were linearized [Pa]

  DeviceView<double **> lever = {}; ///< (points, dim) by which a point sticks, (12.8a); else 0

  KOKKOS_INLINE_FUNCTION SlipBranch branch(const LO i) const
  {
    return {slip(i), row(direction, i), cannot_stick(i), row(lever, i)};
  }
};

/// The contact points of a smoothed functional: what its formulas need of each.
struct SmoothedPoints {
  ContactNodes points;          ///< with the gap and the slip that are left from the functional's origin
  DeviceView<double *> penalty; ///< (points) r > 0 [Pa/m]
  Multipliers multiplier;
  DeviceView<double *> bound = {}; ///< (points) s of the functional's friction, which does not follow the pressure [Pa]

  LO size() const { return points.size(); }
  KOKKOS_INLINE_FUNCTION bool has_friction() const { return points.friction.exists(); }
  KOKKOS_INLINE_FUNCTION Multiplier multiplier_at(const LO i) const
  {
    return has_friction() ? Multiplier{multiplier.normal(i), row(multiplier.tangential, i)}
                          : Multiplier{multiplier.normal(i)};
  }
  /// lambda_tau + r e, on a branch that may be without lambda_tau.
  KOKKOS_INLINE_FUNCTION Along trial_traction(const LO i, const Motion &at, const SlipBranch &branch = {}) const
  {
    return contact::trial_traction(branch, row(multiplier.tangential, i), penalty(i), at.slip);
  }
  /// The response of one point at a motion, for kernels: friction with the given bound s, so that it has a potential.
  KOKKOS_INLINE_FUNCTION Response respond(const LO i, const Motion &at) const
  {
    const Multiplier lambda = multiplier_at(i);
    Response response =
        contact::respond(at, lambda, penalty(i), points.law(i), DirectionAt{points, i}, points.weight(i), points.dim);
    if (has_friction())
      add_friction(at, lambda, penalty(i), bound(i), NormalAt{points, i}, FreeAt{points.friction, i}, points.weight(i),
                   points.dim, response);
    return response;
  }
  /// The same on the branches of an active set, friction following the pressure.
  KOKKOS_INLINE_FUNCTION Response respond_on_branch(const LO i, const ActiveSet &active, const Motion &at) const
  {
    const Multiplier lambda = multiplier_at(i);
    Response response = contact::respond_on_branch(active.state(i), at, lambda, penalty(i), points.law(i),
                                                   DirectionAt{points, i}, points.weight(i), points.dim);
    if (has_friction())
      add_friction_on_branch(active.state(i), active.branch(i), at, lambda, penalty(i), points.law(i),
                             points.friction(i), DirectionAt{points, i}, NormalAt{points, i},
                             FreeAt{points.friction, i}, points.weight(i), points.dim, response);
    return response;
  }
};

/// The motion of one point at a displacement, for kernels. @param x  (owned dofs) [m]
template <class X>
KOKKOS_INLINE_FUNCTION Motion motion(const ContactNodes &c, const LO i, const X &x)
{
  return c.friction.exists() ? Motion{penetration(c, i, x), slip(c, i, x)} : Motion{penetration(c, i, x)};
}

} // namespace rpc::contact
