// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/along_points.hpp"
#include "rpc/analysis/mesh_levels.hpp"
#include "rpc/analysis/stiffness.hpp"
#include "rpc/mesh/box.hpp"
#include "rpc/solver/linear_solver.hpp"
#include "updated.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

/// A block for linear solvers.
namespace rpc::test
{

/// A block with odd numbers of cells, clamped at its left side (of revolution: its outer one), that may touch with its bottom (in space: its back).
struct Block {
  fem::Discretization d;
  analysis::Model model;
  fem::DirichletDofs dirichlet;
  contact::ContactNodes points;
  RCP<UpdatedOperator> H;

  /// @param cells   of the lattice, for each direction
  /// @param is_box  whether there are coarser boxes; else the mesh counts as one from a file
  Block(const mesh::Element &element, const std::vector<int> &cells, const bool is_box = true,
        const std::vector<double> &upper = {2, 1, 1}, const double nu = 0.3,
        const fem::Kinematics kinematics = fem::Kinematics::plane_strain)
  {
    mesh::BoxOptions box{{0, 0}, {upper[0], upper[1]}, {cells[0], cells[1]}, element};
    if (element.dim == 3) box = {{0, 0, 0}, upper, cells, element};
    auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
    if (!is_box) mesh->box = nullptr;
    d = fem::discretize(mesh, kinematics);
    const char *const side = d.axisymmetric() ? "right" : "left"; // off the axis
    fem::DirichletCondition held{side, side, {ScalarField(0.), ScalarField(0.)}};
    if (element.dim == 3) held.displacement[2] = ScalarField(0.);
    model.materials = fem::Material{1000, nu};
    model.dirichlet = {held};
    contact::ContactOptions foundation;
    foundation.side = element.dim == 2 ? "bottom" : "back";
    foundation.normal = contact::Normal::fixed; // aslant: no unknown is stiffened by itself
    foundation.direction = element.dim == 2 ? Point{0.6, -0.8, 0} : Point{0.48, 0.36, -0.8};
    foundation.yield_stress = ScalarField(1.);
    foundation.gap = ScalarField(0.);
    model.contact = {foundation};
    dirichlet = fem::dirichlet_dofs(d, model.dirichlet);
    auto K = fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, model.materials), dirichlet.fixed).matrix;
    points = contact::contact_nodes(d, model.contact, dirichlet, model.materials);
    H = updated(K, points);
  }
  solver::MeshLevels levels() const { return analysis::mesh_levels(analysis::NestedMesh(d), model, dirichlet.fixed); }

  /// Contact nodes for which `is_closed` holds at their x are closed: so many times as stiff as they are.
  void close(const std::function<bool(double)> &is_closed, const double times = 1e5) const
  {
    const auto node = to_host(points.node);
    const auto own = to_host(own_stiffness(H->base(), points)), weight = to_host(points.weight);
    const auto coords = to_host(d.mesh->coords);
    HostView<double *> added("added", points.size());
    for (LO i = 0; i < points.size(); ++i) added(i) = is_closed(coords(node(i), 0)) ? times * own(i) * weight(i) : 0;
    H->set(points, along_directions(points, added));
  }
  void close_half() const
  {
    close([](const double x) { return std::fmod(x, 0.6) < 0.3; });
  }

  /// Without order, 0 where prescribed.
  Vector vector(const double phase) const
  {
    Vector v(d.owned_dofs);
    const auto fixed = to_host(dirichlet.fixed);
    const auto id = d.mesh->node_id;
    for (LO i = 0; i < num_local(*d.owned_dofs); ++i) {
      const double number = static_cast<double>(dof(d.dim(), id(node_of(d.dim(), i)), component_of(d.dim(), i)));
      v.replaceLocalValue(i, fixed(i) ? 0 : std::sin(phase + 12.9898 * number * (1 + 1e-3 * number)));
    }
    return v;
  }
  /// |b - H x| / |b|
  double residual(const Vector &x, const Vector &b) const
  {
    Vector r(b, Teuchos::Copy);
    H->apply(x, r, Teuchos::NO_TRANS, -1., 1.);
    return r.norm2() / b.norm2();
  }
  /// @param mixed  with pressures as unknowns of their own, where rpc has them
  std::unique_ptr<solver::LinearSolver> solver(const bool mixed = false) const
  {
    solver::LinearSolverOptions options;
    options.multigrid = "mesh";
    const auto nested = std::make_shared<analysis::NestedMesh>(d);
    return std::make_unique<solver::LinearSolver>(
        options, H, analysis::body_of(d), [this] { return levels(); },
        mixed ? analysis::mixed_form(nested, model, dirichlet.fixed) : solver::MakeMixedForm());
  }
};

/// |a - b|_2 / |b|_2
inline double relative_difference(const Vector &a, const Vector &b)
{
  Vector difference(a, Teuchos::Copy);
  difference.update(-1., b, 1.);
  return difference.norm2() / b.norm2();
}

} // namespace rpc::test
