// SPDX-License-Identifier: BSD-3-Clause
#include "cell_kinds.hpp"

#include <algorithm>
#include <cstddef>

namespace rpc::mesh
{

int CellKind::num_quadrilaterals() const
{
  return static_cast<int>(
      std::count_if(faces.begin(), faces.end(), [](const std::vector<int> &face) { return face.size() == 4; }));
}

int CellKind::num_nodes(const int type) const
{
  if (type == linear) return num_vertices;
  const int with_edges = num_vertices + static_cast<int>(edges.size());
  if (type == serendipity) return with_edges;
  const bool has_middle = dim == 2 ? num_vertices == 4 : num_vertices == 8;
  return with_edges + num_quadrilaterals() + (has_middle ? 1 : 0);
}

int CellKind::middle(const int a, const int b) const
{
  int node = num_vertices;
  for (const auto &edge : edges) {
    if ((edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a)) return node;
    ++node;
  }
  for (const auto &face : faces) {
    if (face.size() != 4) continue;
    const auto has = [&](const int v) { return std::find(face.begin(), face.end(), v) != face.end(); };
    if (has(a) && has(b)) return node;
    ++node;
  }
  return node;
}

std::vector<int> CellKind::nodes_of_face(const int face) const
{
  const std::vector<int> &vertices = faces[face];
  std::vector<int> nodes = vertices;
  for (std::size_t v = 0; v < vertices.size(); ++v)
    nodes.push_back(middle(vertices[v], vertices[(v + 1) % vertices.size()]));
  if (vertices.size() == 4) nodes.push_back(middle(vertices[0], vertices[2]));
  return nodes;
}

const CellKind *cell_kind(const int gmsh_type)
{
  static const std::vector<CellKind> kinds = {
      {2, 2, 0, 9, "triangle", "triangles", 3, {}, {{0, 1}, {1, 2}, {2, 0}}},
      {2, 3, 16, 10, "quadrilateral", "quadrilaterals", 4, {}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
      {3,
       4,
       0,
       11,
       "tetrahedron",
       "tetrahedra",
       4,
       {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
       {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}},
      {3,
       5,
       17,
       12,
       "hexahedron",
       "hexahedra",
       8,
       {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}},
       {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}}},
      {3,
       6,
       18,
       13,
       "wedge",
       "wedges",
       6,
       {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {0, 3, 5, 2}, {1, 2, 5, 4}},
       {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}}},
      {3,
       7,
       19,
       14,
       "pyramid",
       "pyramids",
       5,
       {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 3, 2, 1}},
       {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}}}};
  for (const CellKind &kind : kinds)
    if (gmsh_type > 0 && (gmsh_type == kind.linear || gmsh_type == kind.serendipity || gmsh_type == kind.quadratic))
      return &kind;
  return nullptr;
}

} // namespace rpc::mesh
