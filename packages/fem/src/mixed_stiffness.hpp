// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "congruent_cells.hpp"
#include "rpc/core/error.hpp"
#include "rpc/mesh/box.hpp"
#include "stiffness_rows.hpp"

/// The stiffness of a box of mixed elements: that of Q2 on the same cells, for displacements that are linear along some directions.
namespace rpc::fem
{

/// The same cells with order 2 in all directions: without unknowns, for the stiffness of cells. Collective.
inline Discretization with_order_two(const Discretization &d)
{
  RPC_REQUIRE_CODE(d.mesh->box, ExitCode::internal_error, "fem: only boxes have mixed elements");
  mesh::BoxOptions box = *d.mesh->box;
  box.element.linear = {};
  Discretization whole;
  whole.mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, d.mesh->owned_nodes->getComm()));
  whole.kinematics = d.kinematics;
  whole.on_axis = d.on_axis;
  whole.reference = tabulate(whole.mesh->element, d.kinematics);
  if (!d.axisymmetric()) whole.congruent = congruent_cells(*whole.mesh);
  return whole;
}

/// (Q2's nodes, mixed nodes) What Q2's nodes take of the mixed element's.
template <int Dim, int Nodes>
DeviceView<double **> weights_of_mixed(const mesh::Element &mixed)
{
  const mesh::MixedShapeFunctions<Dim> shape(mixed);
  const ShapeFunctions<Dim, Nodes> whole;
  const DeviceView<double **> weights("rpc::fem::weights_of_mixed", Nodes, shape.nodes);
  const auto weight = Kokkos::create_mirror_view(weights);
  for (int a = 0; a < Nodes; ++a) {
    double X[Dim], N[mesh::MixedShapeFunctions<Dim>::most];
    whole.node(a, X);
    shape.evaluate(X, N);
    for (int b = 0; b < shape.nodes; ++b) weight(a, b) = N[b];
  }
  Kokkos::deep_copy(weights, weight);
  return weights;
}

/// k = P^T K P for the stiffness K of some cells of Q2, an entry a thread.
template <int Dim, int Nodes>
struct RestrictStiffness {
  static constexpr int dofs = Dim * Nodes;

  DeviceView<double *[dofs][dofs]> matrix; // (tabulated cells, dofs, dofs)                    [N/m]  in
  DeviceView<double **> weight;            // (Nodes, mixed nodes) P                                  in
  DeviceView<double ***> restricted;       // (tabulated cells, mixed dofs, mixed dofs)         [N/m]  out

  KOKKOS_FUNCTION void operator()(const LO item) const
  {
    const int n = static_cast<int>(weight.extent(1)), pair = item % (n * n), a = pair / n, b = pair % n;
    const LO m = item / (n * n);
    double sum[Dim][Dim] = {};
    for (int p = 0; p < Nodes; ++p) {
      if (weight(p, a) == 0) continue;
      for (int q = 0; q < Nodes; ++q) {
        const double factor = weight(p, a) * weight(q, b);
        if (factor == 0) continue;
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) sum[i][j] += factor * matrix(m, dof(Dim, p, i), dof(Dim, q, j));
      }
    }
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) restricted(m, dof(Dim, a, i), dof(Dim, b, j)) = sum[i][j];
  }
};

/// The rows of a node += those of the tabulated cells around it.
template <int Dim>
struct AddRestricted {
  DeviceView<LO **> cells;           // (cells, mixed nodes)                             in, overlap lids
  DeviceView<int *> block;           // (cells)                                          in
  DeviceView<signed char *> kind;    // (cells); empty: each cell has its matrix         in
  int num_blocks;                    //
  LO first, last;                    // cells that are added, without the last
  DeviceView<double ***> restricted; // (kinds * blocks or cells from `first` on, mixed dofs, mixed dofs)  [N/m]  in
  NodeToCells node_to_cells;         //                                                  in
  NodeGraph nodes;                   //                                                  in
  MatrixValues values;               // (matrix entries)                          [N/m]  inout

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const std::size_t begin = nodes.row(node);
    const LO length = static_cast<LO>(nodes.row(node + 1) - begin);
    const int n = static_cast<int>(cells.extent(1));
    double *const rows = &values(Dim * Dim * begin);
    for (std::size_t k = node_to_cells.row(node); k < node_to_cells.row(node + 1); ++k) {
      const LO cell = node_to_cells.cell(k);
      if (cell < first || cell >= last) continue;
      const LO m = kind.extent(0) > 0 ? kind(cell) * num_blocks + block(cell) : cell - first;
      add_cell_to_rows<Dim>(cells, cell, place_in(cells, cell, node), n, restricted, m, nodes.col, begin, length, rows);
    }
  }
};

/// The values of the matrix of a mesh of mixed elements.
/// @param whole  with_order_two() of the same mesh   @param body  its cells
/// @param[out] bad  number of cells, or kinds, with a Jacobian <= 0
template <int Dim, int Nodes, bool Axisymmetric>
MatrixValues mixed_stiffness(const Discretization &d, const Discretization &whole,
                             const ElasticCells<Dim, Nodes, Axisymmetric> &body, const std::size_t num_entries, LO &bad)
{
  constexpr int dofs = Dim * Nodes;
  const CellStiffness<Dim, Nodes, Axisymmetric> stiffness{body}, of_kinds{kinds_of(whole.congruent, body)};
  const auto weight = weights_of_mixed<Dim, Nodes>(d.mesh->element);
  const LO num_nodes = static_cast<LO>(weight.extent(1)), num_cells = d.mesh->num_cells();
  const int num_blocks = static_cast<int>(d.mesh->blocks.size());
  const bool alike = whole.congruent.size() > 0;
  constexpr LO at_once = (1 << 28) / static_cast<LO>(sizeof(double[dofs][dofs])); // cells in 256 MB
  const LO step = alike ? num_cells : at_once;
  const MatrixValues values("rpc::fem::mixed_stiffness", num_entries);
  bad = 0;
  for (LO first = 0; first < num_cells; first += step) {
    const LO last = step < num_cells - first ? first + step : num_cells;
    const LO count = alike ? whole.congruent.size() * num_blocks : last - first;
    const DeviceView<double *[dofs][dofs]> matrix("rpc::fem::cell_stiffness", count);
    bad += alike ? tabulate_stiffness(of_kinds, InEachBlock{num_blocks}, count, matrix)
                 : tabulate_stiffness(stiffness, CellsFrom{first, d.mesh->block}, count, matrix);
    const DeviceView<double ***> restricted("rpc::fem::restricted_stiffness", count, num_dofs(Dim, num_nodes),
                                            num_dofs(Dim, num_nodes));
    Kokkos::parallel_for("rpc::fem::restrict_stiffness", device_range(count * num_nodes * num_nodes),
                         RestrictStiffness<Dim, Nodes>{matrix, weight, restricted});
    const AddRestricted<Dim> add{
        d.mesh->cells, d.mesh->block,   alike ? whole.congruent.of_cell : DeviceView<signed char *>(),
        num_blocks,    first,           last,
        restricted,    d.node_to_cells, d.nodes(),
        values};
    Kokkos::parallel_for("rpc::fem::add_restricted", device_range(d.mesh->num_owned_nodes()), add);
    Kokkos::fence();
  }
  return values;
}

} // namespace rpc::fem
