// SPDX-License-Identifier: BSD-3-Clause
#include "krylov/iteration_cost.hpp"

#include "factor/band_factor.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/solver/linear_solver.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>

namespace rpc::solver
{
namespace
{

/// Entries of K's rows on all ranks; collective.
double num_entries(const StiffnessOperator &K)
{
  const auto blocks = K.rows().blocks();
  double mine = 0;
  Kokkos::parallel_reduce(
      "rpc::solver::num_entries", device_range(num_local(*K.getDomainMap()) / K.dofs_per_node()),
      KOKKOS_LAMBDA(const LO node, double &sum) { sum += blocks.size(node); }, mine);
  return K.dofs_per_node() * K.dofs_per_node() * sum_all(*K.getDomainMap()->getComm(), mine);
}

/// The time on all ranks or their GPUs of work that takes one core `seconds` [s]; factors are made on a host.
double with_all_ranks(const StiffnessOperator &K, const double seconds)
{
  const double on_host = seconds / K.getDomainMap()->getComm()->getSize();
  return on_gpu ? std::max<double>(on_host / cost_model.gpu, cost_model.launches) : on_host;
}

} // namespace

IterationSeconds seconds_of_iteration(const StiffnessOperator &K)
{
  const double entries = num_entries(K);
  const auto rows = static_cast<double>(K.getDomainMap()->getGlobalNumElements());
  const int ranks = K.getDomainMap()->getComm()->getSize();
  if (min_all(*K.getDomainMap()->getComm(), K.rows().any_repeat() ? 1 : 0) == 0) {
    const double all = with_all_ranks(K, cost_model.entry * entries);
    return {all, all, ranks * all};
  }
  // Rows that repeat are read once. In the plane vectors count for more beside them.
  const double counted =
      (K.dofs_per_node() == 3 ? cost_model.repeated_entry : cost_model.entry_against_factor) * entries;
  const double measured = with_all_ranks(K, cost_model.repeated_entry * entries + cost_model.repeated_row * rows);
  return {with_all_ranks(K, counted), measured, ranks * measured};
}

bool is_bound_by_launches(const StiffnessOperator &K)
{
  return on_gpu && !(seconds_of_iteration(K).measured > cost_model.launches);
}

bool is_narrow(const double unknowns, const double width, const IterationSeconds &iteration)
{
  const FactorCost band = BandFactor::cost_of(unknowns, width);
  return band.seconds + band.seconds_of_solve <=
         linear_rules.few_iterations * (on_gpu ? iteration.measured : iteration.on_one_rank);
}

} // namespace rpc::solver
