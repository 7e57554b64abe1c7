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

/// The polynomials of all vertices (overlap nodes).
template <int Dim, int Nodes>
RCP<const MultiVector> fit(const Discretization &d, const ElasticCells<Dim, Nodes> &body, const Vector &u_overlap)
{
  using Table = PatchTable<Dim, Nodes>;
  const mesh::Mesh &mesh = *d.mesh;
  const auto nodes = device_range(mesh.num_owned_nodes());
  const NodeCells &around = d.around;
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
    const auto from = nodes_on_overlap(d, table);
    const AdoptPolynomial<Dim, Nodes> adopt{mesh.cells,
                                            around.row,
                                            around.cell,
                                            from->getLocalViewDevice(Tpetra::Access::ReadOnly),
                                            table->getLocalViewDevice(Tpetra::Access::ReadWrite),
                                            mesh.element.num_vertices()};
    Kokkos::parallel_for("rpc::fem::adopt_polynomial", nodes, adopt);
    Kokkos::fence();
  }
  return nodes_on_overlap(d, table);
}

template <int Dim, int Nodes>
Polynomials<Dim, Nodes> polynomials(const ElasticCells<Dim, Nodes> &body, const MultiVector &table)
{
  return {body, table.getLocalViewDevice(Tpetra::Access::ReadOnly)};
}

} // namespace

std::vector<std::string> stress_names(const int dim)
{
  if (dim == 2) return {"stress_xx", "stress_yy", "stress_xy", "von_mises"};
  return {"stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz", "stress_xz", "von_mises"};
}

RecoveredStress::RecoveredStress(Discretization d, Materials materials, const Vector &u)
    : d_(std::move(d)), materials_(std::move(materials)), u_(rcp(new Vector(*on_overlap(d_, u), Teuchos::Copy)))
{
  with_static_extents(d_.mesh->element, [&](const auto dim, const auto nodes) {
    polynomials_ = fit(d_, elastic_cells<dim, nodes>(d_, materials_), *u_);
  });
}

RCP<MultiVector> RecoveredStress::at_nodes() const
{
  const mesh::Mesh &mesh = *d_.mesh;
  const auto result = rcp(new MultiVector(mesh.owned_nodes, stress_names(d_.dim()).size()));
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const EvaluatePatches<dim, nodes> evaluate{polynomials(elastic_cells<dim, nodes>(d_, materials_), *polynomials_),
                                               d_.around.row, d_.around.cell, LinearShapes<dim, nodes>(mesh.element),
                                               result->getLocalViewDevice(Tpetra::Access::ReadWrite)};
    Kokkos::parallel_for("rpc::fem::evaluate_patches", device_range(mesh.num_owned_nodes()), evaluate);
    Kokkos::fence();
  });
  return result;
}

DeviceView<double *> RecoveredStress::squared_difference() const
{
  const mesh::Mesh &mesh = *d_.mesh;
  const DeviceView<double *> energy("rpc::fem::squared_difference", mesh.num_owned_cells);
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const RecoveryDifference<dim, nodes> difference{
        polynomials(elastic_cells<dim, nodes>(d_, materials_, d_.reference.cell_load), *polynomials_),
        LinearShapes<dim, nodes>(mesh.element), device_read(*u_), energy};
    Kokkos::parallel_for("rpc::fem::recovery_difference", device_range(mesh.num_owned_cells), difference);
    Kokkos::fence();
  });
  return energy;
}

DeviceView<double ***> RecoveredStress::tractions(const mesh::Side &side) const
{
  const BasisTable &table = d_.reference.facet;
  const LO facets = static_cast<LO>(side.facets.extent(0));
  const DeviceView<double ***> traction("rpc::fem::recovered_traction", facets, table.num_points(), d_.dim());
  with_static_extents(d_.mesh->element, [&](const auto dim, const auto nodes) {
    const RecoveredTraction<dim, nodes> recovered{polynomials(elastic_cells<dim, nodes>(d_, materials_), *polynomials_),
                                                  LinearShapes<dim, nodes>(d_.mesh->element),
                                                  side.facets,
                                                  side.cell,
                                                  table.value,
                                                  table.gradient,
                                                  traction};
    Kokkos::parallel_for("rpc::fem::recovered_traction", device_range(facets), recovered);
    Kokkos::fence();
  });
  return traction;
}

} // namespace rpc::fem
