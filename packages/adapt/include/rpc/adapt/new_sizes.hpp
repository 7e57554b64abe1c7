// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/estimator.hpp"
#include "rpc/adapt/rules.hpp"
#include "rpc/mesh/size_field.hpp"

#include <limits>
#include <memory>

namespace rpc::adapt
{

/// What new cell sizes are to bring about.
struct SizeRequest {
  double squared_error = 0;              ///< bound on eta^2 [J], > 0
  double max_cells = 0;                  ///< of the new mesh, see Sizes; takes precedence
  double max_growth = plan_rules.growth; ///< of a cell's size from one mesh to the next, > 1
  double most_cells =
      std::numeric_limits<double>::infinity(); ///< where contact that is unseen asks for more than max_cells
};

/// Cell sizes that bring the squared error estimate to a bound with the fewest cells.                 doc/theory.md (10.5)
///
/// Cells where the solution is smooth shrink or grow by (c / eta_T^2)^(1 / (2p + dim)). Towards boundary vertices where the
/// estimates tell |u| ~ r^lambda with lambda < p, sizes fall like r^(2 (p + 1 - lambda) / (2p + dim)). (10.6)
struct Sizes {
  std::shared_ptr<const mesh::SizeField> field; ///< rank 0 only, null elsewhere; rounded, so that last
                                                ///< digits, which differ between ranks, hardly ever matter
  double predicted_cells = 0;                   ///< of the new mesh; six tetrahedra stand for a hexahedron
};

/// Collective.
Sizes new_sizes(const fem::Discretization &d, const ErrorEstimate &estimate, const SizeRequest &request);

} // namespace rpc::adapt
