// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box_parts.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace rpc::mesh
{

BoxParts box_parts(const Element &element)
{
  const Element::Table &lattice = element.lattice();
  if (element.shape == Shape::tensor) return {lattice};
  std::vector<Element::Table> corners; // (parts, vertices, dim), 0 or 1
  if (element.dim == 2) {
    corners = {{{0, 0}, {1, 0}, {0, 1}}, {{1, 1}, {0, 1}, {1, 0}}};
  } else {
    std::array<int, 3> direction{0, 1, 2};
    do {
      Element::Table path(4, std::vector<int>(3, 0));
      for (int v = 1; v < 4; ++v) {
        path[v] = path[v - 1];
        path[v][direction[v - 1]] = 1;
      }
      const bool even = (direction[1] - direction[0] + 3) % 3 == 1; // an odd order mirrors the tetrahedron
      if (!even) std::swap(path[1], path[2]);
      corners.push_back(path);
    } while (std::next_permutation(direction.begin(), direction.end()));
  }
  BoxParts parts;
  for (const Element::Table &corner : corners) {
    Element::Table places;
    for (const auto &node : lattice) {
      std::vector<int> place(element.dim);
      for (int i = 0; i < element.dim; ++i) {
        place[i] = element.order * corner[0][i];
        for (int d = 0; d < element.dim; ++d) place[i] += node[d] * (corner[d + 1][i] - corner[0][i]);
      }
      places.push_back(place);
    }
    parts.push_back(places);
  }
  return parts;
}

} // namespace rpc::mesh
