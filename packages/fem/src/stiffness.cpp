// SPDX-License-Identifier: BSD-3-Clause
#include "fill_entries.hpp"
#include "mixed_stiffness.hpp"
#include "offsets.hpp"
#include "prescribed_couplings.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/mesh/box_grid.hpp"
#include "stiffness_rows.hpp"

#include <optional>
#include <sstream>
#include <utility>

namespace rpc::fem
{
namespace
{

/// Names the first owned cell whose Jacobian determinant is not positive at a quadrature point; nothing if there is none
/// on this rank.
template <int Dim, int Nodes>
struct FirstBadCell {
  DeviceView<double **> coords;    // (places, Dim)          [m]      in
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
    const FirstBadCell<dim, nodes> kernel{mesh.coords, mesh.places(), d.reference.cell.gradient};
    Kokkos::parallel_reduce("rpc::fem::first_bad_cell", device_range(mesh.num_owned_cells), kernel,
                            Kokkos::Min<LO>(first));
  });
  if (first >= mesh.num_owned_cells) return std::nullopt;
  const auto coords = to_host(mesh.coords);
  const auto places = to_host(mesh.places());
  const auto block = to_host(mesh.block);
  std::ostringstream message;
  message << "mesh: cell " << mesh.cell_id(first) + 1 << " of block \"" << mesh.blocks[block(first)]
          << "\" is degenerate or inverted (Jacobian determinant <= 0), with vertices at";
  for (int a = 0; a < mesh.element.num_vertices(); ++a)
    for (int c = 0; c < mesh.dim(); ++c)
      message << (c == 0 ? " (" : ", ") << coords(places(first, a), c) << (c + 1 == mesh.dim() ? ")" : "");
  return message.str();
}

/// What the rows are gathered from where cells are alike: few cells are integrated.
/// @param[out] bad  number of kinds with a Jacobian <= 0
template <int Dim, int Nodes>
NodeStiffness<Dim, Nodes> node_stiffness(const Discretization &d, const CellStiffness<Dim, Nodes> &stiffness, LO &bad)
{
  constexpr int dofs = Dim * Nodes;
  const int num_blocks = static_cast<int>(d.mesh->blocks.size()), num_matrices = d.congruent.size() * num_blocks;
  const DeviceView<double *[dofs][dofs]> matrix("rpc::fem::kind_stiffness", num_matrices);
  const CellStiffness<Dim, Nodes> of_kinds{kinds_of(d.congruent, stiffness.body)};
  bad = tabulate_stiffness(of_kinds, InEachBlock{num_blocks}, num_matrices, matrix);
  Kokkos::parallel_for("rpc::fem::balance_stiffness", device_range(num_matrices), BalanceStiffness<Dim, Nodes>{matrix});
  return {d.mesh->cells, d.mesh->block, d.congruent.of_cell, matrix, num_blocks, d.node_to_cells, d.nodes()};
}

