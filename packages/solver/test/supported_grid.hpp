// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid.hpp"
#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/linear_solver.hpp"

#include <memory>

namespace rpc::test
{

/// A grid whose first row of nodes may be held by springs, for linear solvers: H = A + springs.
struct SupportedGrid {
  explicit SupportedGrid(const int n)
      : grid(
            n, [](const GO unknown) { return unknown; }, true)
  {
    const LO num_nodes = num_local(*grid.map) / 2;
    LO num_first = 0;
    while (num_first < num_nodes && grid.map->getGlobalElement(2 * num_first) < 2 * n) ++num_first;
    points.dim = 2;
    points.first = HostView<LO *>("first", 2);
    points.first(1) = num_first;
    points.node = DeviceView<LO *>("node", num_first);
    const auto node = Kokkos::create_mirror_view(points.node);
    for (LO i = 0; i < num_first; ++i) node(i) = i;
    Kokkos::deep_copy(points.node, node);
    H = rcp(new UpdatedOperator(rcp(new StiffnessOperator(grid.A, 2)), points.node));
  }

  /// Springs at nodes whose number in the row lies in [from, to); negative ones make H indefinite. With a rotation, part of a spring's
  /// force turns aside, and H is not symmetric.
  void hold(const GO from, const GO to, const double stiffness, const double rotation = 0) const
  {
    const DeviceView<double ***> block("block", points.size(), 2, 2);
    const auto host_block = Kokkos::create_mirror_view(block);
    for (LO i = 0; i < points.size(); ++i) {
      const GO number = grid.map->getGlobalElement(2 * i) / 2;
      if (number < from || number >= to) continue;
      for (int k = 0; k < 2; ++k) host_block(i, k, k) = stiffness;
      host_block(i, 0, 1) = rotation * stiffness;
      host_block(i, 1, 0) = -rotation * stiffness;
    }
    Kokkos::deep_copy(block, host_block);
    H->set(points, block);
  }

  /// The same grid again as its own coarser one, where it is factored: multigrid on it needs few iterations.
  solver::MeshLevels levels() const
  {
    const RCP<const Map> nodes = grid.coordinates->getMap();
    const auto identity = rcp(new CrsMatrix(nodes, 1));
    for (LO node = 0; node < num_local(*nodes); ++node) {
      const GO gid = nodes->getGlobalElement(node);
      const double one = 1;
      identity->insertGlobalValues(gid, 1, &one, &gid);
    }
    identity->fillComplete();
    solver::MeshLevels levels;
    const auto stiffness = rcp(new CrsMatrix(*grid.A, Teuchos::Copy));
    const LO num_columns = num_local(*grid.A->getColMap());
    levels.level.push_back({stiffness, identity, DeviceView<char *>("prescribed", num_columns), grid.body()});
    levels.prescribed = DeviceView<char *>("prescribed", num_columns);
    levels.down_to_few = true;
    return levels;
  }

  std::unique_ptr<solver::LinearSolver> solver(const solver::LinearSolverOptions &options,
                                               solver::MakeMeshLevels levels = {}) const
  {
    return std::make_unique<solver::LinearSolver>(options, H, grid.body(), std::move(levels));
  }

  /// |b - H x| / |b|
  double residual(const Vector &x, const Vector &b) const
  {
    Vector r(b, Teuchos::Copy);
    H->apply(x, r, Teuchos::NO_TRANS, -1., 1.);
    return r.norm2() / b.norm2();
  }

  Grid grid;
  NodePoints points;
  RCP<UpdatedOperator> H;
};

} // namespace rpc::test
