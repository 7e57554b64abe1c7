// SPDX-License-Identifier: BSD-3-Clause
#include "body/mean_displacements.hpp"

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

MeanDisplacements::MeanDisplacements(const Problem &problem) : comm_(problem.discretization().mesh->comm())
{
  const fem::Discretization &d = problem.discretization();
  const int dim = d.dim();
  for (const auto &condition : problem.model().dirichlet) {
    const std::vector<LO> nodes = d.mesh->nodes_of(condition.side, condition.path() + "->Side");
    const auto areas = areas_of(d, condition.side);
    const bool is_area = areas->normInf() > 0; // of a side that is the axis of a body of revolution there is none
    const auto area = areas->getLocalViewHost(Tpetra::Access::ReadOnly);
    std::vector<Weight> weights;
    for (const LO n : nodes)
      for (int c = 0; c < dim; ++c) weights.push_back({dim * n + c, c, is_area ? area(dim * n + c, 0) : 1});
    weights_.push_back(std::move(weights));
  }
}

std::vector<std::array<double, 3>> MeanDisplacements::operator()(const Vector &u) const
{
  const auto displacement = u.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<double> own(6 * weights_.size(), 0), sums(own.size()); // of each condition: weighted sums, weights
  for (std::size_t k = 0; k < weights_.size(); ++k)
    for (const Weight &each : weights_[k]) {
      own[6 * k + each.component] += each.weight * displacement(each.dof, 0);
      own[6 * k + 3 + each.component] += each.weight;
    }
  if (!own.empty())
    Teuchos::reduceAll(comm_, Teuchos::REDUCE_SUM, static_cast<int>(own.size()), own.data(), sums.data());
  std::vector<std::array<double, 3>> means(weights_.size());
  for (std::size_t k = 0; k < means.size(); ++k)
    for (int c = 0; c < 3; ++c) means[k][c] = sums[6 * k + 3 + c] > 0 ? sums[6 * k + c] / sums[6 * k + 3 + c] : 0;
  return means;
}

} // namespace rpc::analysis
