#pragma once

#include "rpc/analysis/run.hpp"

#include <Teuchos_ParameterList.hpp>

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

/// What is to be solved, on meshes that are adapted where that is asked for.
struct Task : analysis::Task {
  AdaptOptions adapt;
};

/// @throws rpc::Error (bad_input) unless the task's mesh can be adapted where that is asked for
void require_adaptable(const Task &task);

} // namespace rpc::adapt
