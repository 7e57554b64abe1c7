#include "rpc/fem/stress.hpp"

#include "patch_recovery.hpp"

namespace rpc::fem
{
namespace
{

DeviceView<int **> device_table(const std::vector<std::vector<int>> &rows, const std::string &label)
{
  DeviceView<int **> table(label, rows.size(), rows[0].size());
  const auto host = Kokkos::create_mirror_view(table);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < rows[r].size(); ++c) host(r, c) = rows[r][c];
  Kokkos::deep_copy(table, host);
  return table;
}

/// (vertices, dim): for each facet at a vertex the vertex that lies opposite in it, an edge's other end or a
/// quadrilateral's far corner. With the vertex, it tells the facet from all others around the vertex.
DeviceView<int **> facet_mates(const mesh::Element &element)
{
  std::vector<std::vector<int>> mates(element.num_vertices());
  const int corners = 1 << (element.dim - 1); // facets are edges or quadrilaterals, corners first and in turn
  for (const auto &facet : element.facets())
    for (int i = 0; i < corners; ++i) mates[facet[i]].push_back(facet[(i + corners / 2) % corners]);
  return device_table(mates, "rpc::fem::facet_mates");
}

/// (nodes, vertices): 1 for the vertices of the edge, face or cell inside which a node lies, or which it is itself;
/// those are the ones whose linear shape function is not 0 there.
DeviceView<int **> carrying_vertices(const mesh::Element &element)
{
  std::vector<std::vector<int>> carries;
  const auto &lattice = element.lattice();
  for (const auto &node : lattice) {
    carries.emplace_back();
    for (int v = 0; v < element.num_vertices(); ++v) {
      int shape = 1, rest = element.order;
      for (int i = 0; i < element.dim; ++i) rest -= node[i];
      if (element.shape == mesh::Shape::tensor) {
        for (int i = 0; i < element.dim; ++i) shape *= lattice[v][i] == 0 ? element.order - node[i] : node[i];
      } else {
        shape = v == 0 ? rest : node[v - 1];
      }
      carries.back().push_back(shape > 0 ? 1 : 0);
    }
  }
  return device_table(carries, "rpc::fem::carrying_vertices");
}

/// The table of the owned nodes with those of the overlap; the table itself on one rank.
RCP<const MultiVector> with_overlap(const mesh::Mesh &mesh, const RCP<const MultiVector> &owned, const Import &import)
{
  if (mesh.owned_nodes == mesh.overlap_nodes) return owned;
  const auto overlap = rcp(new MultiVector(mesh.overlap_nodes, owned->getNumVectors()));
  overlap->doImport(*owned, import, Tpetra::INSERT);
  return overlap;
}

template <int Dim, int Nodes>
RCP<MultiVector> recover(const Discretization &d, const ElasticCells<Dim, Nodes> &body, const Vector &u_overlap)
{
  using Table = PatchTable<Dim, Nodes>;
  const mesh::Mesh &mesh = *d.mesh;
  const auto nodes = device_range(mesh.num_owned_nodes());
  const NodeCells &around = d.around;
  const Import import(mesh.owned_nodes, mesh.overlap_nodes);
  const auto table = rcp(new MultiVector(mesh.owned_nodes, Table::columns)); // zero
  {
    const FitPatch<Dim, Nodes> fit{body,
                                   d.reference.recovery.value,
                                   device_read(u_overlap),
                                   around.row,
                                   around.cell,
                                   d.nodes,
                                   facet_mates(mesh.element),
                                   table->getLocalViewDevice(Tpetra::Access::ReadWrite)};
    Kokkos::parallel_for("rpc::fem::fit_patch", nodes, fit);
    Kokkos::fence();
  }
  {
    const auto from = with_overlap(mesh, table, import);
    const AdoptPolynomial<Dim, Nodes> adopt{mesh.cells,
                                            around.row,
                                            around.cell,
                                            from->getLocalViewDevice(Tpetra::Access::ReadOnly),
                                            table->getLocalViewDevice(Tpetra::Access::ReadWrite),
                                            mesh.element.num_vertices()};
    Kokkos::parallel_for("rpc::fem::adopt_polynomial", nodes, adopt);
    Kokkos::fence();
  }
  const auto result = rcp(new MultiVector(mesh.owned_nodes, stress_names(Dim).size()));
  const auto all = with_overlap(mesh, table, import);
  const EvaluatePatches<Dim, Nodes> evaluate{body,
                                             around.row,
                                             around.cell,
                                             carrying_vertices(mesh.element),
                                             all->getLocalViewDevice(Tpetra::Access::ReadOnly),
                                             result->getLocalViewDevice(Tpetra::Access::ReadWrite)};
  Kokkos::parallel_for("rpc::fem::evaluate_patches", nodes, evaluate);
  Kokkos::fence();
  return result;
}

} // namespace

std::vector<std::string> stress_names(const int dim)
{
  if (dim == 2) return {"stress_xx", "stress_yy", "stress_xy", "von_mises"};
  return {"stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz", "stress_xz", "von_mises"};
}

RCP<MultiVector> nodal_stresses(const Discretization &d, const Materials &materials, const Vector &u)
{
  Vector u_overlap(d.overlap_dofs);
  u_overlap.doImport(u, *d.dof_import, Tpetra::INSERT);
  RCP<MultiVector> result;
  with_static_extents(d.mesh->element, [&](const auto dim, const auto nodes) {
    result = recover(d, elastic_cells<dim, nodes>(d, materials), u_overlap);
  });
  return result;
}

} // namespace rpc::fem
