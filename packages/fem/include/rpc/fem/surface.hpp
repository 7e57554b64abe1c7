// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/evaluate.hpp"
#include "rpc/fem/discretization.hpp"

namespace rpc::fem
{

/// (n, dim) Where nodes are [m], on the host.
HostPoints node_positions(const mesh::Mesh &mesh, const DeviceView<LO *> &node);

/// Integration weights of the points of ReferenceElement::facet on a side: (facets * points), facet by facet [m^(dim-1), axisymmetric:
/// m^2].
DeviceView<double *> facet_measure(const Discretization &d, const mesh::Side &side);
/// How far the facets of a side reach, (facets) [m]: in the plane their lengths, in space the roots of their areas.
DeviceView<double *> facet_size(const Discretization &d, const mesh::Side &side);

/// Owned nodes of a side with the weights of nodal quadrature: int f ds ~ sum_i weight_i f(x_i). doc/theory.md (2.7)
///
/// The vertices of quadratic triangles have weight 0, see mesh::nodal_rule(), and so have, with order 2, nodes on the axis of an
/// axisymmetric body (2.7a); all other weights are positive.
struct SurfaceNodes {
  DeviceView<LO *> node;       ///< (n) owned node lids, ascending
  DeviceView<double *> weight; ///< (n) w_i [m^(dim-1), axisymmetric: m^2]
  DeviceView<double **>
      normal; ///< (n, dim) outward unit normal of the body, averaged by area over the facets at the node
};

/// @throws rpc::Error (bad_mesh) on every rank if a facet has no area; collective
SurfaceNodes surface_nodes(const Discretization &d, const mesh::Side &side);

/// For each node of a side that `known` leaves out, the mean over the known nodes with which it shares a facet; 0 if
/// there are none. A vertex of quadratic triangles whose middle nodes are known takes the value of the linear function through
/// these, an end of quadratic edges that of the linear function through the other two nodes, the mean over such facets: both are
/// exact for linear functions. On the axis of a body of revolution it is the parabola without slope there.
///
/// Serves contact nodes to which the contact law gives no pressure: those whose normal displacement is prescribed, and those
/// without weight. doc/theory.md (3.5)
/// @param[in,out] value  (owned nodes of the mesh) values where known   @param[in] known (owned nodes) 1 or 0;
/// collective
void extend_to_unknown(const Discretization &d, const mesh::Side &side, Vector &value, const Vector &known);

} // namespace rpc::fem
