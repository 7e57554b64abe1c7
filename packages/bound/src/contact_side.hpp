// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "boundary.hpp"
#include "rpc/core/parallel.hpp"
#include "side_on_host.hpp"

#include <cstring>

namespace rpc::bound
{

/// What ranks hold, as rows of numbers. @return that of all ranks
template <class Row>
std::vector<Row> rows_of_all(const Comm &comm, const std::vector<Row> &mine)
{
  constexpr std::size_t width = sizeof(Row) / sizeof(double);
  static_assert(sizeof(Row) == width * sizeof(double), "numbers alone");
  std::vector<double> numbers(mine.size() * width);
  if (!mine.empty()) std::memcpy(numbers.data(), mine.data(), mine.size() * sizeof(Row));
  numbers = gathered_by_all(comm, numbers);
  std::vector<Row> all(numbers.size() / width);
  if (!all.empty()) std::memcpy(static_cast<void *>(all.data()), numbers.data(), all.size() * sizeof(Row));
  return all;
}

/// A number of the law of a side, the same everywhere; NaN if it is not.
/// @param parameter  which of contact::law_parameters
double law(const contact::ContactOptions &options, int parameter);
/// (points) Of points with friction.
DeviceView<char *> where_friction_acts(const contact::ContactNodes &points);

/// What the contact law, the pressures and the normals are at the facets of a side, the same on all ranks. Collective.
/// @param model  seen at the time of the step   @param k  which contact side
/// @param prescribed  (facets, component) 1 where the displacement is
/// @throws rpc::Error (bad_input) where the side is not covered
ContactFacets contact_side(const analysis::Problem &problem, const analysis::Model &model, const analysis::Step &step,
                           const OnHost &host, int k, const PointTractions &solution,
                           const HostView<char *[2]> &prescribed);

} // namespace rpc::bound
