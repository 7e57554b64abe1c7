#include "rpc/adapt/refinement.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/io/gather.hpp"
#include "size_plan.hpp"

#include <cmath>
#include <limits>

namespace rpc::adapt
{
namespace
{

/// The mesh and its errors on rank 0; empty elsewhere. Collective.
EstimatedMesh gathered(const fem::Discretization &d, const ErrorEstimate &estimate)
{
  const mesh::Mesh &mesh = *d.mesh;
  const auto &comm = mesh.owned_nodes->getComm();
  const io::CanonicalOrder nodes(comm, mesh.node_id, "node"), cells(comm, mesh.cell_id, "cell");
  const auto coords = to_host(mesh.coords);
  const auto vertices_of = to_host(mesh.cells);
  const auto squared = to_host(estimate.squared);
  const auto ids = io::overlap_node_ids(mesh);
  EstimatedMesh all;
  all.order = mesh.element.order;
  all.vertices = mesh.element.num_vertices();
  std::vector<double> x;
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
    for (int i = 0; i < 2; ++i) x.push_back(coords(n, i));
  std::vector<int> vertices;
  for (LO cell = 0; cell < mesh.num_owned_cells; ++cell)
    for (int a = 0; a < all.vertices; ++a) vertices.push_back(static_cast<int>(ids(vertices_of(cell, a))));
  all.coords = nodes.gather(x.data(), 2);
  all.cells = cells.gather(vertices.data(), all.vertices);
  all.squared = cells.gather(squared.data(), 1);
  return all;
}

} // namespace

Teuchos::ParameterList valid_adapt_parameters()
{
  Teuchos::ParameterList valid("Adapt");
  valid.set(
      "Target Relative Error", 0.,
      "Bound on the estimated error in the energy norm over that of the solution, in (0, 1): meshes are refined where "
      "the error is until it holds. 0: one mesh, as \"Mesh\" gives it.");
  valid.set("Max Dofs", 2000000, "Unknowns that no mesh but the first is to exceed, > 0.");
  valid.set("Max Cycles", 12, "Meshes, > 0.");
  valid.set("Estimate Error", false, "Estimate the error without refining; with a target that is done anyway.");
  valid.set("Exact Energy", std::numeric_limits<double>::quiet_NaN(),
            "J of the exact solution [J], in 2D per m, to compare the estimate with; nan, which is to leave it out: "
            "unknown.");
  valid.set("Write All", false, "Write the results of each mesh, as <deck>.cycle<k>, besides those of the last.");
  return valid;
}

AdaptOptions adapt_options(const Teuchos::ParameterList &list)
{
  AdaptOptions options;
  options.target = list.get<double>("Target Relative Error");
  options.max_dofs = list.get<int>("Max Dofs");
  options.max_cycles = list.get<int>("Max Cycles");
  options.exact_energy = list.get<double>("Exact Energy");
  options.estimate = list.get<bool>("Estimate Error") || options.adapts();
  options.write_all = list.get<bool>("Write All");
  RPC_REQUIRE(options.target >= 0 && options.target < 1,
              "deck: \"Adapt->Target Relative Error\" must be in (0, 1), or 0 for none, got " << options.target);
  RPC_REQUIRE(options.max_dofs > 0, "deck: \"Adapt->Max Dofs\" must be > 0, got " << options.max_dofs);
  RPC_REQUIRE(options.max_cycles > 0, "deck: \"Adapt->Max Cycles\" must be > 0, got " << options.max_cycles);
  RPC_REQUIRE(!std::isinf(options.exact_energy),
              "deck: \"Adapt->Exact Energy\" must be finite, or nan where it is unknown, got " << options.exact_energy);
  return options;
}

Sizes new_sizes(const fem::Discretization &d, const ErrorEstimate &estimate, const SizeRequest &request)
{
  RPC_REQUIRE(d.dim() == 2, "deck: \"Adapt\" works in 2D only, got a mesh in " << d.dim() << "D");
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
