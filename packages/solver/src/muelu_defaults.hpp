// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <Teuchos_ParameterList.hpp>

namespace rpc::solver
{

/// Rows up to which even MueLu's hierarchy is a direct solver: coarser meshes would save little there, and CG would leave a rest.
constexpr GO few_rows = 1000;

/// Smoothed aggregation with a polynomial smoother, which is the same on every backend and number of ranks.
Teuchos::ParameterList muelu_defaults(const Map &dofs, int dofs_per_node);

} // namespace rpc::solver
