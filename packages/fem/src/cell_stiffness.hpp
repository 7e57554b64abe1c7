// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "elastic_cells.hpp"

/// The stiffness of single cells.
namespace rpc::fem
{

/// Nodes whose rows of a cell's stiffness one thread computes at a time: all of them where the matrix fits on its stack, else
/// a divisor of their number (Q2 hexahedra: 81 x 81 entries would take 52 kB).
constexpr int nodes_at_once(const int dim, const int nodes)
{
  constexpr int most = 8192; // bytes
  int count = nodes;
  while (nodes % count != 0 || static_cast<int>(sizeof(double)) * dim * count * dim * nodes > most) --count;
  return count;
}

/// Rows of the stiffness of one cell, if it was of a block's material.                        doc/theory.md (2.4), (2.4a)
template <int Dim, int Nodes, bool Axisymmetric = false>
struct CellStiffness {
  using Body = ElasticCells<Dim, Nodes, Axisymmetric>;
  using Gradients = typename Body::Gradients;
  static constexpr int dofs = Dim * Nodes, columns = Body::columns;
  static constexpr int at_once = nodes_at_once(columns, Nodes); ///< nodes in a pass
  static constexpr int passes = Nodes / at_once;                ///< that give all rows
  using Rows = double[Dim * at_once][dofs];
  using Products =
      double[columns * at_once][columns * Nodes]; // of gradients; but for axisymmetry as many as rows have entries

  Body body; // in

  /// The first node of a pass.
  static KOKKOS_INLINE_FUNCTION constexpr int first_node(const int pass) { return passes == 1 ? 0 : at_once * pass; }

  /// @param[out] k  rows of the nodes from first_node(pass) on [N/m]
  /// @return false if the Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION bool operator()(const LO cell, const int block, const int pass, Rows &k) const
  {
    const int first = first_node(pass);
    if constexpr (Axisymmetric) {
      Products products;
      if (!integrate(cell, first, products)) return false;
      by_hookes_law(cell, block, first, products, k);
    } else {
      if (!integrate(cell, first, k)) return false;
      by_hookes_law(cell, block, first, k, k);
    }
    return true;
  }

  /// sigma = lambda tr eps I + 2 mu eps: Hooke's law of paper (1).                                                  (2.4)
  /// @param products  may be k
  KOKKOS_FUNCTION void by_hookes_law(const LO cell, const int block, const int first, const Products &products,
                                     Rows &k) const
  {
    Projection<Dim, Nodes> projection;
    const bool projects = body.projects_in(block) && body.project(cell, projection);
    const double lambda = body.lame(block, 0), mu = body.lame(block, 1);
    for (int a = 0; a < at_once; ++a)
      for (int b = 0; b < Nodes; ++b) {
        typename Body::Tensor product;
        double trace = 0;
        for (int i = 0; i < columns; ++i)
          for (int j = 0; j < columns; ++j) product[i][j] = products[dof(columns, a, i)][dof(columns, b, j)];
        for (int i = 0; i < Dim; ++i) trace += product[i][i];
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) {
            double dilatation = product[i][j];
            if constexpr (Axisymmetric) {
              if (i == 0) dilatation += product[Dim][j];
              if (j == 0) dilatation += product[i][Dim];
              if (i == 0 && j == 0) dilatation += product[Dim][Dim];
            }
            if (projects) {
              dilatation = 0;
              for (const auto &Z : projection.Z) dilatation += Z[first + a][i] * Z[b][j];
            }
            double &entry = k[dof(Dim, a, i)][dof(Dim, b, j)];
            entry = lambda * dilatation + mu * product[j][i];
            if (i == j) entry += mu * trace;
          }
        if constexpr (Axisymmetric) k[dof(Dim, a, 0)][dof(Dim, b, 0)] += 2 * mu * product[Dim][Dim];
      }
  }

  /// product(ai, bj) = int dN_a/dx_i dN_b/dx_j for the nodes a from a first one on, with N_a/r as the last column.
  /// @return false if the Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION bool integrate(const LO cell, const int first, Products &product) const
  {
    for (auto &row : product)
      for (double &entry : row) entry = 0;
    return body.at_plain_points(cell, [&](int, const double volume, const Gradients &dN) {
      for (int a = 0; a < at_once; ++a)
        for (int i = 0; i < columns; ++i)
          for (int b = 0; b < Nodes; ++b)
            for (int j = 0; j < columns; ++j)
              product[dof(columns, a, i)][dof(columns, b, j)] += volume * dN[first + a][i] * dN[b][j];
    });
  }
};

