// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

namespace rpc::contact
{

/// How far a convex set goes in a direction q: its point furthest along q, or a unit vector v with q.v > 0 along which
/// it has no end.
struct Furthest {
  std::vector<double> at;
  bool endless = false;
  /// Of an unbounded set, also a point far along q that is not on a ray: a ray nearly normal to q would hide the bounded part of the
  /// set. Empty: none is known.
  std::vector<double> bounded = {};
};
/// A closed convex set in R^k that holds the origin, given by its farthest point in any direction.
using ConvexSet = std::function<Furthest(const std::vector<double> &q)>;

struct Nearest {
  std::vector<double> away; ///< b - the nearest point: normal of the plane that separates b from the set
  double distance = 0;      ///< |away|; 0 if b lies in the set to the tolerance
  int steps = 0;            ///< questions asked
};

/// Point of a set nearest to b: Wolfe's algorithm for the point of least norm of a polytope, with the set's endless
/// directions as further generators and the origin as a known point.                          doc/theory.md (9.6)
///
/// Finite. Generators are scaled to unit length, so that a set far larger than |b| costs no digits.
/// @param tolerance  distance from which on b is outside, > 0
Nearest nearest_point(const ConvexSet &set, const std::vector<double> &b, double tolerance);

} // namespace rpc::contact
