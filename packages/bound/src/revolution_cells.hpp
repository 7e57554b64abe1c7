// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cells.hpp"
#include "equilibration.hpp"

#include <string>

/// Cells of bodies of revolution: what differs from those of the plane. Tractions are those of S = 2 pi r s, and of S without the stress
/// that takes up a body force along the axis.                                                            doc/bounds.md (13.10a)
namespace rpc::bound
{

CellForms forms_of_revolution(const CellInput &in, const Vector &u);
StressDifference difference_of_revolution(const CellInput &in, const Comm &comm, const Tractions &t, const Vector &u,
                                          const DeviceView<double *> &of_cell);

/// Collective. @param u  (overlap dofs)
Squared squared_of_revolution(const CellInput &in, const Comm &comm, const Vector &u);

/// Takes tractions of the stress that takes up the body force away, and what is left on the axis: the force on each facet stays.
void admit_on_axis(const CellInput &in, const Tractions &t);

/// Why stresses of the order cannot take up the loads; empty if they can. At the axis, where they vanish, nothing lifts what loads have
/// beyond the order, and of order 1 nothing does what S_zz = -2 pi r z f_z has on slanted sides. Collective.
/// @param num_owned  nodes of this rank
std::string loads_not_covered(const CellInput &in, const Comm &comm, const BoundaryTractions &loads, LO num_owned);

} // namespace rpc::bound
