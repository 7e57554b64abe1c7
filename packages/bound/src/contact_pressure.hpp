// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <array>
#include <vector>

/// What is of the size of the boundary only: on the host.
namespace rpc::bound
{

/// Three numbers of a facet: at its ends and in the middle, or the coefficients of Bernstein's polynomials. With order 1 the first two.
using OfFacet = std::array<double, 3>;

/// A straight contact side.
struct ContactFacets {
  int order = 1;
  double limit = 0;                          ///< yield stress xi [Pa], may be infinite
  double modulus = 1;                        ///< E of the body [Pa]
  std::vector<LO> facet;                     ///< numbers of the facets
  std::vector<double> length;                ///< (facets) [m]
  std::vector<std::array<double, 2>> normal; ///< (facets) of the contact law
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

/// A pressure in [0, xi] whose forces are near to those of the contact points in the norm of their work, and that does not press where
/// the body is off the foundation.                                                                     doc/theory.md (13.4)
/// @param v  (facets) penetration at the nodes [m]
/// @return (facets) Bernstein coefficients [Pa]
std::vector<OfFacet> fitted_pressure(const ContactFacets &c, const std::vector<OfFacet> &v);

/// Integrals over a facet of unit length: of xi v+, and of (xi - p) v+ + p v-. v <= 0 where xi is infinite.
struct ContactIntegrals {
  double yielding = 0, gap = 0;
};
ContactIntegrals contact_integrals(int order, const OfFacet &v, const OfFacet &p, double limit);

/// Penetrations of a facet of order 2 lowered in the middle so that they are nowhere positive where both ends are not.
double lowered_middle(const OfFacet &v);

} // namespace rpc::bound
