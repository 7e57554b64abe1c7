// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/mesh_levels.hpp"

#include "rpc/algebra/diagonal_matrix.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/mesh/rules.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace rpc::analysis
{
namespace
{

/// Which components of which sides are prescribed, whatever their values.
std::vector<fem::DirichletCondition> held_sides(std::vector<fem::DirichletCondition> conditions)
{
  for (auto &condition : conditions)
    for (int c = 0; c < 3; ++c) {
      if (condition.holds(c)) condition.displacement[c] = ScalarField(0.);
      condition.force[c].reset();
      condition.floats[c] = false;
      condition.float_stiffness[c] = 0;
    }
  for (auto &condition : conditions) condition.rigid.reset();
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

/// Unknowns with which a mesh is factored, without a coarser one. Where a body is one cell across, contracted meshes are much too stiff.
GO fewest_unknowns(const mesh::Mesh &finest)
{
  return finest.parents && !finest.parents->nested ? mesh::contraction_rules.few : mesh::coarsening_rules.few;
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

double largest_ratio(const fem::Discretization &d, const fem::Materials &materials)
{
  double nu = 0;
  for (const std::string &block : d.mesh->blocks) nu = std::max(nu, materials.of(block).poissons_ratio);
  return nu;
}

bool is_nearly_incompressible(const fem::Discretization &d, const fem::Materials &materials)
{
  return d.kinematics != fem::Kinematics::plane_stress && largest_ratio(d, materials) > linear_rules.mixed_above;
}

solver::Body body_of(const fem::Discretization &d)
{
  solver::Body body{d.dim(), [d] { return fem::node_coordinates(d); }, [d] { return fem::rigid_body_modes(d); }};
  const mesh::Mesh &mesh = *d.mesh;
  if (!mesh.box) return body;
  body.is_thin = mesh::thin_direction(*mesh.box).has_value();
  if (mesh::periodic(*mesh.box)) return body; // its matrix has no band
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
  solver::MeshLevels levels;
  levels.prescribed = prescribed;
  const int dim = finest.discretization().dim();
  levels.order = finest.discretization().mesh->element.order;
  const GO few = fewest_unknowns(*finest.discretization().mesh);
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
    const auto &node_of_finer = mesh->node_of_finer();
    const auto prescribed_here =
        node_of_finer ? at_vertices(prescribed, *node_of_finer, dim) : fem::dirichlet_dofs(d, held).fixed;
    levels.level.push_back(level_on(d, model, prescribed_here, mesh->to_finer()));
    thin = thin_direction(*mesh);
  }
  if (!levels.level.empty()) assemble(levels.level.back());
  if (thin && num_unknowns(*mesh) > few) levels.remark = thin_text(*mesh->discretization().mesh->box, *thin);
  levels.down_to_few = thin || num_unknowns(*mesh) <= solver::linear_rules.most_rows_on_each_rank;
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
