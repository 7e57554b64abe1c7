#include "rpc/analysis/mesh_levels.hpp"

#include "rpc/core/error.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/fem/order_one.hpp"
#include "rpc/mesh/box.hpp"

#include <optional>
#include <utility>

namespace rpc::analysis
{
namespace
{

// Unknowns that boxes are halved down to: a factor of theirs takes no time, though each change of states asks for one.
constexpr GO few_2d = 700, few_3d = 400;
// Unknowns of a coarsest mesh that is still factored, where there is no coarser one.
constexpr GO most_factored_2d = 2800, most_factored_3d = 5200;

/// Which components of which sides are prescribed, whatever their values.
std::vector<fem::DirichletCondition> held_sides(std::vector<fem::DirichletCondition> conditions)
{
  for (auto &condition : conditions)
    for (auto &component : condition.displacement)
      if (component) component = ScalarField(0.);
  return conditions;
}

/// (overlap dofs) Those of the vertices.
DeviceView<char *> at_vertices(const DeviceView<char *> &prescribed, const DeviceView<LO *> &node, const int dim)
{
  const LO n = static_cast<LO>(node.extent(0));
  const DeviceView<char *> flag("rpc::analysis::prescribed_at_vertices", num_dofs(dim, n));
  Kokkos::parallel_for(
      "rpc::analysis::prescribed_at_vertices", device_range(n), KOKKOS_LAMBDA(const LO v) {
        for (int k = 0; k < dim; ++k) flag(dof(dim, v, k)) = prescribed(dof(dim, node(v), k));
      });
  Kokkos::fence();
  return flag;
}

solver::MeshLevel level_on(const fem::Discretization &d, const Model &model, const fem::DirichletDofs &dirichlet,
                           RCP<CrsMatrix> interpolation)
{
  auto K = fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, model.materials), dirichlet).matrix;
  return {std::move(K), std::move(interpolation), dirichlet.fixed, fem::node_coordinates(d), fem::rigid_body_modes(d)};
}

/// The box with half as many cells; none where it would be too small for the ranks.
std::optional<fem::Discretization> halved(const mesh::Mesh &mesh, const Model &model)
{
  if (!mesh.box) return std::nullopt;
  const auto options = mesh::halved(*mesh.box);
  if (!options) return std::nullopt;
  try {
    return fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(*options, mesh.owned_nodes->getComm())),
                           model.kinematics);
  } catch (const Error &) { // too few cells, on all ranks
    return std::nullopt;
  }
}

} // namespace

bool has_mesh_levels(const mesh::Mesh &mesh)
{
  return mesh.element.order == 2 || (mesh.box && mesh::halved(*mesh.box));
}

solver::MeshLevels mesh_levels(const fem::Discretization &finest, const Model &model,
                               const DeviceView<char *> &prescribed)
{
  solver::MeshLevels levels;
  levels.prescribed = prescribed;
  levels.order = finest.mesh->element.order;
  fem::Discretization d = finest;
  const auto held = held_sides(model.dirichlet);
  if (d.mesh->element.order == 2) {
    const fem::OrderOne lower = fem::order_one(d);
    const int dim = d.dim();
    d = fem::discretize(lower.mesh, model.kinematics);
    fem::DirichletDofs dirichlet;
    dirichlet.fixed = at_vertices(prescribed, lower.node, dim);
    levels.level.push_back(level_on(d, model, dirichlet, lower.interpolation));
  }
  const GO few = d.dim() == 2 ? few_2d : few_3d;
  const auto num_unknowns = [&d] { return static_cast<GO>(d.owned_dofs->getGlobalNumElements()); };
  while (levels.level.empty() || num_unknowns() > few) {
    auto coarse = halved(*d.mesh, model);
    if (!coarse) break;
    auto interpolation = fem::interpolation(*coarse, d);
    d = std::move(*coarse);
    levels.level.push_back(level_on(d, model, fem::dirichlet_dofs(d, held), std::move(interpolation)));
  }
  levels.down_to_few = num_unknowns() <= (d.dim() == 2 ? most_factored_2d : most_factored_3d);
  return levels;
}

} // namespace rpc::analysis
