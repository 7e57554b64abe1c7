// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"

namespace rpc::fem
{

/// Finds the cells that are each other's translates; no kinds on a rank where there are more than a few. Collective.
CongruentCells congruent_cells(const mesh::Mesh &mesh);

} // namespace rpc::fem
