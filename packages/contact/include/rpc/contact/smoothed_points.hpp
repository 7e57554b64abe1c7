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

/// The contact points of a smoothed functional: what its formulas need of each.
struct SmoothedPoints {
  ContactNodes points;          ///< with the gap that is left from the functional's origin
  DeviceView<double *> penalty; ///< (points) r > 0 [Pa/m]
  Multipliers multiplier;

  LO size() const { return points.size(); }
  /// The response of one point at a motion, for kernels.
  KOKKOS_INLINE_FUNCTION Response respond(const LO i, const Motion &at) const
  {
    return contact::respond(at, Multiplier{multiplier.normal(i)}, penalty(i), points.law(i), DirectionAt{points, i},
                            points.weight(i), points.dim);
  }
  /// The same on the branch of a state.
  KOKKOS_INLINE_FUNCTION Response respond_on_branch(const LO i, const State s, const Motion &at) const
  {
    return contact::respond_on_branch(s, at, Multiplier{multiplier.normal(i)}, penalty(i), points.law(i),
                                      DirectionAt{points, i}, points.weight(i), points.dim);
  }
};

/// The motion of one point at a displacement, for kernels. @param x  (owned dofs) [m]
template <class X>
KOKKOS_INLINE_FUNCTION Motion motion(const ContactNodes &c, const LO i, const X &x)
{
  return Motion{penetration(c, i, x)};
}

} // namespace rpc::contact
