#pragma once

#include "rpc/fem/elasticity.hpp"

namespace rpc::fem
{

/// Nodal stresses by polynomial preserving recovery (Zhang and Naga, SIAM J. Sci. Comput. 26, 2005).    doc/theory.md (2.8)
///
/// Around each vertex a polynomial of degree p + 1 is fitted to the nodal displacements, and Hooke's law applied to its
/// gradient. Exact for displacements of degree p + 1, hence of order p + 1 for smooth ones, at the boundary too; the
/// element's own stresses have order p. No polynomial mixes blocks; where blocks meet, a node has a mean of both sides.
/// Where the dilatation is projected, (2.11), its part of the stress comes from a polynomial fitted to the projection, (2.12):
/// lambda tr eps of fitted displacements would amplify their errors by 1 / (1 - 2 nu).
/// Columns: xx, yy, xy (2D); xx, yy, zz, xy, yz, xz (3D); and last the von Mises stress, which in plane strain counts
/// sigma_zz = lambda (eps_xx + eps_yy). [Pa]
/// @param u  (owned dofs) [m]     @return (owned nodes; 4 or 7); collective
/// @throws rpc::Error (bad_input) if a material is given for a block that the mesh does not have
RCP<MultiVector> nodal_stresses(const Discretization &d, const Materials &materials, const Vector &u);

/// Names of its columns: stress_xx, ..., von_mises.
std::vector<std::string> stress_names(int dim);

} // namespace rpc::fem
