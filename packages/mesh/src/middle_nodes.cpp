#include "middle_nodes.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace rpc::mesh
{

MeshData with_middle_nodes(MeshData mesh)
{
  const Element linear = mesh.element, element{2, 2, linear.shape};
  const int num_cells = mesh.num_cells(), width = linear.num_nodes(), new_width = element.num_nodes();
  std::vector<int> cells(std::size_t(new_width) * num_cells);
  using Edge = std::array<int, 3>; // lower and higher end, place of the middle node in `cells`
  std::vector<Edge> edges;
  edges.reserve(std::size_t(linear.num_facets()) * num_cells);
  for (int c = 0; c < num_cells; ++c) {
    const int *const nodes = &mesh.cells[std::size_t(width) * c];
    std::copy_n(nodes, width, &cells[std::size_t(new_width) * c]);
    for (const auto &facet : element.facets()) {
      const auto [low, high] = std::minmax(nodes[facet[0]], nodes[facet[1]]);
      edges.push_back({low, high, new_width * c + facet[2]});
    }
  }
  std::sort(edges.begin(), edges.end());

  int next = mesh.num_nodes() - 1;
  const Edge *before = nullptr;
  for (const Edge &edge : edges) {
    if (!before || edge[0] != (*before)[0] || edge[1] != (*before)[1]) {
      ++next;
      for (int d = 0; d < 2; ++d)
        mesh.coords.push_back(mesh.coords[2 * std::size_t(edge[0]) + d] / 2 +
                              mesh.coords[2 * std::size_t(edge[1]) + d] / 2);
    }
    cells[edge[2]] = next;
    before = &edge;
  }
  if (element.shape == Shape::tensor)
    for (int c = 0; c < num_cells; ++c) {
      const int *const nodes = &mesh.cells[std::size_t(width) * c];
      for (int d = 0; d < 2; ++d) {
        double sum = 0;
        for (int v = 0; v < width; ++v) sum += mesh.coords[2 * std::size_t(nodes[v]) + d] / width;
        mesh.coords.push_back(sum);
      }
      cells[std::size_t(new_width) * (c + 1) - 1] = ++next;
    }
  mesh.element = element;
  mesh.cells = std::move(cells);
  return mesh;
}

} // namespace rpc::mesh
