// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/soft_dilatation.hpp"

#include "elastic_cells.hpp"

#include <utility>

namespace rpc::fem
{
namespace
{

using LocalMatrix = CrsMatrix::local_matrix_device_type;

/// The rows of Z of one cell, each with an entry for every unknown of the cell, columns ascending.
template <int Dim, int Nodes, bool Axisymmetric>
struct FillModes {
  static constexpr int modes = Projection<Dim, Nodes>::modes, dofs = Dim * Nodes;
  static constexpr int vertices = StaticElement<Dim, Nodes>::vertices;

  using Begins = LocalMatrix::row_map_type::non_const_type;
  using Columns = LocalMatrix::index_type::non_const_type;
  using Values = LocalMatrix::values_type::non_const_type;

  ElasticCells<Dim, Nodes, Axisymmetric> body; // of the whole stiffness                        in
  DeviceView<double **> soft;                  // (blocks; lambda, mu) of K_0            [Pa]   in
  DeviceView<char *> prescribed;               // (overlap dofs)                                in
  Begins begin;                                // (modes * cells + 1)                           out
  Columns column;                              // (modes * cells * dofs)                        out
  Values value;                                // (modes * cells * dofs)  [m^(dim/2 - 1)]       out
  Begins node_begin;                           // (cells + 1), empty: none is wanted            out
  Columns node_column;                         // (cells * vertices)                            out
  Values root_of_volume;                       // (cells * vertices)      [m^(dim/2)]           out
  DeviceView<double *> stiffness;              // (modes * cells)                        [Pa]   out
  DeviceView<double *> wave_modulus;           // (modes * cells)                        [Pa]   out
  DeviceView<double *> bulk_modulus;           // (modes * cells)                        [Pa]   out

