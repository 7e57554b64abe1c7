// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "interpolation_rows.hpp"
#include "offsets.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/mesh/box_grid.hpp"
#include "rpc/mesh/box_parts.hpp"

#include <algorithm>
#include <utility>
#include <vector>

/// Interpolation between two divisions of one box: a node's indices tell its cell, and any rank knows the cell's nodes. No search, and
/// no questions to other ranks. Private to interpolation().
namespace rpc::fem
{

/// One direction of a box, in lengths of its cells (but for the last one they are equal).
struct BoxAxis {
  GO cells = 1;
  double order = 1, last = 1; // length of the last cell

  KOKKOS_INLINE_FUNCTION double length() const { return static_cast<double>(cells - 1) + last; }
  /// Where a node of the lattice lies.
  KOKKOS_INLINE_FUNCTION double at(const GO node) const
  {
    const double along = static_cast<double>(node) / order, first = static_cast<double>(cells - 1);
    return along > first ? first + last * (along - first) : along;
  }
  /// The cell that holds a place, and how far in it that is, from 0 to 1.
  KOKKOS_INLINE_FUNCTION GO cell_at(const double place, double &within) const
  {
    const GO below = static_cast<GO>(place);
    const GO cell = below < cells - 1 ? below : cells - 1;
    within = (place - static_cast<double>(cell)) / (cell == cells - 1 ? last : 1);
    return cell;
  }
};

/// Where the nodes of one division of a box lie in the cells of another, along a direction in which one of them is graded.
struct GradedAxis {
  DeviceView<GO *> cell;       // (nodes) the lower one of two that share a place but for the first
  DeviceView<double *> within; // (nodes) from 0 to 1

  bool empty() const { return cell.extent(0) == 0; }
  static GradedAxis of(const mesh::BoxOptions &from, const mesh::BoxOptions &to, const int direction)
  {
    const auto cells = mesh::cell_ends(from, direction), nodes = mesh::cell_ends(to, direction);
    const int order = to.element.order_along(direction);
    const auto last = static_cast<GO>(cells.size()) - 2;
    std::vector<GO> cell;
    std::vector<double> within;
    for (GO node = 0; node <= to.intervals(direction); ++node) {
      const auto begin = static_cast<std::size_t>(node / order);
      const double part = static_cast<double>(node % order) / order;
      const double x = part > 0 ? (1 - part) * nodes[begin] + part * nodes[begin + 1] : nodes[begin];
      const GO above = std::upper_bound(cells.begin(), cells.end(), x) - cells.begin();
      cell.push_back(std::clamp<GO>(above - 1, 0, last));
      const double at = cells[cell.back()], length = cells[cell.back() + 1] - at;
      within.push_back(std::clamp((x - at) / length, 0., 1.));
    }
    return {device_values(cell, "rpc::fem::graded_cell"), device_values(within, "rpc::fem::within_graded_cell")};
  }
};

/// A node of one box in the cells of another division of it.
template <int Dim>
struct BetweenBoxes {
  BoxAxis from[3], to[3];
  GradedAxis graded[3]; // empty where neither is graded
  double ratio[3];      // of the lengths in `from`'s unit over those in `to`'s: exact powers of 2 for halved boxes

  BetweenBoxes(const mesh::BoxOptions &from_box, const mesh::BoxOptions &to_box)
  {
    for (int d = 0; d < Dim; ++d) {
      from[d] = {from_box.cells[d], double(from_box.element.order_along(d)), from_box.last_in(d)};
      to[d] = {to_box.cells[d], double(to_box.element.order_along(d)), to_box.last_in(d)};
      ratio[d] = from[d].length() / to[d].length();
      if (from_box.graded(d) || to_box.graded(d)) graded[d] = GradedAxis::of(from_box, to_box, d);
    }
  }
  /// @param[out] within  place in the cell, from 0 to 1
  KOKKOS_INLINE_FUNCTION mesh::Index cell_of(const mesh::Index &node, double (&within)[Dim]) const
  {
    mesh::Index cell{};
    for (int d = 0; d < Dim; ++d) {
      if (graded[d].cell.extent(0) > 0) {
        cell[d] = graded[d].cell(node[d]);
        within[d] = graded[d].within(node[d]);
      } else {
        cell[d] = from[d].cell_at(to[d].at(node[d]) * ratio[d], within[d]);
      }
    }
    return cell;
  }
  /// The cells that hold the nodes from first to last, on the host.
  std::pair<GO, GO> cells_along(const int d, const GO first, const GO last) const
  {
    double within = 0;
    if (graded[d].empty())
      return {from[d].cell_at(to[d].at(first) * ratio[d], within), from[d].cell_at(to[d].at(last) * ratio[d], within)};
    const auto cell = to_host(graded[d].cell);
    return {cell(first), cell(last)};
  }
};

/// The elements in one cell of a box' lattice.
template <int Dim, int Nodes>
struct ElementsOfCell {
  static constexpr int nodes = Nodes;
  static constexpr bool simplex = ShapeFunctions<Dim, Nodes>::simplex;
  static constexpr int count = !simplex ? 1 : Dim == 2 ? 2 : 6;
  ShapeFunctions<Dim, Nodes> shape;
  GO place[count][Nodes][Dim];          // of their nodes, on the lattice {0..order}^dim
  double first[count][Dim];             // of a simplex: its first vertex, from 0 to 1
  double to_reference[count][Dim][Dim]; // and the inverse of its edges from there

