// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/highest_pressure.hpp"

#include "rpc/core/parallel.hpp"
#include "rpc/fem/surface.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

namespace rpc::contact
{

HighestPressure highest_pressure(const fem::Discretization &d, const ContactNodes &c, const ContactResult &result)
{
  HighestPressure highest;
  const double largest = result.total.max_pressure;
  if (!(largest > 0)) return highest;
  constexpr double nowhere = std::numeric_limits<double>::max();
  const Comm &comm = d.mesh->comm();
  const auto pressure = to_host(result.pressure);
  const auto node = to_host(c.node);
  const auto weight = to_host(c.weight);
  const HostPoints x = fem::node_positions(*d.mesh, c.node);
  std::vector<double> first = {nowhere, nowhere, nowhere, 0}; // place and side
  std::set<LO> nodes;
  for (int side = 0; side < c.num_sides(); ++side)
    for (LO i = c.first(side); i < c.first(side + 1); ++i) {
      if (c.dim == 3 && !(weight(i) > 0)) continue; // the largest pressure is not taken there
      if (!(pressure(i) >= HighestPressure::share * largest)) continue;
      nodes.insert(node(i));
      std::vector<double> here = {x(i, 0), x(i, 1), c.dim == 3 ? x(i, 2) : 0., static_cast<double>(side)};
      first = std::min(first, here);
    }
  highest.num_places = sum_all(comm, static_cast<GO>(nodes.size()));
  std::vector<double> all(first.size() * comm.getSize());
  Teuchos::gatherAll(comm, static_cast<int>(first.size()), first.data(), static_cast<int>(all.size()), all.data());
  for (std::size_t rank = 0; rank < all.size() / first.size(); ++rank)
    first = std::min(first, std::vector<double>(&all[first.size() * rank], &all[first.size() * rank] + first.size()));
  highest.place = {first[0], first[1], first[2]};
  highest.side = static_cast<int>(first[3]);
  return highest;
}

} // namespace rpc::contact
