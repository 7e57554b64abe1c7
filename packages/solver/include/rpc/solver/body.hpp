#pragma once

#include "rpc/core/tpetra.hpp"

#include <functional>

namespace rpc::solver
{

/// What algebraic multigrid has to know of a body. The fields are made when they are asked for, since most solves do without:
/// in space they take as much memory as seven displacements.
struct Body {
  int dim = 0;                                   ///< unknowns of a node
  std::function<RCP<MultiVector>()> coordinates; ///< (owned nodes; dim) [m]
  std::function<RCP<MultiVector>()> null_space;  ///< (owned dofs; rigid body modes)
};

} // namespace rpc::solver
