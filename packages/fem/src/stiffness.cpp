#include "fill_entries.hpp"
#include "rpc/core/error.hpp"
#include "stiffness_rows.hpp"

#include <optional>
#include <sstream>

namespace rpc::fem
{
namespace
{

using MatrixValues = CrsMatrix::local_matrix_device_type::values_type::non_const_type; // in Tpetra's memory

/// Names the first owned cell whose Jacobian determinant is not positive at a quadrature point; nothing if there is none
/// on this rank.
template <int Dim, int Nodes>
struct FirstBadCell {
  DeviceView<double **> coords;    // (overlap nodes, Dim)   [m]      in
  DeviceView<LO **> cells;         // (cells, Nodes)                  in
  DeviceView<double ***> gradient; // (points, Nodes, Dim)            in

  KOKKOS_FUNCTION void operator()(const LO cell, LO &first) const
  {
    const CellCoords<Dim, Nodes> x(coords, cells, cell);
    double dN[Nodes][Dim];
    for (int q = 0; q < static_cast<int>(gradient.extent(0)); ++q)
      if (!(physical_gradients(x, gradient, q, dN) > 0) && cell < first) first = cell;
  }
};

std::optional<std::string> describe_bad_cell(const Discretization &d)
{
  const mesh::Mesh &mesh = *d.mesh;
  LO first = 0;
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const FirstBadCell<dim, nodes> kernel{mesh.coords, mesh.cells, d.reference.cell.gradient};
    Kokkos::parallel_reduce("rpc::fem::first_bad_cell", device_range(mesh.num_owned_cells), kernel,
                            Kokkos::Min<LO>(first));
  });
  if (first >= mesh.num_owned_cells) return std::nullopt;
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  const auto block = to_host(mesh.block);
  std::ostringstream message;
  message << "mesh: cell " << mesh.cell_id(first) + 1 << " of block \"" << mesh.blocks[block(first)]
          << "\" is degenerate or inverted (Jacobian determinant <= 0), with vertices at";
  for (int a = 0; a < mesh.element.num_vertices(); ++a)
    for (int c = 0; c < mesh.dim(); ++c)
      message << (c == 0 ? " (" : ", ") << coords(cells(first, a), c) << (c + 1 == mesh.dim() ? ")" : "");
  return message.str();
}

/// The matrix's values where cells are alike: few cells are integrated, and each entry is written once.
/// @param[out] bad  number of kinds with a Jacobian <= 0
template <int Dim, int Nodes>
MatrixValues gather_stiffness(const Discretization &d, const CellStiffness<Dim, Nodes> &stiffness,
                              const std::size_t num_entries, LO &bad)
{
  constexpr int dofs = Dim * Nodes;
  const mesh::Mesh &mesh = *d.mesh;
  const int num_blocks = static_cast<int>(mesh.blocks.size()), num_matrices = d.congruent.size() * num_blocks;
  const DeviceView<double *[dofs][dofs]> matrix("rpc::fem::kind_stiffness", num_matrices);
  bad = tabulate_stiffness(stiffness, Examples{d.congruent.example, num_blocks}, num_matrices, matrix);
  Kokkos::parallel_for("rpc::fem::balance_stiffness", device_range(num_matrices), BalanceStiffness<Dim, Nodes>{matrix});
  const MatrixValues values(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::stiffness"), num_entries);
  const LO num_owned = mesh.num_owned_nodes(), example = mesh.num_cells() / 2;
  const NodeStiffness<Dim, Nodes> rows{
      mesh.cells, mesh.block, d.congruent.of_cell, matrix, num_blocks, num_owned, d.node_to_cells, d.nodes, values};
  Kokkos::parallel_for("rpc::fem::gather_examples", device_range(Nodes), GatherExamples<Dim, Nodes>{rows, example});
  if constexpr (on_gpu) {
    const DeviceView<LO *> source(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::source_of_rows"), num_owned);
    Kokkos::parallel_for("rpc::fem::gather_stiffness", device_range(num_owned),
                         GatherOrFindSource<Dim, Nodes>{rows, example, source});
    fill_entries<Dim>("rpc::fem::copy_stiffness", d.nodes, CopiedRows<Dim>{d.nodes, source, values}, values);
  } else {
    Kokkos::parallel_for("rpc::fem::gather_stiffness", device_range(num_owned),
                         GatherStiffness<Dim, Nodes>{rows, example});
  }
  return values;
}

/// The matrix's values where each cell is integrated by itself.
/// @param[out] bad  number of cells with a Jacobian <= 0
template <int Dim, int Nodes, bool Axisymmetric>
MatrixValues add_stiffness(const Discretization &d, const CellStiffness<Dim, Nodes, Axisymmetric> &stiffness,
                           const std::size_t num_entries, LO &bad)
{
  const MatrixValues values("rpc::fem::stiffness", num_entries);
  const LO num_cells = d.mesh->num_cells(), num_owned = d.mesh->num_owned_nodes();
  if constexpr (one_thread) {
    const AddStiffness<Dim, Nodes, Axisymmetric> add{stiffness, d.nodes, num_owned, values};
    Kokkos::parallel_reduce("rpc::fem::add_stiffness", device_range(num_cells), add, bad);
  } else {
    constexpr LO at_a_time = (1 << 28) / static_cast<LO>(sizeof(double[Dim * Nodes][Dim * Nodes])); // cells in 256 MB
    bad = add_tabulated_stiffness(d, stiffness, at_a_time, values);
  }
  return values;
}

template <int Dim, int Nodes, bool Axisymmetric>
MatrixValues stiffness_values(const Discretization &d, const ElasticCells<Dim, Nodes, Axisymmetric> &body,
                              const std::size_t num_entries, LO &bad)
{
  const CellStiffness<Dim, Nodes, Axisymmetric> stiffness{body};
  if constexpr (!Axisymmetric)
    if (d.congruent.size() > 0) return gather_stiffness(d, stiffness, num_entries, bad);
  return add_stiffness(d, stiffness, num_entries, bad);
}

} // namespace

RCP<CrsMatrix> assemble_stiffness(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  const std::size_t num_entries = d.graph->getLocalGraphDevice().entries.extent(0);
  MatrixValues values;
  LO bad = 0;
  with_elastic_cells(d, materials, [&](const auto &body) { values = stiffness_values(d, body, num_entries, bad); });
  Kokkos::fence();
  if (sum_all(mesh.comm(), GO(bad)) > 0) throw_if_any(mesh.comm(), ExitCode::bad_mesh, describe_bad_cell(d));
  const auto matrix = rcp(new CrsMatrix(d.graph, values));
  matrix->fillComplete(d.owned_dofs, d.owned_dofs);
  return matrix;
}

} // namespace rpc::fem
