// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "around_nodes.hpp"
#include "cell_stiffness.hpp"

/// The rows of the stiffness matrix, from the stiffness of cells.
namespace rpc::fem
{

using MatrixValues = CrsMatrix::local_matrix_device_type::values_type::non_const_type; // in Tpetra's memory

/// Place of a node in its row of the node graph, sorted; it is there, for the graph was made of these cells.
KOKKOS_INLINE_FUNCTION LO place_in_row(const DeviceView<LO *> &col, const std::size_t begin, const LO length,
                                       const LO node)
{
  LO low = 0;
  for (LO rest = length; rest > 1;) { // no branch on what is found: searches of a row overlap
    const LO half = rest / 2;
    low += half * (col(begin + low + half) <= node);
    rest -= half;
  }
  return low;
}

/// The rows of a node += those of one cell's stiffness.
/// @param a       the node's place in the cell, which has `num_nodes` nodes
/// @param matrix  (matrices, dofs, dofs), of which the cell has number m  [N/m]
/// @param begin, length  of the node's row of the node graph   @param rows  (Dim, length * Dim)  [N/m]  inout
template <int Dim, class Count, class Matrix>
KOKKOS_INLINE_FUNCTION void add_cell_to_rows(const DeviceView<LO **> &cells, const LO cell, const int a,
                                             const Count num_nodes, const Matrix &matrix, const LO m,
                                             const DeviceView<LO *> &col, const std::size_t begin, const LO length,
                                             double *const rows)
{
  for (int b = 0; b < num_nodes; ++b) {
    const LO at = place_in_row(col, begin, length, cells(cell, b));
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) rows[Dim * (i * length + at) + j] += matrix(m, dof(Dim, a, i), dof(Dim, b, j));
  }
}

/// K += stiffness of one cell, by one thread. Entries are found once per pair of nodes, whose rows share their columns.
template <int Dim, int Nodes, bool Axisymmetric>
struct AddStiffness {
  using Stiffness = CellStiffness<Dim, Nodes, Axisymmetric>;

  Stiffness stiffness;         //                             in
  NodeGraph nodes;             //                             in
  LO num_owned;                // rows of nodes >= this are another rank's
  DeviceView<double *> values; // (matrix entries)     [N/m]  inout

  /// @param bad  counts cells whose Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION void operator()(const LO cell, LO &bad) const
  {
    const auto &cells = stiffness.body.cells;
    for (int pass = 0; pass < Stiffness::passes; ++pass) {
      typename Stiffness::Rows k;
      if (!stiffness(cell, stiffness.body.block(cell), pass, k)) {
        ++bad;
        return;
      }
      for (int a = 0; a < Stiffness::at_once; ++a) {
        const LO node = cells(cell, Stiffness::first_node(pass) + a);
        if (node >= num_owned) continue;
        const std::size_t begin = nodes.row(node);
        const LO length = static_cast<LO>(nodes.row(node + 1) - begin);
        for (int b = 0; b < Nodes; ++b) {
          const LO at = place_in_row(nodes.col, begin, length, cells(cell, b));
          for (int i = 0; i < Dim; ++i) {
            double *const entry = &values(Dim * (Dim * begin + i * length + at));
            for (int j = 0; j < Dim; ++j) entry[j] += k[dof(Dim, a, i)][dof(Dim, b, j)]; // cells share rows
          }
        }
      }
    }
  }
};

/// The rows of one node of K += those of the tabulated cells at it, in their order.
///
/// There is an item for each node of each tabulated cell, so that the work does not depend on the size of the mesh. The first
/// tabulated cell at a node does the node's work.
template <int Dim, int Nodes>
struct AddTabulated {
  static constexpr int dofs = Dim * Nodes;

  DeviceView<LO **> cells;                 // (cells, Nodes)                       in, overlap lids
  LO first, last;                          // tabulated cells, without the last
  LO num_owned;                            // nodes
  DeviceView<double *[dofs][dofs]> matrix; // (tabulated cells, dofs, dofs) [N/m]  in
  NodeToCells node_to_cells;               //                                      in
  NodeGraph nodes;                         //                                      in
  DeviceView<double *> values;             // (matrix entries)              [N/m]  inout

