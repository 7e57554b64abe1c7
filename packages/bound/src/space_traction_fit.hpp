// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "space_contact.hpp"

#include <vector>

namespace rpc::bound
{

/// What is wanted of a traction on a contact side in space, a pressure or one along the side with two components.       doc/bounds.md (13.4)
struct WantedInSpace {
  int components = 1;
  std::array<std::vector<double>, 2> force; ///< (components; points) that it stands for [N]
  std::vector<char> free;                   ///< (points) whether it can act there
  AlongSide near;                           ///< (components; facets) the one at the nodes [Pa]
  AlongSide depth;                          ///< (components; facets) displacement that it works with [m]
  AlongSide low, high; ///< (components; facets) bounds [Pa], of two components along `toward` and across it
  /// (facets; coefficients) Of two components: a unit vector.
  std::vector<std::array<std::array<double, 2>, 6>> toward;
  double spring = 0; ///< c of the foundation [m/Pa]
  double rise = 0;   ///< H [Pa/m]; where it is > 0 a pressure may exceed `high`
};

/// (components; facets) [Pa]. Any traction that the law admits gives a bound of the error; this one a good one.
AlongSide fitted_in_space(const SpaceContact &c, const WantedInSpace &wanted);

} // namespace rpc::bound