/// The matrix's values where cells are alike: each entry is written once.
/// @param[out] bad  number of kinds with a Jacobian <= 0
template <int Dim, int Nodes>
MatrixValues gather_stiffness(const Discretization &d, const CellStiffness<Dim, Nodes> &stiffness,
                              const std::size_t num_entries, LO &bad)
{
  const MatrixValues values(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::stiffness"), num_entries);
  const LO num_owned = d.mesh->num_owned_nodes(), example = d.mesh->num_cells() / 2;
  const MatrixRows<Dim, Nodes> rows{node_stiffness(d, stiffness, bad), num_owned, values};
  Kokkos::parallel_for("rpc::fem::gather_examples", device_range(Nodes), GatherExamples<Dim, Nodes>{rows, example});
  if constexpr (on_gpu) {
    const DeviceView<LO *> source(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::source_of_rows"), num_owned);
    Kokkos::parallel_for("rpc::fem::gather_stiffness", device_range(num_owned),
                         GatherOrFindSource<Dim, Nodes>{rows, example, source});
    const NodeGraph nodes = d.nodes();
    fill_entries<Dim>("rpc::fem::copy_stiffness", nodes, CopiedRows<Dim>{nodes, source, values}, values);
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
    const AddStiffness<Dim, Nodes, Axisymmetric> add{stiffness, d.nodes(), num_owned, values};
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

/// Whether the rows of two nodes are the same, after elimination too, but for a shift of the columns' numbers.
template <int Dim, int Nodes>
struct SameEliminatedRows {
  NodeStiffness<Dim, Nodes> stiffness; //                                                       in
  DeviceView<char *> fixed;            // (overlap dofs)                                        in
  DeviceView<char *> is_beside;        // (owned nodes) a prescribed unknown                    in

  KOKKOS_FUNCTION bool operator()(const LO node, const LO other) const
  {
    if (is_beside(node) != is_beside(other) || !stiffness.same_rows(node, other)) return false;
    if (!is_beside(node)) return true;
    const auto &nodes = stiffness.nodes;
    const std::size_t of_node = nodes.row(node), of_other = nodes.row(other), size = nodes.row(node + 1) - of_node;
    for (std::size_t k = 0; k < size; ++k)
      for (int c = 0; c < Dim; ++c)
        if (fixed(dof(Dim, nodes.col(of_node + k), c)) != fixed(dof(Dim, nodes.col(of_other + k), c))) return false;
    return true;
  }
};

/// (owned nodes) 1 at some of them.
DeviceView<char *> flagged(const DeviceView<LO *> &node, const LO num_nodes)
{
  const DeviceView<char *> flag("rpc::fem::flagged", num_nodes);
  Kokkos::parallel_for(
      "rpc::fem::flag", device_range(static_cast<LO>(node.extent(0))),
      KOKKOS_LAMBDA(const LO i) { flag(node(i)) = 1; });
  Kokkos::fence();
  return flag;
}

/// The kinds' examples, in their order, then the nodes of no kind, ascending.
DeviceView<LO *> nodes_with_rows(const AlikeNodes &kinds)
{
  const LO num_kinds = static_cast<LO>(kinds.example.size());
  const auto kind = kinds.kind;
  const auto num_nodes = static_cast<LO>(kind.extent(0));
  LO of_none = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::count_others", device_range(num_nodes), KOKKOS_LAMBDA(const LO n, LO &sum) { sum += kind(n) < 0; },
      of_none);
  const DeviceView<LO *> node("rpc::fem::nodes_with_rows", num_kinds + of_none);
  Kokkos::deep_copy(Kokkos::subview(node, std::pair<LO, LO>(0, num_kinds)),
                    device_values(kinds.example, "rpc::fem::examples"));
  Kokkos::parallel_scan(
      "rpc::fem::list_others", device_range(num_nodes), KOKKOS_LAMBDA(const LO n, LO &next, const bool last) {
        if (kind(n) >= 0) return;
        if (last) node(num_kinds + next) = n;
        ++next;
      });
  Kokkos::fence();
  return node;
}

/// The rows of one of some nodes.
template <int Dim, int Nodes>
struct GatherRows {
  NodeStiffness<Dim, Nodes> stiffness; //                in
  DeviceView<LO *> node;               // (n)            in
  RowsOfNodes::LocalMatrix rows;       // (n * Dim, columns)  out

  KOKKOS_FUNCTION void operator()(const LO i) const
  {
    const std::size_t first = rows.graph.row_map(dof(Dim, i, 0)), length = rows.graph.row_map(dof(Dim, i, 1)) - first,
                      begin = stiffness.nodes.row(node(i));
    stiffness.gather(node(i), &rows.values(first));
    for (std::size_t e = 0; e < Dim * length; ++e) {
      const std::size_t at = e % length;
      rows.graph.entries(first + e) = dof(Dim, stiffness.nodes.col(begin + at / Dim), static_cast<int>(at % Dim));
    }
  }
};

template <int Dim, int Nodes>
RowsOfNodes rows_of(const NodeStiffness<Dim, Nodes> &stiffness, const DeviceView<LO *> &node, const LO num_columns)
{
  using LocalMatrix = RowsOfNodes::LocalMatrix;
  const LO n = static_cast<LO>(node.extent(0));
  const LocalMatrix::row_map_type::non_const_type row("rpc::fem::listed_row", num_dofs(Dim, n) + 1);
  const DeviceView<LO *> place(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::listed_place"), n);
  const auto nodes = stiffness.nodes;
  Kokkos::parallel_scan(
      "rpc::fem::listed_rows", device_range(n), KOKKOS_LAMBDA(const LO i, std::size_t &sum, const bool last) {
        const std::size_t length = Dim * (nodes.row(node(i) + 1) - nodes.row(node(i)));
        if (last) {
          place(i) = i;
          for (int k = 0; k < Dim; ++k) row(dof(Dim, i, k) + 1) = sum + (k + 1) * length;
        }
        sum += Dim * length;
      });
  const std::size_t num_entries = last_of(row);
  const LocalMatrix::values_type::non_const_type values(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::listed"),
                                                        num_entries);
  const LocalMatrix::index_type::non_const_type columns(
      Kokkos::ViewAllocateWithoutInitializing("rpc::fem::listed_columns"), num_entries);
  const LocalMatrix rows("rpc::fem::listed_rows", num_dofs(Dim, n), num_columns, num_entries, values, row, columns);
  Kokkos::parallel_for("rpc::fem::gather_listed", device_range(n), GatherRows<Dim, Nodes>{stiffness, node, rows});
  Kokkos::fence();
  return {node, place, rows};
}

/// Nodes in the order of their numbers, but from another one on.
struct TurnedOrder {
  LO first = 0, count = 1;
  KOKKOS_INLINE_FUNCTION LO node(const LO place) const
  {
    const LO from_end = count - first;
    return place < from_end ? first + place : place - from_end;
  }
};

template <class Alike>
struct AlikeInOrder {
  Alike alike;
  TurnedOrder order;
  KOKKOS_FUNCTION bool operator()(const LO place, const LO other) const
  {
    return alike(order.node(place), order.node(other));
  }
};

/// In a graded box each layer of nodes is a kind. They are looked for from the middle of this rank's part on: the middle of the numbers may lie at a
/// side, where so many kinds are of few nodes that the search would end.
template <class Alike>
std::optional<AlikeNodes> alike_nodes_in(const mesh::Mesh &mesh, const Alike &alike)
{
  const LO count = mesh.num_owned_nodes();
  if (!mesh.box || count == 0 || !(mesh.box->graded(0) || mesh.box->graded(1) || mesh.box->graded(2)))
    return alike_nodes_of(count, alike);
  const mesh::Block own = mesh::Grid(*mesh.box, mesh.comm().getSize()).owned_nodes(mesh.comm().getRank());
  mesh::Index middle{};
  for (int d = 0; d < 3; ++d) middle[d] = (own.begin[d] + own.end[d]) / 2;
  const LO back = count / 2; // where the search begins
  const TurnedOrder order{(static_cast<LO>(own.index_of(middle)) + count - back) % count, count};
  const auto found = alike_nodes_of(count, AlikeInOrder<Alike>{alike, order});
  if (!found) return found;
  AlikeNodes result{DeviceView<int *>(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::kind_of_node"), count), {}};
  const auto from = found->kind, to = result.kind;
  Kokkos::parallel_for(
      "rpc::fem::turn_kinds", device_range(count),
      KOKKOS_LAMBDA(const LO place) { to(order.node(place)) = from(place); });
  Kokkos::fence();
  for (const LO place : found->example) result.example.push_back(order.node(place));
  return result;
}

template <int Dim, int Nodes>
std::optional<RepeatedStiffness> repeated_rows(const Discretization &d, const CellStiffness<Dim, Nodes> &cells,
                                               const DeviceView<char *> &fixed)
{
  const Comm &comm = d.mesh->comm();
  const auto on_all = [&comm](const bool here) { return min_all(comm, here ? 1 : 0) == 1; };
  LO bad = 0;
  const auto stiffness = node_stiffness(d, cells, bad);
  if (!on_all(bad == 0)) return std::nullopt;
  const LO num_owned = d.mesh->num_owned_nodes(), num_columns = d.num_overlap_dofs();
  const auto beside = nodes_beside_prescribed(d, fixed);
  const auto kinds =
      alike_nodes_in(*d.mesh, SameEliminatedRows<Dim, Nodes>{stiffness, fixed, flagged(beside, num_owned)});
  if (!on_all(kinds.has_value())) return std::nullopt;
  const auto rows = rows_of(stiffness, nodes_with_rows(*kinds), num_columns);
  const double num_rows = static_cast<double>(d.owned_dofs->getGlobalNumElements());
  const double most_in_row = static_cast<double>(rows.rows.nnz()) + 1;
  if (!on_all(squares_are_finite(rows.rows, most_in_row * num_rows))) return std::nullopt;
  const auto couplings = listed_couplings(rows_of(stiffness, beside, num_columns), Dim, fixed);
  clear_couplings(rows, Dim, fixed);
  return RepeatedStiffness{RepeatedRows::of(*kinds, rows, Dim), couplings};
}

template <int Dim, int Nodes, bool Axisymmetric>
std::optional<RepeatedStiffness> repeated_stiffness_of(const Discretization &d,
                                                       const ElasticCells<Dim, Nodes, Axisymmetric> &body,
                                                       const DeviceView<char *> &fixed)
{
  if constexpr (Axisymmetric)
    return std::nullopt;
  else
    return repeated_rows(d, CellStiffness<Dim, Nodes>{body}, fixed);
}

/// @param[out] bad  number of cells with a Jacobian <= 0
MatrixValues stiffness_of_mixed(const Discretization &d, const Materials &materials, const std::size_t num_entries,
                                LO &bad)
{
  const Discretization whole = with_order_two(d);
  MatrixValues values;
  const auto assemble = [&](const auto &body) { values = mixed_stiffness(d, whole, body, num_entries, bad); };
  if (d.dim() == 3)
    assemble(elastic_cells<3, 27>(whole, materials));
  else if (d.axisymmetric())
    assemble(elastic_cells<2, 9, true>(whole, materials));
  else
    assemble(elastic_cells<2, 9>(whole, materials));
  return values;
}

} // namespace

RCP<CrsMatrix> assemble_stiffness(const Discretization &d, const Materials &materials)
{
  const mesh::Mesh &mesh = *d.mesh;
  const auto graph = dof_graph(d);
  const std::size_t num_entries = graph->getLocalGraphDevice().entries.extent(0);
  MatrixValues values;
  LO bad = 0;
  if (mesh.element.mixed())
    values = stiffness_of_mixed(d, materials, num_entries, bad);
  else
    with_elastic_cells(d, materials, [&](const auto &body) { values = stiffness_values(d, body, num_entries, bad); });
  Kokkos::fence();
  if (sum_all(mesh.comm(), GO(bad)) > 0) throw_if_any(mesh.comm(), ExitCode::bad_mesh, describe_bad_cell(d));
  const auto matrix = rcp(new CrsMatrix(graph, values));
  matrix->fillComplete(d.owned_dofs, d.owned_dofs);
  return matrix;
}

std::optional<RepeatedStiffness> repeated_stiffness(const Discretization &d, const Materials &materials,
                                                    const DeviceView<char *> &prescribed)
{
  if (d.mesh->element.mixed())
    return std::nullopt; // the rows come from matrices of order 2 cells, which are made with the whole matrix alone
  const bool has_kinds = d.congruent.size() > 0 || d.mesh->num_cells() == 0; // on this rank
  if (min_all(d.mesh->comm(), has_kinds ? 1 : 0) == 0) return std::nullopt;
  std::optional<RepeatedStiffness> result;
  with_elastic_cells(d, materials, [&](const auto &body) { result = repeated_stiffness_of(d, body, prescribed); });
  return result;
}

} // namespace rpc::fem
