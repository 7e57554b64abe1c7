// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

/// Whole meshes of blocks, of any element.
namespace rpc::test
{

/// Cells that fill a block of so many lattice cells: the lattice itself, or each of its cells cut into simplices along one
/// diagonal, as Kuhn does: 2 triangles or 6 tetrahedra.
inline mesh::MeshData block(const mesh::Element &element, const std::array<int, 3> &cells)
{
  const int dim = element.dim, p = element.order;
  std::map<std::array<int, 3>, int> node;
  mesh::MeshData data;
  data.element = element;
  const auto node_at = [&](const std::array<int, 3> &at) {
    const auto [entry, fresh] = node.emplace(at, static_cast<int>(node.size()));
    for (int d = 0; d < dim && fresh; ++d) data.coords.push_back(double(at[d]) / p);
    return entry->second;
  };
  /// A cell whose reference coordinates run along some tangents from an origin.
  const auto add = [&](const std::array<int, 3> &origin, const std::array<std::array<int, 3>, 3> &tangent) {
    for (const auto &place : element.lattice()) {
      std::array<int, 3> at{};
      for (int i = 0; i < 3; ++i) {
        at[i] = p * origin[i];
        for (int d = 0; d < dim; ++d) at[i] += place[d] * tangent[d][i];
      }
      data.cells.push_back(node_at(at));
    }
    data.block.push_back(0);
  };
  for (int z = 0; z < (dim == 3 ? cells[2] : 1); ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x) {
        if (element.shape == mesh::Shape::tensor) {
          add({x, y, z}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
          continue;
        }
        std::array<int, 3> axes = {0, 1, 2}; // a path along these leads from one corner to the opposite one
        do {
          if (dim == 2 && axes[2] != 2) continue;
          std::array<std::array<int, 3>, 3> tangent{};
          for (int k = 0; k < dim; ++k)
            for (int l = 0; l <= k; ++l) tangent[k][axes[l]] = 1;
          const int inversions = (axes[0] > axes[1]) + (axes[0] > axes[2]) + (axes[1] > axes[2]);
          if (inversions % 2 == 1) std::swap(tangent[dim - 2], tangent[dim - 1]);
          add({x, y, z}, tangent);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  data.blocks = {"body"};
  return data;
}

} // namespace rpc::test
