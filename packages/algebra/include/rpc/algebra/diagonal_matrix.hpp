// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

namespace rpc
{

/// The matrix with these entries on its diagonal, and no others.
/// @param diagonal  on the map of its rows and columns
RCP<CrsMatrix> diagonal_matrix(const Vector &diagonal);

} // namespace rpc
