// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "facet_polynomials.hpp"
#include "rpc/core/kokkos.hpp"
#include "rpc/core/point.hpp"
#include "side_terms.hpp"

#include <array>
#include <vector>

/// What contact_pressure.hpp has of sides in the plane, for flat sides of triangles: on the host.
namespace rpc::bound
{

/// Bernstein coefficients of a polynomial on a triangle: of the corners, then with order 2 of the sides 01, 12, 02. Numbers at the nodes are in
/// the same places.
using OfTriangle = std::array<double, 6>;
constexpr int nodes_of_triangle(const int order)
{
  return order == 1 ? 3 : 6;
}
/// Bernstein coefficients of numbers at the nodes.
OfTriangle bernstein_of(int order, const OfTriangle &at_nodes);
/// At barycentric coordinates.
double value_of(int order, const OfTriangle &bernstein, const std::array<double, 3> &at);
/// Mean of the product of two Bernstein polynomials.
double mean_product(int order, int i, int j);

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
  std::vector<OfTriangle> limit_of;             ///< (facets) s [Pa]
  std::vector<std::array<double, 2>> traction;  ///< (points) q [Pa]
  std::vector<std::array<double, 2>> slip_from; ///< (points) what slip counts from [m]
  std::array<std::vector<double>, 2> force;     ///< (points) weight times q [N]
  std::vector<char> free;                       ///< (points) whether it can act there
};

/// A flat contact side, the same on all ranks.
struct SpaceContact {
  std::vector<SpacePoint> points;
  int order = 1;
  std::vector<OfTriangle> limit_of; ///< (facets) yield limit xi + H w [Pa], may be infinite
  double rise = 0;                  ///< H [Pa/m]
  double spring = 0;                ///< c of the foundation's springs [m/Pa]
  SpaceFriction friction;
  double modulus = 1;                          ///< E of the body [Pa]
  std::vector<LO> facet;                       ///< numbers of the facets on this rank; -1: it has it not
  std::vector<double> area;                    ///< (facets) [m^2]
  std::array<double, 3> normal{};              ///< of the contact law
  std::array<std::array<double, 3>, 2> axis{}; ///< in the side
  std::vector<std::array<int, 6>> point;       ///< (facets) contact points at the nodes, numbered from 0
  std::vector<std::array<Point, 3>> corner;    ///< (facets) where the corners lie [m]
  std::vector<std::array<double, 2>> place;    ///< (points) in the side [m]
  std::vector<double> force;                   ///< (points) weight times pressure [N]
  std::vector<char> free;                      ///< (points) whether contact can act there
  std::vector<OfTriangle> pressure;            ///< (facets) as each facet has it [Pa]
};
/// The linear function of a triangle of order 2 that the middles of its sides have: no vertex has contact of its own there.
OfTriangle through_middles(const OfTriangle &at_nodes);

/// A pressure that the law admits, of the degree of the elements on each facet, as fitted_pressure() in the plane.       doc/bounds.md (13.4)
/// @param v  (facets) penetration [m]
std::vector<OfTriangle> fitted_pressure(const SpaceContact &c, const std::vector<OfTriangle> &v);

/// A traction along the side within the limits of friction, likewise: (axes; facets).
/// @param slip  (axes; facets) [m]
using AlongSide = std::array<std::vector<OfTriangle>, 2>;
AlongSide fitted_friction(const SpaceContact &c, const AlongSide &slip);

/// The part of a convex polygon in a triangle where sign * v >= 0, v linear.
std::vector<Barycentric> part_of_polygon(const std::vector<Barycentric> &polygon, const OfTriangle &v, double sign);

/// The law of a facet: its yield limit, H and c.
struct TriangleLaw {
  OfTriangle limit{};
  double rise = 0, spring = 0;
};

/// Over a facet of area 1; v <= 0 where the foundation is rigid. With order 2 no smaller than the integrals, by parts of the facet
/// that the roots of v, v - c xi and p - xi cross; the difference of both is that of exact ones.               doc/bounds.md (13.12a)
ContactIntegrals contact_integrals(int order, const OfTriangle &v, const OfTriangle &p, const TriangleLaw &law);
/// The energy is no smaller than int s |e|: of |e|, which is convex, the mean of its values at the coefficients is taken on parts of the facet.
/// The difference of both integrals is exact.
/// @param slip, traction  (axes)
ContactIntegrals friction_integrals(int order, const std::array<OfTriangle, 2> &slip,
                                    const std::array<OfTriangle, 2> &traction, const OfTriangle &limit);

} // namespace rpc::bound
