#include "iteration_cost.hpp"

#include "band_factor.hpp"
#include "rpc/core/parallel.hpp"

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

/// Of what takes a core so long [s]: on all ranks or their GPUs, while factors are made on a host.
double with_all_ranks(const StiffnessOperator &K, const double seconds)
{
  const double on_host = seconds / K.getDomainMap()->getComm()->getSize();
  constexpr double faster = 50, launches = 2e-3; // of a cycle, on an H100
  return on_gpu ? std::max(on_host / faster, launches) : on_host;
}

bool rows_repeat(const StiffnessOperator &K)
{
  return min_all(*K.getDomainMap()->getComm(), K.rows().any_repeat() ? 1 : 0) == 1;
}

constexpr double seconds_of_entry = 8e-9; // of a row that does not repeat, in a CG iteration with multigrid

} // namespace

double seconds_of_iteration(const StiffnessOperator &K)
{
  // Rows that repeat are read once. In the plane vectors count for more beside them.
  const double of_repeated = K.dofs_per_node() == 3 ? 1e-9 : 2e-9;
  return with_all_ranks(K, (rows_repeat(K) ? of_repeated : seconds_of_entry) * num_entries(K));
}

bool is_narrow(const Body &body, const StiffnessOperator &K)
{
  if (body.axes.empty()) return false;
  // What iterations take, by measurement within a quarter. (The counts above, by which other choices are made, are less.)
  constexpr double of_repeated = 1e-9, of_row = 70e-9, few_iterations = 5.5;
  const auto unknowns = static_cast<double>(K.getDomainMap()->getGlobalNumElements());
  const double iteration =
      rows_repeat(K) ? of_repeated * num_entries(K) + of_row * unknowns : seconds_of_entry * num_entries(K);
  const FactorCost band = BandFactor::cost_of(unknowns, body.band_width);
  return band.seconds + band.seconds_of_solve <= few_iterations * with_all_ranks(K, iteration);
}

} // namespace rpc::solver
