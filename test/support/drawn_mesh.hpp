// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/distribute.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace rpc::test
{

/// A plane mesh of unit squares as drawn, top row first: a letter is a cell of the block of that name, '.' is none. The
/// lower left corner of the drawing is the origin. Sides of each block: "a left", "a right", "a bottom", "a top", all its
/// facets that face that way and no other cell.
inline mesh::MeshData drawn(const std::vector<std::string> &rows)
{
  const int height = static_cast<int>(rows.size()), width = static_cast<int>(rows[0].size());
  const auto at = [&](const int i, const int j) {
    return i < 0 || j < 0 || i >= width || j >= height ? '.' : rows[height - 1 - j][i];
  };
  mesh::MeshData mesh;
  mesh.element = {2, 1};
  std::map<std::pair<int, int>, int> node;
  std::map<std::string, mesh::SideData> sides;
  for (const std::string &row : rows)
    for (const char name : row)
      if (name != '.' && std::count(mesh.blocks.begin(), mesh.blocks.end(), std::string(1, name)) == 0)
        mesh.blocks.push_back(std::string(1, name));
  std::sort(mesh.blocks.begin(), mesh.blocks.end());
  const auto &lattice = mesh.element.lattice();
  const auto &facets = mesh.element.facets();
  const std::vector<std::string> names = {"left", "right", "bottom", "top"};
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      if (at(i, j) == '.') continue;
      const std::string block(1, at(i, j));
      const int cell = static_cast<int>(mesh.block.size());
      mesh.block.push_back(
          static_cast<int>(std::find(mesh.blocks.begin(), mesh.blocks.end(), block) - mesh.blocks.begin()));
      for (const auto &corner : lattice) {
        const std::pair<int, int> place{i + corner[0], j + corner[1]};
        const auto [entry, fresh] = node.emplace(place, static_cast<int>(node.size()));
        if (fresh) mesh.coords.insert(mesh.coords.end(), {double(place.first), double(place.second)});
        mesh.cells.push_back(entry->second);
      }
      for (int f = 0; f < 4; ++f) {
        const auto &a = lattice[facets[f][0]], &b = lattice[facets[f][1]];
        const int axis = a[0] == b[0] ? 0 : 1, end = a[axis];
        const int shift = 2 * end - 1;
        if (at(i + (axis == 0 ? shift : 0), j + (axis == 1 ? shift : 0)) != '.') continue;
        auto &side = sides[block + " " + names[2 * axis + end]];
        side.cell.push_back(cell);
        side.ordinal.push_back(f);
      }
    }
  }
  for (auto &[name, side] : sides) {
    side.name = name;
    mesh.sides.push_back(side);
  }
  return mesh;
}

inline std::shared_ptr<const mesh::Mesh> distributed(const mesh::MeshData &whole)
{
  return std::make_shared<mesh::Mesh>(mesh::distribute(whole, Tpetra::getDefaultComm()));
}

} // namespace rpc::test
