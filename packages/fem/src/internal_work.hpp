// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "around_nodes.hpp"
#include "elastic_cells.hpp"

/// Internal forces and energy, cell by cell.
namespace rpc::fem
{

/// What a displacement does in one cell: f(ai) += int sigma(u) : grad(N_a e_i) to the cell's nodes, and sums over the cells
/// that this rank owns.                                                                              paper (1), (2.10)
template <int Dim, int Nodes, bool Axisymmetric>
struct InternalWorkOfCell {
  using Body = ElasticCells<Dim, Nodes, Axisymmetric>;
  using Gradients = typename Body::Gradients;
  using Dilatation = typename Body::Dilatation;

  Body body;    //                       in
  ReadVector u; // (overlap dofs)  [m]   in
  LO num_owned; // nodes
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
    for (int a = 0; a < Nodes; ++a)
      for (int i = 0; i < Dim; ++i) moved[a][i] = body.moved(u, cell, a, i);
    constexpr int first = Axisymmetric ? 0 : 1; // node that may have moved
    body.at_points(cell, [&](int, const double volume, const Gradients &dN, const Dilatation &dilatation) {
      double stress[Dim][Dim], trace = 0, product = 0; // without the part of the dilatation
      for (int i = 0; i < Dim; ++i)
        for (int a = first; a < Nodes; ++a) trace += moved[a][i] * dilatation[a][i];
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j <= i; ++j) {
          double strain = 0; // twice
          for (int a = first; a < Nodes; ++a) strain += moved[a][i] * dN[a][j] + moved[a][j] * dN[a][i];
          stress[i][j] = stress[j][i] = volume * mu * strain;
          product += (i == j ? 0.25 : 0.5) * strain * strain;
        }
      if constexpr (Axisymmetric) {
        double hoop = 0; // strain
        for (int a = 0; a < Nodes; ++a) hoop += moved[a][0] * dN[a][Dim];
        product += hoop * hoop;
        for (int a = 0; a < Nodes; ++a) own[a][0] += 2 * volume * mu * hoop * dN[a][Dim];
      }
      of_cell += volume * (lambda * trace * trace + 2 * mu * product);
      for (int a = first; a < Nodes; ++a)
        for (int i = 0; i < Dim; ++i) {
          own[a][i] += volume * lambda * trace * dilatation[a][i];
          for (int j = 0; j < Dim; ++j) own[a][i] += stress[i][j] * dN[a][j];
        }
    });
    for (int i = 0; i < Dim; ++i) { // together they move nothing
      if (!Body::translates(i)) continue;
      own[0][i] = 0;
      for (int a = 1; a < Nodes; ++a) own[0][i] -= own[a][i];
    }
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
