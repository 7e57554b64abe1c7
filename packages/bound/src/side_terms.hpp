// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/mesh.hpp"

#include <algorithm>

/// What contact sides in the plane and in space share: integrals of (13.11), and where their points are.
namespace rpc::bound
{

/// Integrals over a facet of the energy of the law, psi(v) or s |e|, and of what the pair misses of it: psi(v) + psi*(p) - p v, or s |e| - q e.
///                                                                                                      doc/bounds.md (13.11)
struct ContactIntegrals {
  double energy = 0, gap = 0;

  /// A point of weight w. @param deep  penetration [m]   @param pressure  >= 0 [Pa]   @param of_conjugate  factor >= 1 of psi*(p)
  void add(const double w, const double deep, const double pressure, const contact::Foundation &f,
           const bool never_gives_way, const double of_conjugate = 1)
  {
    if (never_gives_way) { // there is no penetration
      gap += w * pressure * std::max(0., -deep);
      return;
    }
    const double of_foundation = contact::foundation_energy(deep, f);
    energy += w * of_foundation;
    gap += w * std::max(0., of_foundation + of_conjugate * contact::conjugate_energy(pressure, f) - pressure * deep);
  }
};

/// The node of a side's point. -1: it is another rank's.
template <class SidePoint>
LO owned_node(const SidePoint &point, const mesh::Mesh &mesh)
{
  const GO lid = static_cast<GO>(point.gid) - mesh.owned_nodes->getMinGlobalIndex();
  return lid >= 0 && lid < mesh.num_owned_nodes() ? static_cast<LO>(lid) : -1;
}

/// Whether the foundation of a side gives way to nothing.
template <class Side>
bool never_gives_way(const Side &c)
{
  return c.spring == 0 && !c.limit_of.empty() && contact::is_rigid(c.limit_of[0][0]);
}

} // namespace rpc::bound
