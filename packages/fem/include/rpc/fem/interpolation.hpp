// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"

namespace rpc::fem
{

/// Values of finite element functions of one mesh at the nodes of another one of the same body: with w_a the values at the
/// coarse nodes, (P w)_n = sum_a N_a(x_n) w_a.
///
/// A fine node outside the coarse mesh, as there are at curved boundaries, takes the value at a point of the nearest cell:
/// where the reference cell is nearest to its reference coordinates. Rows sum to 1; functions that are affine in x
/// are exact at nodes inside. Entries below 1e-12 are left out. P is the same on any number of ranks, each mesh being divided
/// in its own way.
///
/// Between two divisions of one box (Mesh::box) a node's indices tell its cell and that cell's nodes, whoever owns them: without a
/// search or questions to other ranks, and to rounding of the weights alone. Otherwise ranks look into their own cells, and others
/// send them the points that lie in the box around these, and, of points outside the mesh, those to which they may be the nearest. A
/// rank holds as much as its own parts of both meshes and the points that lie in its box ask for. Cells are found by bins of about
/// the mean cell's size: many times smaller cells in a part of the body make it slower.
/// @return (fine owned nodes x coarse owned nodes), fill-complete, columns ascending in each row; collective
/// @throws rpc::Error on every rank if the meshes have different dimensions
RCP<CrsMatrix> interpolation(const Discretization &coarse, const Discretization &fine);

/// A displacement on the finer mesh; collective.
/// @param interpolation  see above   @param u  (coarse owned dofs)   @param fine_dofs  owned dofs of the finer mesh
RCP<Vector> interpolated(const Operator &interpolation, const Vector &u, int dim, const RCP<const Map> &fine_dofs);

} // namespace rpc::fem