  KOKKOS_FUNCTION void operator()(const LO cell) const
  {
    Projection<Dim, Nodes> projection;
    const double added = body.lambda(cell) - soft(body.block(cell), 0);
    const bool is_split = added > 0 && body.project(cell, projection);
    int order[Nodes]; // of the nodes, by their number
    for (int a = 0; a < Nodes; ++a) {
      int at = a;
      for (; at > 0 && body.cells(cell, order[at - 1]) > body.cells(cell, a); --at) order[at] = order[at - 1];
      order[at] = a;
    }
    for (int m = 0; m < modes; ++m) {
      const LO row = modes * cell + m;
      const std::size_t first = static_cast<std::size_t>(dofs) * row;
      begin(row + 1) = first + dofs;
      stiffness(row) = is_split ? added : 0;
      wave_modulus(row) = soft(body.block(cell), 0) + 2 * soft(body.block(cell), 1);
      bulk_modulus(row) = soft(body.block(cell), 0) + 2 * soft(body.block(cell), 1) / (Axisymmetric ? 3 : Dim);
      for (int n = 0; n < Nodes; ++n)
        for (int i = 0; i < Dim; ++i) {
          const LO unknown = dof(Dim, body.cells(cell, order[n]), i);
          const std::size_t at = first + dof(Dim, n, i);
          column(at) = unknown;
          value(at) = is_split && !prescribed(unknown) ? projection.Z[m][order[n]][i] : 0;
        }
    }
    if (modes > 1 || node_begin.extent(0) == 0) return;
    std::size_t at = static_cast<std::size_t>(vertices) * cell;
    node_begin(cell + 1) = at + vertices;
    for (int n = 0; n < Nodes; ++n) {
      if (order[n] >= vertices) continue;
      node_column(at) = body.cells(cell, order[n]);
      root_of_volume(at++) = is_split ? projection.root[0][0] : 0;
    }
  }
};

template <int Dim, int Nodes, bool Axisymmetric>
StiffDilatation stiff_dilatation_of(const Discretization &d, const ElasticCells<Dim, Nodes, Axisymmetric> &body,
                                    const Materials &soft, const DeviceView<char *> &prescribed, const bool alternating)
{
  using Fill = FillModes<Dim, Nodes, Axisymmetric>;
  const LO num_cells = d.mesh->num_owned_cells, num_modes = Fill::modes * num_cells;
  const std::size_t num_entries = static_cast<std::size_t>(Fill::dofs) * num_modes;
  using Kokkos::ViewAllocateWithoutInitializing;
  const typename Fill::Begins begin("rpc::fem::modes_begin", num_modes + 1);
  const typename Fill::Columns column(ViewAllocateWithoutInitializing("rpc::fem::modes_column"), num_entries);
  const typename Fill::Values value(ViewAllocateWithoutInitializing("rpc::fem::modes"), num_entries);
  const DeviceView<double *> stiffness("rpc::fem::stiffness_of_modes", num_modes);
  const DeviceView<double *> wave_modulus("rpc::fem::wave_modulus", num_modes);
  const DeviceView<double *> bulk_modulus("rpc::fem::bulk_modulus", num_modes);
  const bool has_nodes = alternating && Fill::modes == 1;
  const std::size_t num_at_nodes = has_nodes ? static_cast<std::size_t>(Fill::vertices) * num_cells : 0;
  const typename Fill::Begins node_begin("rpc::fem::cells_begin", has_nodes ? num_cells + 1 : 0);
  const typename Fill::Columns node_column(ViewAllocateWithoutInitializing("rpc::fem::cells_column"), num_at_nodes);
  const typename Fill::Values root(ViewAllocateWithoutInitializing("rpc::fem::roots_of_volumes"), num_at_nodes);
  const Fill fill{body,       lame_table(d, soft), prescribed, begin,     column,       value,
                  node_begin, node_column,         root,       stiffness, wave_modulus, bulk_modulus};
  Kokkos::parallel_for("rpc::fem::fill_modes", device_range(num_cells), fill);
  Kokkos::fence();
  const auto columns = overlap_dofs(d);
  const auto rows =
      rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), num_modes, 0, d.owned_dofs->getComm()));
  const LocalMatrix local("rpc::fem::modes", num_modes, num_local(*columns), num_entries, value, begin, column);
  RCP<const CrsMatrix> at_nodes;
  if (has_nodes) {
    const auto nodes = d.mesh->comm().getSize() == 1 ? d.mesh->owned_nodes : d.mesh->overlap_nodes();
    const LocalMatrix around("rpc::fem::at_nodes", num_cells, num_local(*nodes), num_at_nodes, root, node_begin,
                             node_column);
    at_nodes = rcp(new CrsMatrix(around, rows, nodes, d.mesh->owned_nodes, rows));
  }
  return {rcp(new CrsMatrix(local, rows, columns, d.owned_dofs, rows)),
          at_nodes,
          StaticElement<Dim, Nodes>::order == 2,
          stiffness,
          wave_modulus,
          bulk_modulus};
}

} // namespace

std::optional<Materials> softened(const Discretization &d, const Materials &materials, const double ratio)
{
  const auto projected = to_host(projected_dilatation_table(d, materials));
  Materials soft = materials;
  bool changes = false;
  for (std::size_t b = 0; b < d.mesh->blocks.size(); ++b) {
    const Material &whole = materials.of(d.mesh->blocks[b]);
    if (projected(b) == 0 || !(whole.poissons_ratio > ratio)) continue;
    soft.block[d.mesh->blocks[b]] = {2 * whole.mu() * (1 + ratio), ratio, Dilatation::projected};
    changes = true;
  }
  return changes ? std::make_optional(std::move(soft)) : std::nullopt;
}

StiffDilatation stiff_dilatation(const Discretization &d, const Materials &materials, const Materials &soft,
                                 const DeviceView<char *> &prescribed, const bool alternating)
{
  StiffDilatation result;
  with_elastic_cells(d, materials,
                     [&](const auto &body) { result = stiff_dilatation_of(d, body, soft, prescribed, alternating); });
  return result;
}

} // namespace rpc::fem
