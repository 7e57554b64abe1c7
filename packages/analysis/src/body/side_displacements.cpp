// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/side_displacements.hpp"

#include "rpc/core/values_at.hpp"
#include "rpc/fem/elasticity.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>

namespace rpc::analysis
{

std::vector<SideDisplacement> side_displacements(const fem::Discretization &d, const Vector &u,
                                                 const std::vector<std::string> &sides)
{
  const int dim = d.dim();
  constexpr int width = 8; // of a side: sums by area and by nodes, 3 each, then area and number of nodes
  std::vector<double> own(width * sides.size(), 0), sums(own.size()), longest(sides.size(), 0), largest(sides.size());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    double *const sum = &own[width * s];
    Vector areas(d.owned_dofs);
    for (const mesh::Side &side : d.mesh->sides)
      if (side.name == sides[s]) fem::add_node_areas(d, side, areas);
    const std::vector<LO> nodes = d.mesh->nodes_of(sides[s], "side_displacement");
    const auto displacement = values_at(u, nodes, dim), area_of = values_at(areas, nodes, dim);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const double area = area_of(n, 0);
      double length = 0;
      for (int c = 0; c < dim; ++c) {
        const double x = displacement(n, c);
        sum[c] += area * x;
        sum[3 + c] += x;
        length = std::hypot(length, x);
      }
      sum[6] += area;
      sum[7] += 1;
      longest[s] = std::max(longest[s], length);
    }
  }
  const Comm &comm = d.mesh->comm();
  if (!sides.empty()) {
    Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(own.size()), own.data(), sums.data());
    Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, static_cast<int>(longest.size()), longest.data(), largest.data());
  }
  std::vector<SideDisplacement> all;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const double *const sum = &sums[width * s];
    const bool by_area = sum[6] > 0;
    SideDisplacement side{sides[s], {}, largest[s]};
    for (int c = 0; c < dim; ++c) side.mean[c] = by_area ? sum[c] / sum[6] : sum[7] > 0 ? sum[3 + c] / sum[7] : 0;
    all.push_back(side);
  }
  return all;
}

std::vector<std::array<double, 3>> held_displacements(const Problem &problem, const Vector &u)
{
  std::vector<std::string> sides;
  for (const auto &condition : problem.model().dirichlet) sides.push_back(condition.side);
  std::vector<std::array<double, 3>> means;
  for (const auto &side : side_displacements(problem.discretization(), u, sides)) means.push_back(side.mean);
  return means;
}

} // namespace rpc::analysis
