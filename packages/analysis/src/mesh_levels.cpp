// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/mesh_levels.hpp"

#include "rpc/algebra/diagonal_matrix.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/mesh/box_patches.hpp"

#include <algorithm>
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

// Above these ratios, of order 2 and of order 1, a mixed form, and smoothers on stars, take less time than smoothers of single nodes, by
// measurement in space; on cells that are stretched more than that stars take too many iterations.          (4.7f), (4.13)
constexpr double nearly_incompressible_of_order_one = 0.485, most_stretched_of_stars = 5;

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

/// Of nodal values to themselves.
RCP<const CrsMatrix> identity(const RCP<const Map> &nodes)
{
  Vector ones(nodes);
  ones.putScalar(1);
  return diagonal_matrix(ones);
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

/// The patches of a box of which the other one is the next coarser one.
solver::PatchesOfMesh patches_between(const mesh::Mesh &fine, const mesh::BoxOptions &coarse)
{
  const Comm &comm = fine.comm();
  solver::PatchesOfMesh patches;
  for (LO n = 0; n < fine.num_local_nodes(); ++n) patches.columns.push_back(fine.node_gid(n));
  patches.stars = mesh::vertex_stars(*fine.box, comm);
  patches.interiors = mesh::inside_cells_of(coarse, *fine.box, comm);
  return patches;
}

GO num_unknowns(const mesh::BoxOptions &box)
{
  GO nodes = 1;
  for (int d = 0; d < box.element.dim; ++d) nodes *= box.intervals(d) + 1;
  return num_dofs(box.element.dim, nodes);
}

/// Boxes of the same element, down to one that is factored: it has few unknowns, or its cells are too stretched for stars. None where such a
/// box has too many unknowns, or there is none.
std::vector<mesh::BoxOptions> coarser_on_stars(mesh::BoxOptions box)
{
  const GO few = box.element.dim == 2 ? few_2d : few_3d;
  const GO most = box.element.dim == 2 ? most_factored_2d : most_factored_3d;
  std::vector<mesh::BoxOptions> coarser;
  while (coarser.empty() || num_unknowns(box) > few) {
    if (mesh::stretch(box) > most_stretched_of_stars) {
      if (num_unknowns(box) > most) coarser.clear();
      return coarser;
    }
    const auto next = mesh::halved(box);
    if (!next) return {};
    coarser.push_back(*next);
    box = *next;
  }
  return coarser;
}

/// Levels of order 2 for nearly incompressible boxes.                                                               (4.7f)
solver::MeshLevels levels_of_stars(const fem::Discretization &finest, const Model &model,
                                   const DeviceView<char *> &prescribed)
{
  solver::MeshLevels levels;
  levels.prescribed = prescribed;
  levels.order = 2;
  levels.down_to_few = true;
  levels.remark = "on stars of vertices";
  const auto held = held_sides(model.dirichlet);
  fem::Discretization fine = finest;
  solver::PatchesOfMesh *patches = &levels.patches;
  for (const mesh::BoxOptions &box : coarser_on_stars(*finest.mesh->box)) {
    auto coarse = coarser_box(fine, box);
    *patches = patches_between(*fine.mesh, *coarse.mesh->box);
    levels.level.push_back(
        level_on(coarse, model, fem::dirichlet_dofs(coarse, held).fixed, fem::interpolation(coarse, fine)));
    patches = &levels.level.back().patches;
    fine = std::move(coarse);
  }
  assemble(levels.level.back());
  return levels;
}

} // namespace

double largest_ratio(const fem::Discretization &d, const fem::Materials &materials)
{
  double nu = 0;
  for (const std::string &block : d.mesh->blocks) nu = std::max(nu, materials.of(block).poissons_ratio);
  return nu;
}

bool is_nearly_incompressible(const fem::Discretization &d, const fem::Materials &materials)
{
  const double least = d.mesh->element.order == 1 ? nearly_incompressible_of_order_one : nearly_incompressible;
  return d.kinematics != fem::Kinematics::plane_stress && largest_ratio(d, materials) > least;
}

bool smooths_on_stars(const fem::Discretization &d, const fem::Materials &materials)
{
  return d.mesh->box && d.mesh->element.name() == "Q2" && is_nearly_incompressible(d, materials) &&
         !coarser_on_stars(*d.mesh->box).empty();
}

solver::Body body_of(const fem::Discretization &d)
{
  solver::Body body{d.dim(), [d] { return fem::node_coordinates(d); }, [d] { return fem::rigid_body_modes(d); }};
  const mesh::Mesh &mesh = *d.mesh;
  if (!mesh.box) return body;
  body.is_thin = mesh::thin_direction(*mesh.box).has_value();
  const int order = mesh.element.order;
  std::vector<double> nodes; // along the axes, from that with fewest on
  for (const int cells : mesh.box->cells) nodes.push_back(order * static_cast<double>(cells) + 1);
  std::sort(nodes.begin(), nodes.end());
  double nodes_between = 1, nodes_of_plane = 1; // of a node and its neighbour along all axes, at order 1
  for (int k = 0; k + 1 < d.dim(); ++k) nodes_between += nodes_of_plane *= nodes[k];
  body.band_width = d.dim() * (order * nodes_between + 1) - 1;
  return body;
}

solver::MeshLevels mesh_levels(const NestedMesh &finest, const Model &model, const DeviceView<char *> &prescribed)
{
  if (smooths_on_stars(finest.discretization(), model.materials))
    return levels_of_stars(finest.discretization(), model, prescribed);
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
  const bool is_its_own = thin || !finest.may_have_coarser(); // and is factored, or has an algebraic hierarchy
  if (is_its_own) {
    const fem::Discretization &d = finest.discretization();
    levels.level.push_back(level_on(d, model, prescribed, identity(d.mesh->owned_nodes)));
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
  if (thin && num_unknowns(*mesh) > few) levels.remark = thin_text(*mesh->discretization().mesh->box, *thin);
  levels.down_to_few = thin || num_unknowns(*mesh) <= (dim == 2 ? most_factored_2d : most_factored_3d);
  return levels;
}

solver::MakeMeshLevels make_mesh_levels(std::shared_ptr<const NestedMesh> finest, const Model &model,
                                        const DeviceView<char *> &prescribed)
{
  return [finest = std::move(finest), model, prescribed] {
    const auto made = mesh_levels(*finest, model, prescribed);
    if (finest->is_finest())
      finest->forget_coarser(); // prediction has been before, and multigrid needs no more of them
    return made;
  };
}

} // namespace rpc::analysis
