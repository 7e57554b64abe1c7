// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "side_terms.hpp"

#include <array>
#include <vector>

/// What contact_pressure.hpp has of sides in the plane, for flat sides of triangles of order 1: on the host.
namespace rpc::bound
{

using OfTriangle = std::array<double, 3>; ///< numbers at the corners

/// A contact point, as numbers for messages between ranks.
struct SpacePoint {
  double gid, id; ///< of its node; the latter does not depend on the ranks
  double place[3], normal[3], direction[3];
  double weight, pressure, friction[3];     ///< [m^2], [Pa], [Pa]
  double gap, dent, free_gap, slip_from[3]; ///< [m]
  double fixed, acts;                       ///< 0 or 1: as contact::ContactNodes has it; whether friction acts
};

/// Friction along a contact side, whose limits s are given.                                            doc/bounds.md (13.12)
/// Vectors have components along both axes of the side.
struct SpaceFriction {
  bool acts = false;                            ///< else nothing below is there
  std::vector<OfTriangle> limit_of;             ///< (facets) s at the corners [Pa]
  std::vector<std::array<double, 2>> traction;  ///< (points) q [Pa]
  std::vector<std::array<double, 2>> slip_from; ///< (points) what slip counts from [m]
  std::array<std::vector<double>, 2> force;     ///< (points) weight times q [N]
  std::vector<char> free;                       ///< (points) whether it can act there
};

/// A flat contact side, the same on all ranks.
struct SpaceContact {
  std::vector<SpacePoint> points;
  std::vector<OfTriangle> limit_of; ///< (facets) yield limit xi + H w at the corners [Pa], may be infinite
  double rise = 0;                  ///< H [Pa/m]
  double spring = 0;                ///< c of the foundation's springs [m/Pa]
  SpaceFriction friction;
  double modulus = 1;                            ///< E of the body [Pa]
  std::vector<LO> facet;                         ///< numbers of the facets on this rank; -1: it has it not
  std::vector<double> area;                      ///< (facets) [m^2]
  std::array<double, 3> normal{};                ///< of the contact law
  std::array<std::array<double, 3>, 2> axis{};   ///< in the side
  std::vector<std::array<int, 3>> point;         ///< (facets) contact points at the corners, numbered from 0
  std::vector<std::array<OfTriangle, 3>> corner; ///< (facets) where these lie [m]
  std::vector<std::array<double, 2>> place;      ///< (points) in the side [m]
  std::vector<double> force;                     ///< (points) weight times pressure [N]
  std::vector<char> free;                        ///< (points) whether contact can act there
  std::vector<OfTriangle> pressure;              ///< (facets) at the corners, as each facet has it [Pa]
};

/// A pressure that the law admits, linear on each facet, as fitted_pressure() in the plane.               doc/bounds.md (13.4)
/// @param v  (facets) penetration at the corners [m]
std::vector<OfTriangle> fitted_pressure(const SpaceContact &c, const std::vector<OfTriangle> &v);

/// A traction along the side within the limits of friction, likewise: (axes; facets).
/// @param slip  (axes; facets) at the corners [m]
using AlongSide = std::array<std::vector<OfTriangle>, 2>;
AlongSide fitted_friction(const SpaceContact &c, const AlongSide &slip);

/// The law of a facet: its yield limit at the corners, H and c.
struct TriangleLaw {
  OfTriangle limit{};
  double rise = 0, spring = 0;
};

/// Over a facet of area 1; v <= 0 where the foundation is rigid.
ContactIntegrals contact_integrals(const OfTriangle &v, const OfTriangle &p, const TriangleLaw &law);
/// The energy is no smaller than int s |e|: of |e|, which is convex, its linear interpolant on parts of the facet is integrated. The difference of
/// both integrals is exact.
/// @param slip, traction  (axes) at the corners
ContactIntegrals friction_integrals(const std::array<OfTriangle, 2> &slip, const std::array<OfTriangle, 2> &traction,
                                    const OfTriangle &limit);

} // namespace rpc::bound
