// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/adapt/new_sizes.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/mesh/canonical_order.hpp"
#include "size_plan.hpp"

namespace rpc::adapt
{
namespace
{

/// The mesh and its errors on rank 0; empty elsewhere. Collective.
EstimatedMesh gathered(const fem::Discretization &d, const ErrorEstimate &estimate)
{
  const mesh::Mesh &mesh = *d.mesh;
  const auto &comm = mesh.owned_nodes->getComm();
  const mesh::CanonicalOrder nodes(comm, mesh.node_id, "node"), cells(comm, mesh.cell_id, "cell");
  const auto coords = to_host(mesh.coords);
  const auto vertices_of = to_host(mesh.cells);
  const auto squared = to_host(estimate.squared);
  const auto ids = mesh::overlap_node_ids(mesh);
  EstimatedMesh all;
  all.order = mesh.element.order;
  all.dim = mesh.dim();
  all.vertices = mesh.element.num_vertices();
  std::vector<double> x;
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
    for (int i = 0; i < all.dim; ++i) x.push_back(coords(n, i));
  std::vector<int> vertices;
  for (LO cell = 0; cell < mesh.num_owned_cells; ++cell)
    for (int a = 0; a < all.vertices; ++a) vertices.push_back(static_cast<int>(ids(vertices_of(cell, a))));
  all.coords = nodes.gather(x.data(), all.dim);
  all.cells = cells.gather(vertices.data(), all.vertices);
  all.squared = cells.gather(squared.data(), 1);
  if (estimate.unseen() > 0) {
    all.unseen_squared = cells.gather(to_host(estimate.unseen_squared).data(), 1);
    all.seen_from = cells.gather(to_host(estimate.seen_from).data(), 1);
  }
  return all;
}

} // namespace

Sizes new_sizes(const fem::Discretization &d, const ErrorEstimate &estimate, const SizeRequest &request)
{
  const EstimatedMesh mesh = gathered(d, estimate);
  Sizes sizes;
  on_root(d.mesh->comm(), ExitCode::internal_error, [&] {
    SizePlan plan = plan_sizes(mesh, request);
    sizes.predicted_cells = plan.cells;
    sizes.field = std::make_shared<mesh::SizeField>(std::move(plan.field));
  });
  Teuchos::broadcast(d.mesh->comm(), 0, Teuchos::outArg(sizes.predicted_cells));
  return sizes;
}

} // namespace rpc::adapt
