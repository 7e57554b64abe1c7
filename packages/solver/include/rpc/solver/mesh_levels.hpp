// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/stiffness_operator.hpp"
#include "rpc/solver/body.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rpc::solver
{

/// A coarser mesh of the same body, for multigrid.
struct MeshLevel {
  /// K of this mesh, prescribed unknowns eliminated; multigrid writes contact into it. Null where `unassembled` stands for it.
  RCP<CrsMatrix> stiffness;
  RCP<const CrsMatrix> interpolation; ///< (owned nodes of the next finer mesh x owned nodes of this one)
  DeviceView<char *> prescribed;      ///< (columns of K) 1 where the displacement is prescribed
  Body body;                          ///< on this mesh
  int order = 1;                      ///< of its elements; 2 too where that is so in some directions alone
  /// K where most of its rows repeat, or null. The coarsest mesh always has a matrix: its solver takes one.
  std::shared_ptr<const UnassembledMatrix> unassembled = nullptr;
  RCP<const Map> columns = Teuchos::null; ///< of `unassembled`

  RCP<const Map> dofs() const { return unassembled ? unassembled->dofs : RCP<const Map>(stiffness->getDomainMap()); }
};

/// From the finest of them to the coarsest one; nodes have consecutive gids from 0, a node's unknowns follow each other.
struct MeshLevels {
  std::vector<MeshLevel> level;
  int order = 1; ///< of the finest mesh, which is none of the levels
  /// (owned dofs, at least) of the finest mesh: 1 where the displacement is prescribed
  DeviceView<char *> prescribed;
  /// The coarsest is solved directly: it has few unknowns, or multigrid has to end there. Otherwise algebraic multigrid follows.
  bool down_to_few = false;
  /// Why multigrid ends where it does, "thin in z: factored at 48 x 48 x 1 cells", or what else is particular about it; empty where there is
  /// nothing to say.
  std::string remark;
};

/// Makes them when they are needed; none if there is no coarser mesh. Collective.
using MakeMeshLevels = std::function<MeshLevels()>;

} // namespace rpc::solver
