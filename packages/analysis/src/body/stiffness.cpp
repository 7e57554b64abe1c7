// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/stiffness.hpp"

#include "rpc/analysis/mesh_levels.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/fem/soft_dilatation.hpp"

#include <utility>

namespace rpc::analysis
{
namespace
{

/// How the stiffness of a nearly incompressible body is split.
struct Split {
  double ratio;     ///< Poisson's ratio of the soft part
  bool alternating; ///< pressures that alternate from cell to cell have equations of their own                  (4.15a)
};

/// By measurement. A larger ratio costs multigrid iterations, a smaller one makes the equations of pressures worse, most where pressures are
/// constant in tetrahedra. In tetrahedra equations for alternating pressures pay where nu is above 0.495 only.       (4.13)
Split split_of(const mesh::Element &element, const double nu)
{
  if (element.dim == 2 || element.shape != mesh::Shape::simplex) return {linear_rules.soft, element.order == 1};
  return nu > linear_rules.pays_above ? Split{linear_rules.softer_tetrahedra, true}
                                      : Split{linear_rules.soft_tetrahedra, false};
}

} // namespace

Stiffness stiffness_of(const NestedMesh &mesh, const fem::Materials &materials, const DeviceView<char *> &prescribed)
{
  const fem::Discretization &d = mesh.discretization();
  const auto assembled = [d, materials, prescribed] {
    const auto K = fem::assemble_stiffness(d, materials);
    require_finite(*K, "the stiffness matrix, from \"Material\" and \"Mesh\"",
                   [&d] { return fem::node_coordinates(d); });
    return fem::eliminate_dirichlet(d, K, prescribed);
  };
  if (const auto repeated = fem::repeated_stiffness(d, materials, prescribed)) {
    if (mesh.is_finest()) d.forget_nodes(); // of coarser meshes too, but contact asks for theirs once more
    return {
        rcp(new StiffnessOperator({repeated->rows, d.owned_dofs, d.halo, [assembled] { return assembled().matrix; }})),
        repeated->couplings};
  }
  const fem::EliminatedStiffness K = assembled();
  return {rcp(new StiffnessOperator(K.matrix, d.dim())), K.couplings};
}

solver::MakeMixedForm mixed_form(const std::shared_ptr<const NestedMesh> &finest, const Model &model,
                                 const DeviceView<char *> &prescribed)
{
  const fem::Discretization &d = finest->discretization();
  const mesh::Element &element = d.mesh->element;
  const bool simplex = element.shape == mesh::Shape::simplex;
  if (simplex && element.order == 1) return {}; // it locks: most of its pressures move nothing
  if (!is_nearly_incompressible(d, model.materials)) return {};
  const Split split = split_of(element, largest_ratio(d, model.materials));
  const auto soft = fem::softened(d, model.materials, split.ratio);
  if (!soft || is_nearly_incompressible(d, *soft)) return {}; // a block with its full dilatation would stay as it is
  Model soft_model = model;
  soft_model.materials = *soft;
  return [finest, whole = model.materials, prescribed, levels = make_mesh_levels(finest, soft_model, prescribed),
          soft = *soft, alternating = split.alternating] {
    return solver::MixedForm{stiffness_of(*finest, soft, prescribed).rows, levels,
                             fem::stiff_dilatation(finest->discretization(), whole, soft, prescribed, alternating)};
  };
}

} // namespace rpc::analysis
