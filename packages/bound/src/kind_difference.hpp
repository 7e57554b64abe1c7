// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "space_cells.hpp"

namespace rpc::bound
{

/// Whether there are few enough kinds of cells for SpaceForms::exact, and this rank's cells are their kinds but for rounding. Not with body
/// forces, and not for parts of hexahedra, in which C eps(u) is not constant.
bool energies_by_kinds(const SpaceInput &in);

/// stress_difference() from SpaceForms::exact: C eps(u) is a stress of the cell too, so that its tractions are taken from those of sigma, and the
/// energy is that of what is left. Collective.
StressDifference difference_of_kinds(const SpaceInput &in, const Comm &comm, const SpaceForms &forms,
                                     const Tractions &t, const Vector &u, const DeviceView<double *> &of_cell);

} // namespace rpc::bound