  ElementsOfCell()
  {
    const mesh::BoxParts parts = mesh::box_parts(StaticElement<Dim, Nodes>::element());
    RPC_REQUIRE(static_cast<int>(parts.size()) == count, "fem: a cell of a box is not " << parts.size() << " elements");
    for (int part = 0; part < count; ++part) {
      for (int a = 0; a < Nodes; ++a)
        for (int d = 0; d < Dim; ++d) place[part][a][d] = parts[part][a][d];
      double edges[Dim][Dim];
      for (int i = 0; i < Dim; ++i) {
        const double order = ShapeFunctions<Dim, Nodes>::order;
        first[part][i] = static_cast<double>(place[part][0][i]) / order;
        for (int d = 0; d < Dim; ++d)
          edges[i][d] = simplex ? static_cast<double>(place[part][d + 1][i]) / order - first[part][i] : i == d;
      }
      invert<Dim>(edges, to_reference[part]);
    }
  }
  /// The element that holds a place of the cell.
  /// @param within  from 0 to 1   @param[out] X  reference coordinates in it
  KOKKOS_INLINE_FUNCTION int element_at(const double (&within)[Dim], double (&X)[Dim]) const
  {
    if constexpr (!simplex) {
      for (int d = 0; d < Dim; ++d) X[d] = 2 * within[d] - 1;
      return 0;
    }
    int best = 0;
    double deepest = -math::infinity<double>; // the least barycentric coordinate
    for (int part = 0; part < count; ++part) {
      double at[Dim], depth = 1;
      for (int d = 0; d < Dim; ++d) {
        at[d] = 0;
        for (int i = 0; i < Dim; ++i) at[d] += to_reference[part][d][i] * (within[i] - first[part][i]);
        depth -= at[d];
      }
      for (int d = 0; d < Dim; ++d)
        if (at[d] < depth) depth = at[d];
      if (depth <= deepest) continue;
      deepest = depth;
      best = part;
      for (int d = 0; d < Dim; ++d) X[d] = at[d];
    }
    return best;
  }
  /// The weights of its nodes there.
  KOKKOS_INLINE_FUNCTION int weights_at(const double (&within)[Dim], double (&weight)[Nodes]) const
  {
    double X[Dim] = {};
    const int part = element_at(within, X);
    fem::weights_at(shape, X, weight);
    return part;
  }
};

/// The one mixed element in a cell of a box' lattice.
template <int Dim>
struct MixedElementOfCell {
  static constexpr int nodes = mesh::MixedShapeFunctions<Dim>::most;
  mesh::MixedShapeFunctions<Dim> shape;
  GO place[1][nodes][Dim] = {};

  explicit MixedElementOfCell(const mesh::Element &element) : shape(element)
  {
    for (int a = 0; a < shape.nodes; ++a)
      for (int d = 0; d < Dim; ++d) place[0][a][d] = shape.place[a][d];
  }
  KOKKOS_INLINE_FUNCTION int weights_at(const double (&within)[Dim], double (&weight)[nodes]) const
  {
    double X[Dim];
    for (int d = 0; d < Dim; ++d) X[d] = 2 * within[d] - 1;
    shape.evaluate(X, weight);
    for (double &N : weight)
      if (!counts(N)) N = 0;
    return 0;
  }
};

/// Makes the rows of this rank's nodes of one box from the nodes of another division of it.
/// @tparam Elements  ElementsOfCell or MixedElementOfCell
template <int Dim, class Elements>
struct RowsInBox {
  static constexpr int Nodes = Elements::nodes;
  Elements elements;
  BetweenBoxes<Dim> boxes;
  mesh::Block rows;            // this rank's nodes
  mesh::Grid grid;             // of the box that is interpolated from
  mesh::Block own, around;     // its nodes: of this rank, and those among which all columns are
  DeviceView<LO *> other = {}; // (around) columns of nodes of other ranks

