#pragma once

#include "rpc/mesh/mesh.hpp"

namespace rpc::fem
{

/// Cells around each owned node, as offsets and list; the order within a node is not fixed.
struct NodeCells {
  DeviceView<std::size_t *> row; ///< (owned nodes + 1)
  DeviceView<LO *> cell;         ///< (entries) local cells
};

NodeCells cells_around_nodes(const mesh::Mesh &mesh);

} // namespace rpc::fem
