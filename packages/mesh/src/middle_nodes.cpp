// SPDX-License-Identifier: BSD-3-Clause
#include "middle_nodes.hpp"

#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace rpc::mesh
{

MeshData with_middle_nodes(MeshData mesh)
{
  const Element linear = mesh.element, element{linear.dim, 2, linear.shape};
  const int dim = linear.dim;
  const int num_cells = mesh.num_cells(), width = linear.num_nodes(), new_width = element.num_nodes();
  const Entities edges = edges_of(linear, mesh.cells);
  const int first_middle = mesh.num_nodes();
  for (int e = 0; e < edges.size(); ++e) {
    const int *const ends = &edges.vertices[2 * std::size_t(e)];
    for (int d = 0; d < dim; ++d)
      mesh.coords.push_back(mesh.coords[dim * std::size_t(ends[0]) + d] / 2 +
                            mesh.coords[dim * std::size_t(ends[1]) + d] / 2);
  }
  std::vector<int> cells(std::size_t(new_width) * num_cells);
  for (int c = 0; c < num_cells; ++c) {
    int *const nodes = &cells[std::size_t(new_width) * c];
    std::copy_n(&mesh.cells[std::size_t(width) * c], width, nodes);
    for (int e = 0; e < edges.per_cell; ++e)
      nodes[element.edges()[e][2]] = first_middle + edges.of_cell[std::size_t(edges.per_cell) * c + e];
  }
  int next = first_middle + edges.size() - 1;
  if (element.shape == Shape::tensor)
    for (int c = 0; c < num_cells; ++c) {
      const int *const nodes = &mesh.cells[std::size_t(width) * c];
      for (int d = 0; d < dim; ++d) {
        double sum = 0;
        for (int v = 0; v < width; ++v) sum += mesh.coords[dim * std::size_t(nodes[v]) + d] / width;
        mesh.coords.push_back(sum);
      }
      cells[std::size_t(new_width) * (c + 1) - 1] = ++next;
    }
  mesh.element = element;
  mesh.cells = std::move(cells);
  return mesh;
}

} // namespace rpc::mesh