  /// Calls each(a, node) for the nodes with a weight.
  template <class Each>
  KOKKOS_INLINE_FUNCTION void visit(const LO row, double (&weight)[Nodes], const Each &each) const
  {
    double within[Dim];
    const mesh::Index cell = boxes.cell_of(rows.at(row), within);
    const int part = elements.weights_at(within, weight);
    for (int a = 0; a < Nodes; ++a) {
      if (weight[a] == 0) continue;
      mesh::Index node{};
      for (int d = 0; d < Dim; ++d) node[d] = grid.order(d) * cell[d] + elements.place[part][a][d];
      each(a, grid.node_of(node));
    }
  }
  KOKKOS_INLINE_FUNCTION void operator()(const LO row, InterpolationRow<Nodes> &result) const
  {
    visit(row, result.weight, [&](const int a, const mesh::Index &node) {
      result.column[a] = own.contains(node) ? static_cast<LO>(own.index_of(node)) : other(around.index_of(node));
    });
  }
};

/// Columns of nodes that other ranks own, where this rank's rows have them; collective.
/// @param[in,out] rows  `other` is filled
/// @return the nodes' gids, ascending
template <int Dim, class Elements>
std::vector<GO> find_others(RowsInBox<Dim, Elements> &rows, const LO num_rows)
{
  const LO size = static_cast<LO>(rows.around.size());
  const DeviceView<LO *> used("rpc::fem::used_by_rows", size);
  {
    const RowsInBox<Dim, Elements> r = rows;
    Kokkos::parallel_for(
        "rpc::fem::mark_used_by_rows", device_range(num_rows), KOKKOS_LAMBDA(const LO row) {
          double weight[Elements::nodes];
          r.visit(row, weight, [&](const int, const mesh::Index &node) {
            if (!r.own.contains(node)) Kokkos::atomic_exchange(&used(r.around.index_of(node)), LO(1));
          });
        });
  }
  const auto offset = offsets_of(used, "rpc::fem::others_before");
  const LO count = static_cast<LO>(last_of(offset));
  const DeviceView<GO *> gid("rpc::fem::gids_of_others", count);
  const DeviceView<LO *> position("rpc::fem::positions_of_others", count);
  const mesh::Grid grid = rows.grid;
  const mesh::Block around = rows.around;
  Kokkos::parallel_for(
      "rpc::fem::list_others", device_range(size), KOKKOS_LAMBDA(const LO at) {
        if (used(at) == 0) return;
        gid(offset(at)) = grid.node_gid(around.at(at));
        position(offset(at)) = at;
      });
  const auto host_gid = to_host(gid);
  const auto host_position = to_host(position);
  std::vector<std::pair<GO, LO>> sorted;
  for (LO k = 0; k < count; ++k) sorted.emplace_back(host_gid(k), host_position(k));
  if (!std::is_sorted(sorted.begin(), sorted.end())) std::sort(sorted.begin(), sorted.end());
  std::vector<GO> gids;
  const auto sorted_position = Kokkos::create_mirror_view(position);
  for (LO k = 0; k < count; ++k) {
    gids.push_back(sorted[k].first);
    sorted_position(k) = sorted[k].second;
  }
  Kokkos::deep_copy(position, sorted_position);
  const LO num_own = static_cast<LO>(rows.own.size());
  Kokkos::parallel_for(
      "rpc::fem::columns_of_others", device_range(count),
      KOKKOS_LAMBDA(const LO k) { used(position(k)) = num_own + k; });
  Kokkos::fence();
  rows.other = used;
  return gids;
}

/// Whether both are divisions of one box.
inline bool divide_one_box(const mesh::Mesh &from, const mesh::Mesh &to)
{
  return from.box && to.box && from.box->lower == to.box->lower && from.box->upper == to.box->upper &&
         from.box->periodic == to.box->periodic && from.box->unrolled == to.box->unrolled;
}

/// @return the rows, and the matrix' columns; collective
template <int Dim, class Elements>
std::pair<RowsInBox<Dim, Elements>, RCP<const Map>> rows_in_box(const Elements &elements, const mesh::Mesh &from,
                                                                const mesh::Mesh &to)
{
  const int ranks = from.comm().getSize(), rank = from.comm().getRank();
  const mesh::Grid grid(*from.box, ranks);
  RowsInBox<Dim, Elements> rows{elements, {*from.box, *to.box},   mesh::Grid(*to.box, ranks).owned_nodes(rank),
                                grid,     grid.owned_nodes(rank), {}};
  RPC_REQUIRE(rows.own.size() == from.num_owned_nodes() && rows.rows.size() == to.num_owned_nodes(),
              "fem: the nodes of a box are not numbered as the box is");
  if (ranks == 1) return {rows, from.owned_nodes};

  mesh::Block cells = grid.cells();
  if (rows.rows.size() == 0) cells.end = {};
  for (int d = 0; d < Dim && cells.size() > 0; ++d) { // one more at both ends, whatever the rounding
    const auto [first, last] = rows.boxes.cells_along(d, rows.rows.begin[d], rows.rows.end[d] - 1);
    cells.begin[d] = std::max<GO>(0, first - 1);
    cells.end[d] = std::min<GO>(rows.boxes.from[d].cells, last + 2);
  }
  rows.around = grid.nodes_of(cells);
  const std::vector<GO> others = find_others(rows, to.num_owned_nodes());
  return {rows, columns_of(from, others)};
}

} // namespace rpc::fem
