// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/fem/dirichlet.hpp"

/// The elimination of prescribed unknowns from some nodes' rows of a stiffness matrix.
namespace rpc::fem
{

/// The owned nodes that share a cell with a node of which something is prescribed, ascending.
/// @param fixed  (overlap dofs)
DeviceView<LO *> nodes_beside_prescribed(const Discretization &d, const DeviceView<char *> &fixed);

/// The entries of some nodes' rows in the columns of prescribed unknowns.
PrescribedCouplings listed_couplings(const RowsOfNodes &rows, int dim, const DeviceView<char *> &fixed);

/// Entries between an unknown that is prescribed and any other become 0.
void clear_couplings(const RowsOfNodes &rows, int dim, const DeviceView<char *> &fixed);

} // namespace rpc::fem
