#pragma once

#include "rpc/adapt/error_estimate.hpp"
#include "rpc/mesh/size_field.hpp"

#include <Teuchos_ParameterList.hpp>
#include <memory>

namespace rpc::adapt
{

struct AdaptOptions {
  double target = 0;       ///< of the relative error in the energy norm, in (0, 1); 0: one mesh, as it is given
  long long max_dofs = 0;  ///< of any mesh but the first, > 0
  int max_cycles = 0;      ///< meshes, > 0
  double exact_energy = 0; ///< J of the exact solution [J], in 2D per m; NaN: unknown
  bool estimate = false;   ///< whether the error is estimated; adapting implies it
  bool write_all = false;  ///< results of every mesh, not of the last only

  bool adapts() const { return target > 0; }
};

/// Parameters of the deck's `Adapt` sublist.
Teuchos::ParameterList valid_adapt_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
AdaptOptions adapt_options(const Teuchos::ParameterList &list);

/// What new cell sizes are to bring about.
struct SizeRequest {
  double squared_error = 0; ///< bound on eta^2 [J], > 0
  double max_cells = 0;     ///< takes precedence
  double max_growth = 2.5;  ///< of a cell's size from one mesh to the next, > 1
};

/// Cell sizes that bring the squared error estimate to a bound with the fewest cells.                 doc/theory.md (10.5)
///
/// Cells where the solution is smooth shrink or grow by (c / eta_T^2)^(1 / (2p + 2)). Towards boundary vertices where the
/// estimates tell |u| ~ r^lambda with lambda < p, sizes fall like r^(1 - lambda / (p + 1)). (10.6)
struct Sizes {
  std::shared_ptr<const mesh::SizeField> field; ///< rank 0 only, null elsewhere; rounded, so that last
                                                ///< digits, which differ between ranks, hardly ever matter
  double predicted_cells = 0;
};

/// Collective.
/// @throws rpc::Error (bad_input) unless the mesh is plane
Sizes new_sizes(const fem::Discretization &d, const ErrorEstimate &estimate, const SizeRequest &request);

} // namespace rpc::adapt
