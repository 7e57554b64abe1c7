// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "equilibration.hpp"
#include "space_stress.hpp"

/// What cells.hpp has in the plane, for tetrahedra.
namespace rpc::bound
{

/// The energies of the kinds of cells by their tractions, outward, the inner stresses at their best:
///
///     E_T(t) = t . A t/2 + b . t + const.                                                             doc/theory.md (13.8)
struct SpaceForms {
  DeviceView<float ***> A; ///< (kinds, tractions, tractions); it only steers the descent
  DeviceView<double **> b; ///< (kinds, tractions) what the body force adds
  DeviceView<double ***>
      inner; ///< (kinds, tractions + 1, inner) the best inner stresses by tractions of the image; the last row is that of the body force
  DeviceView<double *> boundary; ///< (facets * polynomials * 3) what the displacement on the boundary adds
};
SpaceForms cell_forms(const SpaceInput &in, const Vector &u);
void add_up(const SpaceInput &in, const SpaceForms &forms, const Tractions &t, bool linear,
            const DeviceView<double **> &scratch, const Tractions &sum);
StressDifference stress_difference(const SpaceInput &in, const SpaceForms &forms, const Tractions &t, const Vector &u,
                                   const DeviceView<double *> &of_cell);
double norm_of_lifted_loads(const SpaceInput &in, const LiftedLoads &lifted, const DeviceView<double ***> &load);
DeviceView<double ***> nodal_forces(const SpaceInput &in, const fem::Discretization &d, const Vector &u);
/// (facets, nodes of a facet, 3)
DeviceView<double ***> mean_moments(const SpaceInput &in, const Vector &u);
/// (facets, nodes of a facet, 3)
DeviceView<double ***> known_moments(const SpaceInput &in, const BoundaryTractions &boundary);
Tractions equilibrated(const SpaceInput &in, const BoundaryTractions &boundary, const DeviceView<double ***> &Q,
                       const DeviceView<double ***> &mean, const fem::NodeToCells &around);
double largest_distortion(const SpaceInput &in, const mesh::Element &element);

/// Kinds of cells, for `kind` and `example`.
void find_kinds(SpaceInput &in);

} // namespace rpc::bound
