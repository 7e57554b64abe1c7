// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_pressure.hpp"

#include <vector>

namespace rpc::bound
{

/// What is wanted of a traction on a contact side, a pressure or one along the side.                    doc/bounds.md (13.4)
struct WantedTraction {
  std::vector<double> force;      ///< (points) that it stands for [N]
  std::vector<char> free;         ///< (points) whether it can act there
  std::vector<OfFacet> near;      ///< (facets) Bernstein coefficients of the one at the nodes [Pa]
  std::vector<OfFacet> depth;     ///< (facets) displacement at the nodes that it works with [m]
  std::vector<OfFacet> low, high; ///< (facets) bounds of the coefficients [Pa]
  double spring = 0;              ///< c of the foundation [m/Pa]
  double rise = 0;                ///< H [Pa/m]; where it is > 0 the traction may exceed `high`
  std::vector<std::array<bool, 3>>
      none{}; ///< (facets) coefficients that are 0 whatever the law is; empty: no such ones
};

/// (facets) Bernstein coefficients [Pa]. Any traction that the law admits gives a bound of the error; this one a good one.
std::vector<OfFacet> fitted_traction(const ContactFacets &c, const WantedTraction &wanted);

} // namespace rpc::bound
