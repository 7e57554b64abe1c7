#pragma once

#include "rpc/core/tpetra.hpp"

#include <functional>
#include <vector>

namespace rpc::solver
{

/// A coarser mesh of the same body, for multigrid.
struct MeshLevel {
  RCP<CrsMatrix> stiffness;           ///< K of this mesh, prescribed unknowns eliminated; multigrid adds contact to it
  RCP<const CrsMatrix> interpolation; ///< (owned nodes of the next finer mesh x owned nodes of this one)
  DeviceView<char *> prescribed;      ///< (columns of `stiffness`) 1 where the displacement is prescribed
  RCP<MultiVector> coordinates;       ///< (owned nodes; dim) [m]
  RCP<MultiVector> null_space;        ///< (owned dofs; rigid body modes)
};

/// From the finest of them to the coarsest one; nodes have consecutive gids from 0, a node's unknowns follow each other.
struct MeshLevels {
  std::vector<MeshLevel> level;
  int order = 1; ///< of the finest mesh, which is none of the levels; all levels have order 1
  /// (owned dofs, at least) of the finest mesh: 1 where the displacement is prescribed
  DeviceView<char *> prescribed;
  /// The coarsest has few unknowns: it is solved directly. Otherwise algebraic multigrid follows.
  bool down_to_few = false;
};

/// Makes them when they are needed; none if there is no coarser mesh. Collective.
using MakeMeshLevels = std::function<MeshLevels()>;

} // namespace rpc::solver
