#pragma once

#include "rpc/fem/discretization.hpp"

namespace rpc::fem
{

/// Finds the cells that are each other's translates; no shapes where there are more than a few.
CellShapes cell_shapes(const mesh::Mesh &mesh);

} // namespace rpc::fem
