// SPDX-License-Identifier: BSD-3-Clause
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
template <int Dim, int Nodes, bool Axisymmetric>
RCP<const MultiVector> fit(const Discretization &d, const ElasticCells<Dim, Nodes, Axisymmetric> &body,
                           const Vector &u_overlap)
{
  using Table = PatchTable<Dim, Nodes, Axisymmetric>;
  const mesh::Mesh &mesh = *d.mesh;
  const auto nodes = device_range(mesh.num_owned_nodes());
  const NodeToCells &node_to_cells = d.node_to_cells;
  const NodeGraph graph = d.nodes(); // first: lists twice as long are freed then, and the table takes their place
  const auto table = rcp(new MultiVector(overlap_rows(d), Table::columns)); // zero
  {
    using Fit = FitPatch<Dim, Nodes, Axisymmetric>;
    const Fit fit{body,
                  d.reference.recovery.value,
                  device_read(u_overlap),
                  node_to_cells.row,
                  node_to_cells.cell,
                  graph,
                  facet_mates(mesh.element),
                  table->getLocalViewDevice(Tpetra::Access::ReadWrite)};
    Kokkos::parallel_for("rpc::fem::fit_patch", device_range(Fit::num_calls(mesh.num_owned_nodes())), fit);
    Kokkos::fence();
  }
  fill_ghost_rows(d, *table);
  {
    const AdoptPolynomial<Dim, Nodes, Axisymmetric> adopt{mesh.cells,
                                                          node_to_cells.row,
                                                          node_to_cells.cell,
                                                          table->getLocalViewDevice(Tpetra::Access::ReadWrite),
                                                          mesh.element.num_vertices(),
                                                          body.period};
    Kokkos::parallel_for("rpc::fem::adopt_polynomial", nodes, adopt);
    Kokkos::fence();
  }
  fill_ghost_rows(d, *table);
  return table;
}

/// The fitted polynomials at work, with their kernels' types named once.
template <int Dim, int Nodes, bool Axisymmetric>
struct Recovery {
  Polynomials<Dim, Nodes, Axisymmetric> polynomials;

  Recovery(const Discretization &d, const ElasticCells<Dim, Nodes, Axisymmetric> &body, const MultiVector &table)
      : polynomials{body, table.getLocalViewDevice(Tpetra::Access::ReadOnly), d.on_axis}
  {
  }

  void evaluate(const Discretization &d, MultiVector &result) const
  {
    const EvaluatePatches<Dim, Nodes, Axisymmetric> evaluate{polynomials, d.node_to_cells.row, d.node_to_cells.cell,
                                                             VertexFunctions<Dim, Nodes>(),
                                                             result.getLocalViewDevice(Tpetra::Access::ReadWrite)};
    Kokkos::parallel_for("rpc::fem::evaluate_patches", device_range(d.mesh->num_owned_nodes()), evaluate);
    Kokkos::fence();
  }
  void square_difference(const Discretization &d, const Vector &u_overlap, const DeviceView<double *> &energy) const
  {
    const RecoveryDifference<Dim, Nodes, Axisymmetric> difference{polynomials, VertexFunctions<Dim, Nodes>(),
                                                                  device_read(u_overlap), energy};
    Kokkos::parallel_for("rpc::fem::recovery_difference", device_range(d.mesh->num_owned_cells), difference);
    Kokkos::fence();
  }
  void tractions(const Discretization &d, const mesh::Side &side, const DeviceView<double ***> &traction) const
  {
    const BasisTable &table = d.reference.facet;
    const RecoveredTraction<Dim, Nodes, Axisymmetric> recovered{
        polynomials, VertexFunctions<Dim, Nodes>(), side.facets, side.cell, table.value, table.gradient, traction};
    Kokkos::parallel_for("rpc::fem::recovered_traction", device_range(static_cast<LO>(side.facets.extent(0))),
                         recovered);
    Kokkos::fence();
  }
};

/// Means of a cell's own stress.
template <int Dim, int Nodes, bool Axisymmetric>
struct MeanStress {
  using Body = ElasticCells<Dim, Nodes, Axisymmetric>;
  static constexpr int components = Components<Dim>::size;

