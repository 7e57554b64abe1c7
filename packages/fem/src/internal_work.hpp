#pragma once

#include "around_nodes.hpp"
#include "elastic_cells.hpp"

/// Internal forces and energy, cell by cell.
namespace rpc::fem
{

/// What a displacement does in one cell: f(ai) += int sigma(u) : grad(N_a e_i) to the cell's nodes, and sums over the cells
/// that this rank owns.
template <int Dim, int Nodes>
struct InternalWorkOfCell {
  using Gradients = double[Nodes][Dim];

  ElasticCells<Dim, Nodes> body; //                       in
  ReadVector u;                  // (overlap dofs)  [m]   in
  LO num_owned;                  // nodes
  LO num_owned_cells;
  WriteVector force;                      // (owned dofs)           [N]  inout, by one thread
  DeviceView<double *[Nodes][Dim]> share; // (cells, Nodes, Dim)    [N]  out, by many: what the cell adds to force

  /// @param squares  += |forces of this cell|^2 [N^2]
  /// @param energy   += int sigma(u) : eps(u) [J]
  KOKKOS_FUNCTION void operator()(const LO cell, double &squares, double &energy) const
  {
    const int block = body.block(cell);
    const double lambda = body.lame(block, 0), mu = body.lame(block, 1);
    double own[Nodes][Dim] = {}, moved[Nodes][Dim], of_cell = 0;
    // Gradients sum to 0 over the nodes; differences let a translation vanish to the last digit.
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < Dim; ++i)
        moved[a][i] = u(dof(Dim, body.cells(cell, a), i)) - u(dof(Dim, body.cells(cell, 0), i));
    body.at_points(cell, [&](int, const double volume, const Gradients &dN, const Gradients &dilatation) {
      double stress[Dim][Dim], trace = 0, product = 0; // without the part of the dilatation
      for (int i = 0; i < Dim; ++i)
        for (int a = 1; a < Nodes; ++a) trace += moved[a][i] * dilatation[a][i];
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j <= i; ++j) {
          double strain = 0; // twice
          for (int a = 1; a < Nodes; ++a) strain += moved[a][i] * dN[a][j] + moved[a][j] * dN[a][i];
          stress[i][j] = stress[j][i] = volume * mu * strain;
          product += (i == j ? 0.25 : 0.5) * strain * strain;
        }
      of_cell += volume * (lambda * trace * trace + 2 * mu * product);
      for (int a = 1; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i) {
          own[a][i] += volume * lambda * trace * dilatation[a][i];
          for (int j = 0; j < Dim; ++j) own[a][i] += stress[i][j] * dN[a][j];
        }
    });
    for (int a = 1; a < Nodes; ++a) // together they move nothing
      for (int i = 0; i < Dim; ++i) own[0][i] -= own[a][i];
    for (int a = 0; a < Nodes; ++a) {
      const LO node = body.cells(cell, a);
      for (int i = 0; i < Dim; ++i)
        if constexpr (!one_thread)
          share(cell, a, i) = own[a][i];
        else if (node < num_owned)
          force(dof(Dim, node, i)) += own[a][i];
    }
    if (cell >= num_owned_cells) return;
    energy += of_cell;
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < Dim; ++i) squares += own[a][i] * own[a][i];
  }
};

/// What the cells around a node add to the force there, in their order.
template <int Dim, int Nodes>
struct SumShares {
  DeviceView<LO **> cells;                // (cells, Nodes)               in, overlap lids
  DeviceView<double *[Nodes][Dim]> share; // (cells, Nodes, Dim)    [N]   in
  NodeToCells node_to_cells;              //                              in
  WriteVector force;                      // (owned dofs)           [N]   out

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    double sum[Dim] = {};
    for (std::size_t k = node_to_cells.row(node); k < node_to_cells.row(node + 1); ++k) {
      const int a = place_in(cells, node_to_cells.cell(k), node);
      for (int i = 0; i < Dim; ++i) sum[i] += share(node_to_cells.cell(k), a, i);
    }
    for (int i = 0; i < Dim; ++i) force(dof(Dim, node, i)) = sum[i];
  }
};

} // namespace rpc::fem
