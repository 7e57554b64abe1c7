// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/stiff_dilatation.hpp"
#include "rpc/fem/elasticity.hpp"

#include <optional>

/// The split of a nearly incompressible stiffness into a soft one and what the dilatation adds, for mixed solvers. doc/theory.md (4.13)
namespace rpc::fem
{

/// The same materials with Poisson's ratios of at most `ratio`, and their shear moduli, in blocks where the dilatation
/// is projected; it is projected there still. Nothing where no block changes.
/// @param ratio  in (0, 0.5)
std::optional<Materials> softened(const Discretization &d, const Materials &materials, double ratio);

/// What softened materials lack: a row of Z for each mode of the projection of each owned cell, cell by cell; collective.
/// @param soft        of softened()   @param prescribed  (overlap dofs) 1 where the displacement is
/// @param alternating  whether pressures that alternate from cell to cell are to have equations of their own, StiffDilatation::at_nodes. They
///                     never have where a cell has more than one mode
/// @throws rpc::Error (bad_input) if a material is given for a block that the mesh does not have
StiffDilatation stiff_dilatation(const Discretization &d, const Materials &materials, const Materials &soft,
                                 const DeviceView<char *> &prescribed, bool alternating);

} // namespace rpc::fem
