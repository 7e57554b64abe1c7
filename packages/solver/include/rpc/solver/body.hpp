// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <functional>

namespace rpc::solver
{

/// What preconditioners have to know of a body beside its matrix. The fields are made when they are asked for, since most solves do
/// without: in space they take as much memory as seven displacements.
struct Body {
  int dim = 0;                                   ///< unknowns of a node
  std::function<RCP<MultiVector>()> coordinates; ///< (owned nodes; dim) [m]
  std::function<RCP<MultiVector>()> null_space;  ///< (owned dofs; rigid body modes)
  /// Of a box: how far entries of K lie from the diagonal at most [unknowns], for its nodes are numbered plane by plane along the side
  /// with most cells; 0: no box.
  double band_width = 0;
  bool is_thin = false; ///< a box that coarser cells would be thicker than, (4.7e): multigrid has no mesh but this one
};

} // namespace rpc::solver