  /// @param item  place of a tabulated cell * Nodes + local node
  KOKKOS_FUNCTION void operator()(const LO item) const
  {
    const LO cell = first + item / Nodes, node = cells(cell, item % Nodes);
    if (node >= num_owned) return;
    std::size_t k = node_to_cells.row(node);
    while (node_to_cells.cell(k) < first) ++k;
    if (node_to_cells.cell(k) != cell) return;
    const std::size_t begin = nodes.row(node);
    const LO length = static_cast<LO>(nodes.row(node + 1) - begin);
    double *const rows = &values(Dim * Dim * begin);
    for (; k < node_to_cells.row(node + 1) && node_to_cells.cell(k) < last; ++k) {
      const LO other = node_to_cells.cell(k);
      add_cell_to_rows<Dim>(cells, other, place_in(cells, other, node), std::integral_constant<int, Nodes>(), matrix,
                            other - first, nodes.col, begin, length, rows);
    }
  }
};

/// K += stiffness of all cells, by many threads: some cells at a time are tabulated, then added node by node, for threads
/// must not share rows. Linear in the number of cells, however many are tabulated at a time.
/// @param at_a_time  cells, > 0
/// @param values  (matrix entries) [N/m], inout
/// @return number of cells whose Jacobian is <= 0 somewhere
template <int Dim, int Nodes, bool Axisymmetric>
LO add_tabulated_stiffness(const Discretization &d, const CellStiffness<Dim, Nodes, Axisymmetric> &stiffness,
                           const LO at_a_time, const DeviceView<double *> &values)
{
  constexpr int dofs = Dim * Nodes;
  const LO num_cells = d.mesh->num_cells(), most = at_a_time < num_cells ? at_a_time : num_cells;
  const DeviceView<double *[dofs][dofs]> matrix(Kokkos::ViewAllocateWithoutInitializing("rpc::fem::cell_stiffness"),
                                                most);
  LO bad = 0;
  for (LO first = 0; first < num_cells; first += most) {
    const LO count = most < num_cells - first ? most : num_cells - first;
    bad += tabulate_stiffness(stiffness, CellsFrom{first, d.mesh->block}, count, matrix);
    const AddTabulated<Dim, Nodes> add{d.mesh->cells, first,           first + count, d.mesh->num_owned_nodes(),
                                       matrix,        d.node_to_cells, d.nodes(),     values};
    Kokkos::parallel_for("rpc::fem::add_tabulated", device_range(Nodes * count), add);
    Kokkos::fence();
  }
  return bad;
}

/// The rows of one node of K, from the tabulated stiffness of the cells around it: each entry is written by one thread alone,
/// and leaves the cache once.
template <int Dim, int Nodes>
struct NodeStiffness {
  static constexpr int dofs = Dim * Nodes;

  DeviceView<LO **> cells;                 // (cells, Nodes)                         in, overlap lids
  DeviceView<int *> block;                 // (cells)                                in
  DeviceView<signed char *> kind;          // (cells)                                in
  DeviceView<double *[dofs][dofs]> matrix; // (kinds * blocks, dofs, dofs)   [N/m]  in
  int num_blocks;                          //                                        in
  NodeToCells node_to_cells;               //                                        in
  NodeGraph nodes;                         //                                        in

  /// @param rows  (Dim, neighbours * Dim)  [N/m]  out
  KOKKOS_FUNCTION void gather(const LO node, double *const rows) const
  {
    const std::size_t begin = nodes.row(node);
    const LO length = static_cast<LO>(nodes.row(node + 1) - begin);
    for (LO k = 0; k < Dim * Dim * length; ++k) rows[k] = 0;
    for (std::size_t k = node_to_cells.row(node); k < node_to_cells.row(node + 1); ++k) {
      const LO cell = node_to_cells.cell(k);
      add_cell_to_rows<Dim>(cells, cell, place_in(cells, cell, node), std::integral_constant<int, Nodes>(), matrix,
                            kind(cell) * num_blocks + block(cell), nodes.col, begin, length, rows);
    }
  }

