// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <array>
#include <vector>

/// What contact_pressure.hpp has of sides in the plane, for flat sides of triangles of order 1: on the host.
namespace rpc::bound
{

using OfTriangle = std::array<double, 3>; ///< numbers at the corners

/// A flat contact side.
struct SpaceContact {
  double limit = 0;                         ///< yield stress xi [Pa], may be infinite
  double modulus = 1;                       ///< E of the body [Pa]
  std::vector<LO> facet;                    ///< numbers of the facets
  std::vector<double> area;                 ///< (facets) [m^2]
  std::array<double, 3> normal{};           ///< of the contact law
  std::vector<std::array<int, 3>> point;    ///< (facets) contact points at the corners, numbered from 0
  std::vector<std::array<double, 2>> place; ///< (points) in the side [m]
  std::vector<double> force;                ///< (points) weight times pressure [N]
  std::vector<char> free;                   ///< (points) whether contact can act there
  std::vector<OfTriangle> pressure;         ///< (facets) at the corners, as each facet has it [Pa]
};

/// A pressure in [0, xi], linear on each facet, as fitted_pressure() in the plane.                       doc/theory.md (13.4)
/// @param v  (facets) penetration at the corners [m]
std::vector<OfTriangle> fitted_pressure(const SpaceContact &c, const std::vector<OfTriangle> &v);

/// Integrals over a facet of area 1: of xi v+, and of (xi - p) v+ + p v-. v <= 0 where xi is infinite.
struct TriangleIntegrals {
  double yielding = 0, gap = 0;
};
TriangleIntegrals contact_integrals(const OfTriangle &v, const OfTriangle &p, double limit);

} // namespace rpc::bound
