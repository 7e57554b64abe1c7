// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "judged.hpp"
#include "rpc/contact/iterate.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"
#include "updated.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

/// A body and a foundation with all that can happen between them.
namespace rpc::test
{

inline ScalarField field(std::function<double(const Point &)> f)
{
  return ScalarField("test", std::move(f));
}

/// The block's foundation, with a yield limit and a gap that vary.
inline contact::ContactOptions below(const double penalty)
{
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = field([](const Point &x) { return 1 + x[0]; });
  options.gap = field([](const Point &x) { return 0.02 * (1 - x[0]); });
  options.penalty = penalty;
  return options;
}
/// Another one, which shares the corner (2, 0) with it, and is not at a right angle to it there.
inline contact::ContactOptions beside(const double penalty)
{
  contact::ContactOptions options;
  options.side = "right";
  options.yield_stress = ScalarField(3.);
  options.gap = field([](const Point &x) { return 0.01 * x[1] * (1 - x[1]) - 0.005; });
  options.normal = contact::Normal::fixed;
  options.direction = {0.8, -0.6, 0};
  options.penalty = penalty;
  return options;
}

/// Holds all points of a side at a displacement.
inline fem::DirichletCondition held(const std::string &side, const Point &displacement = {})
{
  return {side, side, {ScalarField(displacement[0]), ScalarField(displacement[1])}};
}

/// A block of 6 x 3 square cells, or each cut into refinement x refinement, 2 m by 1 m, between foundations, held at its
/// top.
struct Scene {
  fem::Discretization d;
  fem::ElasticProblem elastic;
  std::shared_ptr<contact::Iterate> iterate;
  fem::Material material{10, 0.3};

  explicit Scene(const std::vector<contact::ContactOptions> &foundations,
                 const fem::DirichletCondition &condition = held("top"), const int refinement = 1)
  {
    mesh::BoxOptions box{{0, 0}, {2, 1}, {6 * refinement, 3 * refinement}, {2, 1}};
    d = fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
    const auto load = rcp(new Vector(d.owned_dofs));
    fem::add_body_force(d, {ScalarField(0.3), ScalarField(-2.), ScalarField(0.)}, "Body Force", *load);
    const auto dirichlet = fem::dirichlet_dofs(d, {condition});
    const auto K = fem::eliminate_dirichlet(d, fem::assemble_stiffness(d, material), dirichlet.fixed);
    const auto nodes = contact::contact_nodes(d, foundations, dirichlet, material);
    elastic = fem::elastic_problem(d, K.couplings, load, dirichlet);
    iterate = std::make_shared<contact::Iterate>(elastic, nodes, updated(K.matrix, nodes));
  }
  explicit Scene(const double penalty = 40) : Scene(std::vector{below(penalty)}) {}

  /// A change of displacement u(x): 0 where prescribed.
  RCP<Vector> vector(const std::function<Point(const Point &)> &u) const
  {
    const auto v = rcp(new Vector(d.owned_dofs));
    const auto to = v->getLocalViewHost(Tpetra::Access::OverwriteAll);
    const auto coords = to_host(d.mesh->coords);
    const auto fixed = to_host(elastic.dirichlet.fixed);
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      const Point value = u({coords(n, 0), coords(n, 1), 0});
      for (int c = 0; c < 2; ++c) to(2 * n + c, 0) = fixed(2 * n + c) ? 0 : value[c];
    }
    return v;
  }
  /// One that depends on the node's place alone, so that every number of ranks gets the same one.
  RCP<Vector> vector(const double scale, const double phase) const
  {
    return vector([&](const Point &x) {
      const double angle = phase + 5 * x[0] + 3 * x[1];
      return Point{scale * std::sin(angle), scale * std::sin(angle + 2), 0};
    });
  }
};

/// One choice of an active set, taken unless it confirms the present one.
inline contact::ActiveSetChoice choose(contact::Iterate &iterate, const Vector &u, const double negligible = 0)
{
  const auto choice = iterate.choose_active_set(u, negligible);
  Vector moved(u, Teuchos::Copy);
  if (!choice.confirmed) iterate.take_active_set(choice, moved);
  return choice;
}

inline void active_set_gradient(const contact::Iterate &iterate, const Vector &u, Vector &F)
{
  Vector G(u.getMap());
  iterate.gradient(u, G);
  iterate.active_set_gradient(u, G, F);
}

} // namespace rpc::test
