// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/elasticity.hpp"

namespace rpc::fem
{

/// The largest numbers of a deformed body.
struct BodyPeaks {
  double displacement = 0; ///< length of a node's displacement [m]
  double strain = 0;       ///< principal strain, in size
  double von_mises = 0;    ///< von Mises stress [Pa]
};

/// The largest displacement among the nodes, and the largest strain and stress among the integration points of the cells, from the
/// displacement as it is, not recovered: RecoveredStress is of higher order, and may be larger at the boundary. Principal strains
/// and stresses across the plane count.                                                                doc/theory.md (2.15)
/// One pass over the cells; collective.
/// @param u  (owned dofs) [m]
/// @throws rpc::Error (bad_input) if a material is given for a block that the mesh does not have
BodyPeaks body_peaks(const Discretization &d, const Materials &materials, const Vector &u);

} // namespace rpc::fem
