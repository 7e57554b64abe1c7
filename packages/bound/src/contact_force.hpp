// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "boundary.hpp"
#include "rpc/bound/bound.hpp"
#include "space_contact.hpp"

namespace rpc::bound
{

/// A displacement that makes a functional of the stress of a contact side's normal force.              doc/bounds.md (13.14)
struct UnitPress {
  RCP<const Vector> w;      ///< (owned dofs); null: there is none
  double low = 0, high = 0; ///< of what pressure the functional misses where w is not 1 along the normal [N]
  std::string missing;      ///< why there is none; empty if there is one
};

/// How near places of nodes are the same [m]. Collective.
inline double near_places(const mesh::Mesh &mesh)
{
  return 1e-9 * mesh::diameter(mesh);
}

/// The displacement of the body that is 1 along the normal of a contact side and 0 on all others, with the least energy. Collective.
/// @param sides  all contact sides   @param k  which of them
/// @tparam Side  ContactFacets in the plane, SpaceContact in space
template <class Side>
UnitPress unit_press(const analysis::Problem &problem, double time, const std::vector<Side> &sides, int k,
                     const solver::LinearSolverOptions &options);

/// The most that the pressures of a side can come to; infinite where they have no limit [N], in 2D per m.
template <class Side>
double largest_force(const Side &c);

} // namespace rpc::bound
