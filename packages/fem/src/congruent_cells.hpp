#pragma once

#include "rpc/fem/discretization.hpp"

namespace rpc::fem
{

/// Finds the cells that are each other's translates; no kinds where there are more than a few.
CongruentCells congruent_cells(const mesh::Mesh &mesh);

} // namespace rpc::fem
