// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/dirichlet.hpp"

namespace rpc::fem
{

/// Refuses a body whose pieces are joined in single points only (in space also along edges), as on a hinge, where prescribed
/// displacements let them move against each other: the stiffness matrix is singular then, though the body is one part.
///
/// A piece is a set of cells that are joined over facets. Pieces move as rigid bodies that agree at the nodes which they share; the joints
/// are stiff enough if prescribed displacements leave them no motions but those of the body as a whole. Whether contact
/// alone would stop a joint is not looked into. Joints of an axisymmetric body are circles, and stiff.
///
/// Costs a look at the cells around each node. Where there are such points, rank 0 gets the pieces of each rank, the joints and up
/// to six held directions of each piece; collective.
/// @throws rpc::Error (no_solution) on every rank, naming the joint and its pieces
void require_stiff_joints(const Discretization &d, const DirichletDofs &dirichlet);

} // namespace rpc::fem
