// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/ghost_values.hpp"

#include <algorithm>
#include <numeric>

namespace rpc::mesh
{

GhostValues::Questions GhostValues::questions(const Mesh &mesh, const std::vector<LO> &ghosts)
{
  std::vector<GO> gids;
  for (const LO ghost : ghosts) gids.push_back(mesh.ghosts[ghost]);
  const auto size = static_cast<Teuchos_Ordinal>(gids.size());
  std::vector<int> rank(size), node(size);
  if (mesh.comm().getSize() > 1)
    mesh.owned_nodes->getRemoteIndexList(Teuchos::ArrayView<const GO>(gids.data(), size),
                                         Teuchos::ArrayView<int>(rank.data(), size),
                                         Teuchos::ArrayView<int>(node.data(), size));
  Questions questions{std::vector<std::size_t>(size), std::vector<int>(mesh.comm().getSize()), {}};
  auto &order = questions.order;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](const std::size_t a, const std::size_t b) { return rank[a] < rank[b]; });
  for (const std::size_t ghost : order) {
    ++questions.counts[rank[ghost]];
    questions.node.push_back(node[ghost]);
  }
  return questions;
}

GhostValues::GhostValues(const Mesh &mesh, const std::vector<LO> &ghosts) : GhostValues(mesh, questions(mesh, ghosts))
{
}

GhostValues::GhostValues(const Mesh &mesh, const Questions &questions)
    : order_(questions.order), exchange_(mesh.comm(), questions.counts)
{
  for (const double node : exchange_.forward(questions.node, 1)) asked_.push_back(static_cast<LO>(node));
}

std::vector<double> GhostValues::of(const double *const owned) const
{
  std::vector<double> answers;
  answers.reserve(asked_.size());
  for (const LO node : asked_) answers.push_back(owned[node]);
  const std::vector<double> got = exchange_.back(answers, 1);
  std::vector<double> values(order_.size());
  for (std::size_t k = 0; k < order_.size(); ++k) values[order_[k]] = got[k];
  return values;
}

} // namespace rpc::mesh
