// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "equilibration.hpp"
#include "space_stress.hpp"

/// What cells.hpp has in the plane, for tetrahedra.
namespace rpc::bound
{

/// The energies of the kinds of cells by their tractions, outward, the inner stresses at their best:
///
///     E_T(t) = t . A t/2 + b . t + const.                                                             doc/bounds.md (13.8)
struct SpaceForms {
  /// (kinds, numbers) It only steers the descent. The rows of the lower triangle if `lower`, else whole rows.
  Kokkos::View<float **, Kokkos::LayoutRight, Device> A;
  bool lower = false; ///< cells are all different: memory counts, and what is read once is not slower so
  /// The same, whole, in double precision, by which the bound itself is found; empty where there are too many kinds.
  Kokkos::View<double ***, Kokkos::LayoutRight, Device> exact;
  Kokkos::View<double **, Kokkos::LayoutRight, Device> b; ///< (kinds, tractions) what the body force adds
  /// (kinds, numbers) Rows of the inner stresses as factor_inner() leaves them. Empty if `lower`, and where there are none.
  Kokkos::View<double **, Kokkos::LayoutRight, Device> inner;
  DeviceView<double *> boundary; ///< (outer facets * polynomials * 3) what the displacement on the boundary adds

  KOKKOS_INLINE_FUNCTION float second(const int kind, const int size, const int i, const int j) const
  {
    if (!lower) return A(kind, i * size + j);
    return A(kind, i < j ? row_of_triangle(j) + i : row_of_triangle(i) + j);
  }
};
/// @param u  (overlap dofs)
SpaceForms cell_forms(const SpaceInput &in, const Vector &u);
/// @param[out] out  of t's size, in single precision: it steers the descent; right on facets that are whole
/// @return the sum of t times the derivative without what displacements of the boundary add, over this rank's cells
double derivative(const SpaceInput &in, const SpaceForms &forms, const Tractions &t, bool linear,
                  const DeviceView<float *> &out);
/// Collective. @param of_cell  (owned cells)
StressDifference stress_difference(const SpaceInput &in, const Comm &comm, const SpaceForms &forms, const Tractions &t,
                                   const Vector &u, const DeviceView<double *> &of_cell);
double norm_of_lifted_loads(const SpaceInput &in, const Comm &comm, const LiftedLoads &lifted,
                            const DeviceView<double ***> &load);
DeviceView<double ***> nodal_forces(const SpaceInput &in, const fem::Discretization &d, const Vector &u);
/// (facets * nodes of a facet * 3)
Tractions mean_moments(const SpaceInput &in, const Vector &u);
/// (facets, nodes of a facet, 3)
DeviceView<double ***> known_moments(const SpaceInput &in, const BoundaryTractions &boundary);
/// Collective. @param[in,out] Q, mean  are used up: the tractions have the memory of `mean`
Tractions equilibrated(const SpaceInput &in, const BoundaryTractions &boundary, const DeviceView<double ***> &Q,
                       const Tractions &mean, const fem::NodeToCells &around, const SpaceExchanges &exchanges);
double largest_distortion(const SpaceInput &in, const mesh::Element &element);

/// Kinds of cells, for `kind` and `example`. Collective. @param comm  of the mesh
void find_kinds(SpaceInput &in, const Comm &comm);

} // namespace rpc::bound
