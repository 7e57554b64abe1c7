// SPDX-License-Identifier: BSD-3-Clause
#include "body/mean_displacements.hpp"

#include "rpc/core/values_at.hpp"
#include "rpc/fem/elasticity.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>

namespace rpc::analysis
{
namespace
{

/// (owned dofs) the area that each node of a side stands for, along each component. Points have none.
RCP<Vector> areas_of(const fem::Discretization &d, const std::string &side)
{
  const auto areas = Teuchos::rcp(new Vector(d.owned_dofs));
  for (const mesh::Side &each : d.mesh->sides)
    if (each.name == side) fem::add_node_areas(d, each, *areas);
  return areas;
}

} // namespace

MeanDisplacements::MeanDisplacements(const Problem &problem)
    : comm_(problem.discretization().mesh->comm()), dim_(problem.discretization().dim())
{
  const fem::Discretization &d = problem.discretization();
  for (const auto &condition : problem.model().dirichlet) {
    Place place{d.mesh->nodes_of(condition.side, condition.path() + "->Side"), {}};
    const auto areas = areas_of(d, condition.side);
    const bool is_area = areas->normInf() > 0; // of a side that is the axis of a body of revolution there is none
    const auto area = values_at(*areas, place.nodes, dim_);
    for (std::size_t n = 0; n < place.nodes.size(); ++n) place.weights.push_back(is_area ? area(n, 0) : 1);
    places_.push_back(std::move(place));
  }
}

std::vector<std::array<double, 3>> MeanDisplacements::operator()(const Vector &u) const
{
  std::vector<double> own(6 * places_.size(), 0), sums(own.size()); // of each condition: weighted sums, weights
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Place &place = places_[k];
    const auto displacement = values_at(u, place.nodes, dim_);
    for (std::size_t n = 0; n < place.nodes.size(); ++n)
      for (int c = 0; c < dim_; ++c) {
        own[6 * k + c] += place.weights[n] * displacement(n, c);
        own[6 * k + 3 + c] += place.weights[n];
      }
  }
  if (!own.empty())
    Teuchos::reduceAll(comm_, Teuchos::REDUCE_SUM, static_cast<int>(own.size()), own.data(), sums.data());
  std::vector<std::array<double, 3>> means(places_.size());
  for (std::size_t k = 0; k < means.size(); ++k)
    for (int c = 0; c < 3; ++c) means[k][c] = sums[6 * k + 3 + c] > 0 ? sums[6 * k + c] / sums[6 * k + 3 + c] : 0;
  return means;
}

} // namespace rpc::analysis
