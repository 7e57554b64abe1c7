// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/unrolled.hpp"

#include "rpc/mesh/box_grid.hpp"

namespace rpc::mesh
{

HostView<double *> Unrolled::at_nodes(const HostView<double *> &owned) const
{
  if (node.empty()) return owned;
  HostView<double *> values(owned.label(), node.size());
  for (std::size_t n = 0; n < node.size(); ++n) values(n) = owned(node[n]);
  return values;
}

Unrolled unrolled(const std::shared_ptr<const Mesh> &mesh)
{
  Unrolled result{mesh, {}};
  if (!mesh->box || !periodic(*mesh->box)) return result;
  BoxOptions box = *mesh->box;
  box.unrolled = true;
  const auto comm = mesh->owned_nodes->getComm();
  result.mesh = std::make_shared<const Mesh>(make_box(box, comm));
  const Grid grid(*mesh->box, comm->getSize());
  const Block nodes = Grid(box, comm->getSize()).owned_nodes(comm->getRank()), own = grid.owned_nodes(comm->getRank());
  for (GO n = 0; n < nodes.size(); ++n) result.node.push_back(static_cast<LO>(own.index_of(grid.node_of(nodes.at(n)))));
  return result;
}

} // namespace rpc::mesh