  /// Whether the cells around two nodes are the same ones, but for a shift of all numbers: then so are the rows.
  KOKKOS_FUNCTION bool same_rows(const LO node, const LO other) const
  {
    const std::size_t first = node_to_cells.row(node), of_other = node_to_cells.row(other),
                      count = node_to_cells.row(node + 1) - first;
    if (node_to_cells.row(other + 1) - of_other != count) return false;
    int differs = 0;
    for (std::size_t k = 0; k < count && differs == 0; ++k) {
      const LO c = node_to_cells.cell(first + k), d = node_to_cells.cell(of_other + k);
      differs = (kind(c) != kind(d)) | (block(c) != block(d));
      for (int b = 0; b < Nodes; ++b) differs |= cells(c, b) - cells(d, b) != node - other;
    }
    return differs == 0;
  }
};

/// The rows of all nodes of a matrix.
template <int Dim, int Nodes>
struct MatrixRows {
  NodeStiffness<Dim, Nodes> stiffness;
  LO num_owned;                // nodes
  DeviceView<double *> values; // (matrix entries)  [N/m]  out

  KOKKOS_FUNCTION double *of(const LO node) const { return &values(Dim * Dim * stiffness.nodes.row(node)); }
  KOKKOS_FUNCTION void gather(const LO node) const { stiffness.gather(node, of(node)); }
  KOKKOS_FUNCTION void copy(const LO node, const LO from) const
  {
    const std::size_t size = Dim * Dim * (stiffness.nodes.row(from + 1) - stiffness.nodes.row(from));
    const double *const source = of(from);
    double *const rows = of(node);
    for (std::size_t k = 0; k < size; ++k) rows[k] = source[k];
  }
  /// The owned node of the example whose rows are the same; -1 if there is none.
  KOKKOS_FUNCTION LO same_as(const LO node, const LO example) const
  {
    for (int a = 0; a < Nodes; ++a) {
      const LO other = stiffness.cells(example, a);
      if (other == node || (other < num_owned && stiffness.same_rows(node, other))) return other;
    }
    return -1;
  }
};

/// The rows of one cell's nodes, for others to copy.
template <int Dim, int Nodes>
struct GatherExamples {
  MatrixRows<Dim, Nodes> rows;
  LO example; // cell

  KOKKOS_FUNCTION void operator()(const LO a) const
  {
    const LO node = rows.stiffness.cells(example, a);
    if (node < rows.num_owned) rows.gather(node);
  }
};

/// All other rows: copied where a mesh repeats itself, which costs a third of gathering them.
template <int Dim, int Nodes>
struct GatherStiffness {
  MatrixRows<Dim, Nodes> rows;
  LO example; // cell

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const LO other = rows.same_as(node, example);
    if (other < 0)
      rows.gather(node);
    else if (other != node)
      rows.copy(node, other);
  }
};

/// The same in two passes, for GPUs: where rows repeat, fill_entries() copies them.
template <int Dim, int Nodes>
struct GatherOrFindSource {
  MatrixRows<Dim, Nodes> rows;
  LO example;              // cell
  DeviceView<LO *> source; // (owned nodes) whose rows are to be copied; -1 where nothing is left to do   out

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const LO other = rows.same_as(node, example);
    source(node) = other == node ? -1 : other;
    if (other < 0) rows.gather(node);
  }
};

/// The rows that repeat those of another node.                                        for fill_entries()
template <int Dim>
struct CopiedRows {
  NodeGraph nodes;             //                                              in
  DeviceView<LO *> source;     // (owned nodes) as of GatherOrFindSource       in
  DeviceView<double *> values; // (matrix entries)                      [N/m]  in

  KOKKOS_FUNCTION bool has(const LO node) const { return source(node) >= 0; }
  KOKKOS_FUNCTION double value(const LO node, const std::size_t entry) const
  {
    return values(Dim * Dim * nodes.row(source(node)) + entry);
  }
};

} // namespace rpc::fem
