#include "rpc/analysis/mesh_levels.hpp"

#include "rpc/fem/interpolation.hpp"
#include "rpc/mesh/box.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace rpc::analysis
{
namespace
{

// Unknowns that boxes are halved down to: a factor of theirs takes no time, though each change of states asks for one.
constexpr GO few_2d = 800, few_3d = 400;
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

solver::MeshLevel level_on(const fem::Discretization &d, const Model &model, const DeviceView<char *> &prescribed,
                           RCP<const CrsMatrix> interpolation)
{
  const auto assembled = [d, materials = model.materials, prescribed] {
    return fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, materials), prescribed).matrix;
  };
  solver::MeshLevel level{{}, std::move(interpolation), prescribed, body_of(d), d.mesh->element.order};
  if (const auto repeated = fem::repeated_stiffness(d, model.materials, prescribed)) {
    d.forget_nodes();
    level.unassembled =
        std::make_shared<const UnassembledMatrix>(UnassembledMatrix{repeated->rows, d.owned_dofs, d.halo, assembled});
    level.columns = fem::overlap_dofs(d);
  } else {
    level.stiffness = assembled();
  }
  return level;
}

/// Of the coarsest mesh; collective.
void assemble(solver::MeshLevel &level)
{
  if (!level.unassembled) return;
  level.stiffness = level.unassembled->assemble();
  level.unassembled.reset();
}

std::optional<int> thin_direction(const NestedMesh &mesh)
{
  const auto &box = mesh.discretization().mesh->box;
  return box ? mesh::thin_direction(*box) : std::nullopt;
}

/// "thin in z: factored at 48 x 48 x 1 cells"
std::string thin_text(const mesh::BoxOptions &box, const int direction)
{
  std::string text = std::string("thin in ") + "xyz"[direction] + ": factored at ";
  for (std::size_t d = 0; d < box.cells.size(); ++d) text += (d == 0 ? "" : " x ") + std::to_string(box.cells[d]);
  return text + " cells";
}

} // namespace

solver::Body body_of(const fem::Discretization &d)
{
  return {d.dim(), [d] { return fem::node_coordinates(d); }, [d] { return fem::rigid_body_modes(d); }};
}

solver::MeshLevels mesh_levels(const NestedMesh &finest, const Model &model, const DeviceView<char *> &prescribed)
{
  solver::MeshLevels levels;
  levels.prescribed = prescribed;
  const int dim = finest.discretization().dim();
  levels.order = finest.discretization().mesh->element.order;
  const GO few = dim == 2 ? few_2d : few_3d;
  const auto held = held_sides(model.dirichlet);
  const auto num_unknowns = [](const NestedMesh &mesh) {
    return static_cast<GO>(mesh.discretization().owned_dofs->getGlobalNumElements());
  };
  const NestedMesh *mesh = &finest;
  std::optional<int> thin = thin_direction(finest);
  if (thin) { // no coarser mesh will do: the mesh is its own coarser one, where it is factored
    const fem::Discretization &d = finest.discretization();
    levels.level.push_back(level_on(d, model, prescribed, fem::interpolation(d, d)));
  }
  while (!thin && (levels.level.empty() || num_unknowns(*mesh) > few)) {
    const NestedMesh *const coarse = mesh->coarser().get();
    if (!coarse) break;
    mesh = coarse;
    const fem::Discretization &d = mesh->discretization();
    const auto prescribed_here = mesh->node_of_finer().extent(0) > 0
                                     ? at_vertices(prescribed, mesh->node_of_finer(), dim)
                                     : fem::dirichlet_dofs(d, held).fixed;
    levels.level.push_back(level_on(d, model, prescribed_here, mesh->to_finer()));
    thin = thin_direction(*mesh);
  }
  if (!levels.level.empty()) assemble(levels.level.back());
  if (thin && num_unknowns(*mesh) > few) levels.end = thin_text(*mesh->discretization().mesh->box, *thin);
  levels.down_to_few = thin || num_unknowns(*mesh) <= (dim == 2 ? most_factored_2d : most_factored_3d);
  return levels;
}

} // namespace rpc::analysis
