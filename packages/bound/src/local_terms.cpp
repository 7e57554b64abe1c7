// SPDX-License-Identifier: BSD-3-Clause
#include "local_terms.hpp"

#include "rpc/core/parallel.hpp"

namespace rpc::bound
{

DeviceView<double *> local_terms(const Comm &comm, const DeviceView<double *> &of_cell, const double factor,
                                 const std::vector<std::pair<LO, double>> &gaps, const double whole)
{
  const auto energy = to_host(of_cell);
  const std::size_t num_cells = energy.extent(0);
  HostView<double *> parts("rpc::bound::parts", num_cells);
  for (std::size_t c = 0; c < num_cells; ++c) parts(c) = factor * energy(c);
  for (const auto &[cell, gap] : gaps) parts(cell) += gap;
  double sum = 0;
  for (std::size_t c = 0; c < num_cells; ++c) sum += parts(c);
  sum = sum_all(comm, sum);
  for (std::size_t c = 0; c < num_cells && sum > 0; ++c) parts(c) *= whole / sum;
  return to_device(parts);
}

} // namespace rpc::bound
