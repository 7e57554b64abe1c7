#pragma once

#include "rpc/fem/elasticity.hpp"

namespace rpc::fem
{

/// Nodal stresses by lumped L2 projection: the volume-weighted mean of the quadrature points' stresses. doc/theory.md
/// (2.8)
///
/// Second order inside on even meshes, first order at the boundary: for pictures. Columns: xx, yy, xy (2D); xx, yy, zz,
/// xy, yz, xz (3D); and last the von Mises stress, which in plane strain counts sigma_zz = nu (sigma_xx + sigma_yy).
/// [Pa]
/// @param u  (owned dofs) [m]     @return (owned nodes; 4 or 7); collective
RCP<MultiVector> nodal_stresses(const Discretization &d, const Material &material, const Vector &u);

/// Names of its columns: stress_xx, ..., von_mises.
std::vector<std::string> stress_names(int dim);

} // namespace rpc::fem
