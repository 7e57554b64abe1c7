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
  /// (kinds, tractions, tractions), each of which lies in one piece; it only steers the descent
  Kokkos::View<float ***, Kokkos::LayoutRight, Device> A;
  /// The same in double precision, by which the bound itself is found; empty where there are too many kinds.
  Kokkos::View<double ***, Kokkos::LayoutRight, Device> exact;
  Kokkos::View<double **, Kokkos::LayoutRight, Device> b; ///< (kinds, tractions) what the body force adds
  DeviceView<double ***>
      inner; ///< (kinds, tractions + 1, inner) the best inner stresses by tractions of the image; the last row is that of the body force
  DeviceView<double *> boundary; ///< (outer facets * polynomials * 3) what the displacement on the boundary adds
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
