// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <Teuchos_ParameterList.hpp>

namespace rpc::solver
{

/// Smoothed aggregation with a polynomial smoother, which is the same on every backend and number of ranks.
Teuchos::ParameterList muelu_defaults(const Map &dofs, int dofs_per_node);

} // namespace rpc::solver
