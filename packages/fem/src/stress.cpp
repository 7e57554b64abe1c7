#include "rpc/fem/stress.hpp"

#include "patch_recovery.hpp"

namespace rpc::fem
{
namespace
{

/// (vertices, facets at a vertex, mates): for each facet at a vertex those of its vertices that, with this one, tell it from
/// all other facets around the vertex: an edge's other end, the other two of a triangle, a quadrilateral's far corner.
DeviceView<int ***> facet_mates(const mesh::Element &element)
{
  const int vertices = element.num_vertices(), corners = element.facet().num_vertices();
  const bool triangles = element.facet().shape == mesh::Shape::simplex;
  const DeviceView<int ***> mates("rpc::fem::facet_mates", vertices, element.dim, triangles ? 2 : 1);
  const auto host = Kokkos::create_mirror_view(mates);
  std::vector<int> seen(vertices, 0);
  for (const auto &facet : element.facets())
    for (int i = 0; i < corners; ++i) {
      const int vertex = facet[i], f = seen[vertex]++;
      if (triangles)
        for (int m = 0; m < 2; ++m) host(vertex, f, m) = facet[(i + 1 + m) % corners];
      else
        host(vertex, f, 0) = facet[(i + corners / 2) % corners];
    }
  Kokkos::deep_copy(mates, host);
  return mates;
}

/// The polynomials of all vertices (overlap nodes).
template <int Dim, int Nodes>
RCP<const MultiVector> fit(const Discretization &d, const ElasticCells<Dim, Nodes> &body, const Vector &u_overlap)
{
  using Table = PatchTable<Dim, Nodes>;
  const mesh::Mesh &mesh = *d.mesh;
  const auto nodes = device_range(mesh.num_owned_nodes());
  const NodeToCells &node_to_cells = d.node_to_cells;
  const auto table = rcp(new MultiVector(mesh.owned_nodes, Table::columns)); // zero
  {
    const FitPatch<Dim, Nodes> fit{body,
                                   d.reference.recovery.value,
                                   device_read(u_overlap),
                                   node_to_cells.row,
                                   node_to_cells.cell,
                                   d.nodes,
                                   facet_mates(mesh.element),
                                   table->getLocalViewDevice(Tpetra::Access::ReadWrite)};
    Kokkos::parallel_for("rpc::fem::fit_patch", nodes, fit);
    Kokkos::fence();
  }
  {
    const auto from = nodes_on_overlap(d, table);
    const AdoptPolynomial<Dim, Nodes> adopt{mesh.cells,
                                            node_to_cells.row,
                                            node_to_cells.cell,
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
    const EvaluatePatches<dim, nodes> evaluate{
        polynomials(elastic_cells<dim, nodes>(d_, materials_), *polynomials_), d_.node_to_cells.row,
        d_.node_to_cells.cell, VertexFunctions<dim, nodes>(), result->getLocalViewDevice(Tpetra::Access::ReadWrite)};
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
        VertexFunctions<dim, nodes>(), device_read(*u_), energy};
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
                                                  VertexFunctions<dim, nodes>(),
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
