// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/elasticity.hpp"

namespace rpc::fem
{

/// Stresses by polynomial preserving recovery (Zhang and Naga, SIAM J. Sci. Comput. 26, 2005).    doc/theory.md (2.13)
///
/// Around each vertex a polynomial of degree p + 1 is fitted to the nodal displacements, and Hooke's law applied to its
/// gradient. Exact for displacements of degree p + 1, hence of order p + 1 for smooth ones, at the boundary too; the
/// element's own stresses have order p. No polynomial mixes blocks. Where the dilatation is projected, (2.6), its part of
/// the stress comes from a polynomial fitted to the projection, (2.14): lambda tr eps of fitted displacements would amplify
/// their errors by 1 / (1 - 2 nu).
class RecoveredStress
{
public:
  /// @param u  (owned dofs) [m]; collective
  /// @throws rpc::Error (bad_input) if a material is given for a block that the mesh does not have
  RecoveredStress(Discretization d, Materials materials, const Vector &u);

  /// Columns: xx, yy, xy (2D), in axisymmetry then theta; xx, yy, zz, xy, yz, xz (3D); and last the von Mises stress, which in plane strain counts
  /// sigma_zz = lambda (eps_xx + eps_yy); in plane stress sigma_zz = 0. Where blocks meet, a node has a mean of both sides.
  /// @return (owned nodes; 4, 5 or 7) [Pa]; collective
  RCP<MultiVector> at_nodes() const;

  /// int over each cell of (s* - s) : C^-1 (s* - s), for the recovered stress s* and that of u: twice the elastic energy
  /// of their difference (owned cells) [J], in the plane per m.                                                  (10.2)
  DeviceView<double *> squared_difference() const;

  /// s* n at the points of ReferenceElement::facet, n the outward normal: (facets, points, dim) [Pa].
  DeviceView<double ***> tractions(const mesh::Side &side) const;

private:
  Discretization d_;
  Materials materials_;
  RCP<Vector> u_;                      // (overlap dofs) [m]
  RCP<const MultiVector> polynomials_; // (overlap nodes; columns of PatchTable)
};

/// Means over each cell of the stress of u itself, with the dilatation as its stiffness has it (2.6), and the von Mises stress of
/// the mean: where blocks meet each cell has its own.
/// @param u  (owned dofs) [m]; collective   @return (owned cells; columns as RecoveredStress::at_nodes) [Pa]
DeviceView<double **> mean_stresses(const Discretization &d, const Materials &materials, const Vector &u);

/// Names of the columns of RecoveredStress::at_nodes: stress_xx, ..., von_mises.
std::vector<std::string> stress_names(const Discretization &d);

} // namespace rpc::fem
