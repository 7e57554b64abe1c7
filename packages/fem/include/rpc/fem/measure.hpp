// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/elasticity.hpp"

/// Sizes of a body and its sides, and what loads are in all: what a user can tell from a drawing.
namespace rpc::fem
{

struct BodyMeasure {
  double volume = 0;      ///< [m^3], in the plane [m^2]; of the whole body of revolution in axisymmetry
  Point lower{}, upper{}; ///< corners of the box around it [m]
};
/// Collective.
BodyMeasure body_measure(const Discretization &d);

struct SideMeasure {
  double area = 0; ///< [m^2], in the plane [m]; of the whole surface of revolution in axisymmetry
  Point normal{};  ///< mean of the outward unit normal over the side in the mesh; shorter than 1 where the side is bent
};
/// Collective.
SideMeasure side_measure(const Discretization &d, const mesh::Side &side);

/// Resultant of a load on a side and of one on the body [N], in the plane per m; in axisymmetry along the axis. At the times at which
/// the fields are seen. Collective.
Point resultant(const Discretization &d, const TractionLoad &load);
Point resultant(const Discretization &d, const VectorField &body_force);

} // namespace rpc::fem