  Body body;                   //                          in
  ReadVector u;                // (overlap dofs)    [m]    in
  DeviceView<double **> value; // (owned cells; columns) [Pa] out

  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    const double lambda = body.lambda(cell), mu = body.mu(cell);
    double s[components] = {}, size = 0;
    body.at_points(cell, [&](int, const double volume, const typename Body::Gradients &dN,
                             const typename Body::Dilatation &of_dilatation) {
      typename Body::Tensor grad;
      body.displacement_gradient(u, cell, dN, grad);
      const double dilatation = body.divergence(u, cell, of_dilatation);
      for (int m = 0; m < components; ++m) {
        const int i = Components<Dim>::row(m), j = Components<Dim>::col(m);
        if (i >= Dim && body.plane_stress) continue;
        const bool strained = i < Body::columns; // across the plane the strain is 0
        s[m] += volume * ((strained ? mu * (grad[i][j] + grad[j][i]) : 0) + (i == j ? lambda * dilatation : 0));
      }
      size += volume;
    });
    for (int m = 0; m < components; ++m) s[m] /= size;
    const int columns = static_cast<int>(value.extent(1)) - 1; // in plane stress none across the plane
    for (int m = 0; m < columns; ++m) value(cell, m) = s[m];
    value(cell, columns) = EvaluatePatches<Dim, Nodes, Axisymmetric>::von_mises(s);
  }
};

template <int Dim, int Nodes, bool Axisymmetric>
void find_means(const Discretization &d, const ElasticCells<Dim, Nodes, Axisymmetric> &body, const Vector &u_overlap,
                const DeviceView<double **> &value)
{
  const MeanStress<Dim, Nodes, Axisymmetric> mean{body, device_read(u_overlap), value};
  Kokkos::parallel_for("rpc::fem::mean_stresses", device_range(d.mesh->num_owned_cells), mean);
  Kokkos::fence();
}

} // namespace

DeviceView<double **> mean_stresses(const Discretization &d, const Materials &materials, const Vector &u)
{
  const DeviceView<double **> value("rpc::fem::mean_stresses", d.mesh->num_owned_cells, stress_names(d).size());
  const auto u_overlap = on_overlap(d, u);
  with_elastic_cells(d, materials, [&](const auto &body) { find_means(d, body, *u_overlap, value); });
  return value;
}

std::vector<std::string> stress_names(const Discretization &d)
{
  if (d.axisymmetric()) return {"stress_xx", "stress_yy", "stress_xy", "stress_theta", "von_mises"};
  if (d.kinematics == Kinematics::plane_stress) return {"stress_xx", "stress_yy", "stress_xy", "von_mises"};
  if (d.dim() == 2) return {"stress_xx", "stress_yy", "stress_xy", "stress_zz", "von_mises"};
  return {"stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz", "stress_xz", "von_mises"};
}

RecoveredStress::RecoveredStress(Discretization d, Materials materials, const Vector &u)
    : d_(std::move(d)), materials_(std::move(materials)), u_(rcp(new Vector(*on_overlap(d_, u), Teuchos::Copy)))
{
  with_elastic_cells(d_, materials_, [&](const auto &body) { polynomials_ = fit(d_, body, *u_); });
}

RCP<MultiVector> RecoveredStress::at_nodes() const
{
  const auto result = rcp(new MultiVector(d_.mesh->owned_nodes, stress_names(d_).size()));
  with_elastic_cells(d_, materials_,
                     [&](const auto &body) { Recovery(d_, body, *polynomials_).evaluate(d_, *result); });
  return result;
}

DeviceView<double *> RecoveredStress::squared_difference() const
{
  const DeviceView<double *> energy("rpc::fem::squared_difference", d_.mesh->num_owned_cells);
  with_elastic_cells(d_, materials_, d_.reference.cell_load,
                     [&](const auto &body) { Recovery(d_, body, *polynomials_).square_difference(d_, *u_, energy); });
  return energy;
}

DeviceView<double ***> RecoveredStress::tractions(const mesh::Side &side) const
{
  const DeviceView<double ***> traction("rpc::fem::recovered_traction", side.facets.extent(0),
                                        d_.reference.facet.num_points(), d_.dim());
  with_elastic_cells(d_, materials_,
                     [&](const auto &body) { Recovery(d_, body, *polynomials_).tractions(d_, side, traction); });
  return traction;
}

} // namespace rpc::fem
