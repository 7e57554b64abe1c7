// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/point.hpp"
#include "side_terms.hpp"

#include <array>
#include <optional>
#include <vector>

/// What is of the size of the boundary only: on the host.
namespace rpc::bound
{

/// Three numbers of a facet: at its ends and in the middle, or the coefficients of Bernstein's polynomials. With order 1 the first two.
using OfFacet = std::array<double, 3>;

/// Friction along a contact side, whose limits s are given.                                            doc/bounds.md (13.12)
struct FrictionFacets {
  bool acts = false;              ///< else nothing below is there
  std::vector<OfFacet> limit_of;  ///< (facets) Bernstein coefficients of s [Pa]
  std::vector<OfFacet> traction;  ///< (facets) q at the nodes, along the tangent [Pa]
  std::vector<OfFacet> slip_from; ///< (facets) at the nodes, what slip counts from, along the tangent [m]
  std::vector<double> force;      ///< (points) weight times q [N]
  std::vector<char> free;         ///< (points) whether it can act there
};

/// A contact point, as numbers for messages between ranks.
struct SidePoint {
  double gid; ///< of its node
  double place[2], normal[2], direction[2];
  double weight, pressure, friction;     ///< [m], [Pa], [Pa] along the tangent
  double gap, dent, free_gap, slip_from; ///< [m]
  double fixed, acts;                    ///< 0 or 1: as contact::ContactNodes has it; whether friction acts
};

/// A straight contact side, the same on all ranks: its facets and points one after the other.
struct ContactFacets {
  std::vector<SidePoint> points;
  int order = 1;
  std::vector<OfFacet> limit_of; ///< (facets) Bernstein coefficients of the yield limit xi + H w [Pa], may be infinite
  double rise = 0;               ///< H [Pa/m]
  double spring = 0;             ///< c of the foundation's springs [m/Pa]
  FrictionFacets friction;
  double modulus = 1; ///< E of the body [Pa]
  /// (facets) Of a body of revolution: Bernstein coefficients of 2 pi r, which pressures, friction and E then count [m]; else empty.
  std::vector<OfFacet> circle;
  std::vector<LO> facet;                     ///< numbers of the facets on this rank; -1: it has it not
  std::vector<double> length;                ///< (facets) [m]
  std::vector<std::array<double, 2>> normal; ///< (facets) of the contact law
  std::vector<std::array<Point, 2>> ends;    ///< (facets) where they begin and end [m]
  std::vector<std::array<int, 3>>
      point;                 ///< (facets) contact points at both ends and in the middle, numbered from 0; the last -1
  std::vector<double> place; ///< (points) along the side [m]
  std::vector<double> force; ///< (points) weight times pressure [N]
  std::vector<char> free;    ///< (points) whether contact can act there
  std::vector<OfFacet> pressure; ///< (facets) at the nodes, as each facet has it [Pa]
};

/// The pressure of a facet from its values at the nodes, as Bernstein coefficients.
OfFacet bernstein(int order, const OfFacet &at_nodes);
/// Legendre coefficients from those of Bernstein.
OfFacet legendre_of(int order, const OfFacet &bernstein);

/// The unit vector along a side, from the law's normal.
inline std::array<double, 2> tangent_of(const std::array<double, 2> &normal)
{
  return {-normal[1], normal[0]};
}

/// A pressure that the law admits, whose forces are near to those of the contact points in the norm of their work, and that does not press
/// where the body is off the foundation.                                                               doc/bounds.md (13.4)
/// @param v  (facets) penetration at the nodes [m]
/// @return (facets) Bernstein coefficients [Pa]
std::vector<OfFacet> fitted_pressure(const ContactFacets &c, const std::vector<OfFacet> &v);

/// A traction along the side within the limits of friction, likewise.
/// @param slip  (facets) at the nodes [m]
std::vector<OfFacet> fitted_friction(const ContactFacets &c, const std::vector<OfFacet> &slip);

/// The law of a facet: Bernstein coefficients of its yield limit, H and c, and of bodies of revolution those of 2 pi r.
struct NormalLaw {
  OfFacet limit{};
  double rise = 0, spring = 0;
  std::optional<OfFacet> circle;
};

/// Over a facet of unit length; v <= 0 where the foundation is rigid. Of bodies of revolution p counts 2 pi r, and the gap is no smaller than
/// the integral, which is one of a rational function.
/// @param p  Bernstein coefficients, those of an admissible pressure
ContactIntegrals contact_integrals(int order, const OfFacet &v, const OfFacet &p, const NormalLaw &law);
/// @param slip  at the nodes   @param traction, limit  Bernstein coefficients
ContactIntegrals friction_integrals(int order, const OfFacet &slip, const OfFacet &traction, const OfFacet &limit);

/// Penetrations of a facet of order 2 lowered in the middle so that they are nowhere positive where both ends are not.
double lowered_middle(const OfFacet &v);

} // namespace rpc::bound