/// The cells that are tabulated: those from a first one on, each in its own block.
struct CellsFrom {
  LO first;                // cell
  DeviceView<int *> block; // (cells)  in

  KOKKOS_INLINE_FUNCTION LO cell(const LO m) const { return first + m; }
  KOKKOS_INLINE_FUNCTION int block_of(const LO m) const { return block(first + m); }
};

/// Or those of kinds_of(), each in each block: kind * blocks + block.
struct InEachBlock {
  int num_blocks;

  KOKKOS_INLINE_FUNCTION LO cell(const LO m) const { return m / num_blocks; }
  KOKKOS_INLINE_FUNCTION int block_of(const LO m) const { return m % num_blocks; }
};

/// The stiffness of some cells, by a thread for each cell and pass.
template <int Dim, int Nodes, bool Axisymmetric, class Which>
struct TabulateStiffness {
  using Stiffness = CellStiffness<Dim, Nodes, Axisymmetric>;
  static constexpr int dofs = Dim * Nodes;

  Stiffness stiffness;                     //                                       in
  Which which;                             // CellsFrom or InEachBlock              in
  DeviceView<double *[dofs][dofs]> matrix; // (tabulated cells, dofs, dofs)  [N/m]  out

  /// @param bad  counts cells whose Jacobian is <= 0 somewhere
  KOKKOS_FUNCTION void operator()(const LO item, LO &bad) const
  {
    const LO m = item / Stiffness::passes;
    const int pass = item % Stiffness::passes;
    typename Stiffness::Rows k;
    if (!stiffness(which.cell(m), which.block_of(m), pass, k)) {
      if (pass == 0) ++bad;
      return;
    }
    const int first = dof(Dim, Stiffness::first_node(pass), 0);
    for (int r = 0; r < num_dofs(Dim, Stiffness::at_once); ++r)
      for (int c = 0; c < dofs; ++c) matrix(m, first + r, c) = k[r][c];
  }
};

/// @return number of cells whose Jacobian is <= 0 somewhere
template <int Dim, int Nodes, bool Axisymmetric, class Which>
LO tabulate_stiffness(const CellStiffness<Dim, Nodes, Axisymmetric> &stiffness, const Which &which, const LO num_cells,
                      const DeviceView<double * [Dim * Nodes][Dim * Nodes]> &matrix)
{
  LO bad = 0;
  Kokkos::parallel_reduce("rpc::fem::tabulate_stiffness",
                          device_range(CellStiffness<Dim, Nodes, Axisymmetric>::passes * num_cells),
                          TabulateStiffness<Dim, Nodes, Axisymmetric, Which>{stiffness, which, matrix}, bad);
  return bad;
}

/// Rounds the entries of a cell's stiffness so that they, and sums over the cells around a node, are exact, and lets a
/// translation have no force at all. The rounding of a cell by itself is noise, but that of a kind is the same force on all
/// its cells: 1e-16 of each would be as much as a spring of 1e-16 times the number of cells on the whole body.
template <int Dim, int Nodes>
struct BalanceStiffness {
  static constexpr int dofs = Dim * Nodes;

  DeviceView<double *[dofs][dofs]> matrix; // (tabulated cells, dofs, dofs)  [N/m]  inout

  KOKKOS_FUNCTION void operator()(const LO m) const
  {
    double largest = 0, power = 1;
    for (int r = 0; r < dofs; ++r)
      for (int c = 0; c < dofs; ++c) {
        const double size = matrix(m, r, c) < 0 ? -matrix(m, r, c) : matrix(m, r, c);
        if (!(size <= largest)) largest = size;
      }
    if (!(largest > 1e-290 && largest < 1e290)) return;
    while (power < largest) power *= 2;
    while (power > largest) power /= 2;
    // Its last digit is what all entries are multiples of: 16 of them, or 32, add up without rounding. Up to 24 tetrahedra of a
    // box meet in a node.
    const double coarse = (Dim == 3 && StaticElement<Dim, Nodes>::simplex ? 48 : 24) * power;
    for (int r = 0; r < dofs; ++r)
      for (int c = r + 1; c < dofs; ++c) matrix(m, r, c) = matrix(m, c, r) = (matrix(m, r, c) + coarse) - coarse;
    for (int r = 0; r < dofs; ++r)
      for (int j = 0; j < Dim; ++j) {
        double others = 0;
        for (int b = 0; b < Nodes; ++b)
          if (b != node_of(Dim, r)) others += matrix(m, r, dof(Dim, b, j));
        matrix(m, r, dof(Dim, node_of(Dim, r), j)) = -others;
      }
  }
};

} // namespace rpc::fem
