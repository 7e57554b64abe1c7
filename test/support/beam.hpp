// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "judged.hpp"
#include "rpc/contact/iterate.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"
#include "rpc/solver/linear_solver.hpp"
#include "rpc/solver/newton.hpp"
#include "updated.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <memory>
#include <vector>

namespace rpc::test
{

/// The beam's foundation.
inline contact::ContactOptions below(const ScalarField &xi, const double penalty,
                                     const ScalarField &gap = ScalarField(0.))
{
  contact::ContactOptions contact;
  contact.side = "bottom";
  contact.yield_stress = xi;
  contact.gap = gap;
  contact.penalty = penalty;
  return contact;
}

/// A box in the plane, pressed from above on a foundation, with all that a minimization takes.
struct PressedBox {
  fem::Discretization d;
  fem::ElasticProblem elastic;
  std::shared_ptr<contact::Iterate> iterate;
  std::shared_ptr<solver::LinearSolver> linear;
  RCP<Vector> u;

  /// @param held  its sides without displacement   @param push  upwards, at the top [Pa]
  PressedBox(const mesh::BoxOptions &box, const fem::Material &material, const std::vector<const char *> &held,
             const ScalarField &push, const contact::ContactOptions &foundation,
             const solver::LinearSolverOptions &options = {})
  {
    d = fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
    std::vector<fem::DirichletCondition> conditions;
    for (const char *side : held) conditions.push_back({side, side, {ScalarField(0.), ScalarField(0.)}});
    const auto load = rcp(new Vector(d.owned_dofs));
    fem::add_traction(d, d.mesh->side("top", ""), {ScalarField(0.), push, ScalarField(0.)}, "Traction", *load);
    const auto dirichlet = fem::dirichlet_dofs(d, conditions);
    const auto K = fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, material), dirichlet.fixed);
    const auto nodes = contact::contact_nodes(d, {foundation}, dirichlet, material);
    elastic = fem::elastic_problem(d, K.couplings, load, dirichlet);
    iterate = std::make_shared<contact::Iterate>(elastic, nodes, updated(K.matrix, nodes));
    linear = std::make_shared<solver::LinearSolver>(options, iterate->hessian(),
                                                    solver::Body{d.dim(), [d = d] { return fem::node_coordinates(d); },
                                                                 [d = d] { return fem::rigid_body_modes(d); }});
    u = rcp(new Vector(d.owned_dofs));
  }
};

/// The paper's beam at 1/h = 16, by default with xi = 16, where the states are many.
struct Beam : PressedBox {
  explicit Beam(const solver::LinearSolverOptions &options = {},
                const contact::ContactOptions &foundation = below(ScalarField(16.), 1e8))
      : PressedBox({{0, 0}, {5, 1}, {80, 16}, {2, 1}}, {2000, 0.3}, {"left", "right"},
                   ScalarField("push", [](const Point &x) { return -20 * std::sin(std::acos(-1.) * x[0] / 5); }),
                   foundation, options)
  {
  }
};

/// All nodes close but those between two places, which open.
inline void open_between(Beam &beam, const double from, const double to)
{
  const auto coordinates = fem::node_coordinates(beam.d);
  {
    const auto x = coordinates->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto u = beam.u->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t n = 0; n < x.extent(0); ++n) u(2 * n + 1, 0) = x(n, 0) > from && x(n, 0) < to ? 1 : 0;
  }
  beam.iterate->update_hessian(*beam.u);
}

inline void ignore(const solver::NewtonStep &, const Vector &) {}

/// By Newton's steps alone, or those that a loop chooses.
inline solver::MinimizeResult minimize(PressedBox &body, const solver::NewtonOptions &options = {},
                                       const solver::MinimizationLoop &loop = {},
                                       const solver::NewtonReport &report = ignore)
{
  return solver::minimize(*body.iterate, *body.linear, body.u, body.iterate->force_scale(), options, loop, report);
}

} // namespace rpc::test
