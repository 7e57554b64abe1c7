// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"
#include "rpc/fem/discretization.hpp"

#include <string>
#include <vector>

namespace rpc::fem
{

/// A part of the body that shares no node with the rest of it. Its cells may be joined in single points only, see
/// require_stiff_joints().
struct Part {
  GO num_cells = 0;
  Point centre{};          ///< mean of its nodes [m]
  double radius = 0;       ///< largest distance of its nodes from there [m]
  std::vector<int> blocks; ///< of the mesh that it has cells of, ascending
};

/// The connected parts of a body, in the order of their smallest node ids: the same on all ranks and, up to rounding, on
/// any number of ranks.
struct Parts {
  std::vector<Part> part;
  DeviceView<int *> of_node;    ///< (overlap nodes) index into part
  DeviceView<double **> centre; ///< (parts, dim) [m]
  DeviceView<double *> radius;  ///< (parts) [m]

  int size() const { return static_cast<int>(part.size()); }
};

/// Union of the nodes of each cell on this rank, then an exchange of the smallest node id with the neighbours until no
/// rank learns anything new. O(nodes); collective.
Parts connected_parts(const Discretization &d);

/// "the body" if there is but one part, else "the part in block "steel" (120 cells around (2.5, 0.5))".
std::string name_of(const mesh::Mesh &mesh, const Parts &parts, int part);

} // namespace rpc::fem
