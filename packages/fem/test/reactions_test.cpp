// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/dirichlet.hpp"

#include "bodies.hpp"
#include "rpc/fem/elasticity.hpp"

namespace reactions_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::DirichletCondition;

constexpr fem::Material steel{2000, 0.3};

/// Left fixed, right pushed in x alone by something curved; the rest free.
std::vector<DirichletCondition> held_and_pushed(const fem::Discretization &d)
{
  DirichletCondition held{"held", "left", {}}, pushed{"pushed", "right", {}};
  for (int c = 0; c < d.dim(); ++c) held.displacement[c] = ScalarField(0);
  pushed.displacement[0] = field([](const Point &x) { return 0.1 + std::sin(x[1]); });
  return {held, pushed};
}

/// Each side moves by a linear displacement along its own normal alone, and slides freely.
std::vector<DirichletCondition> rollers(const fem::Discretization &d)
{
  std::vector<DirichletCondition> conditions;
  const auto &sides = d.mesh->sides; // left, right, bottom, top, back, front
  for (int k = 0; k < 2 * d.dim(); ++k) {
    DirichletCondition condition{sides[k].name, sides[k].name, {}};
    condition.displacement[k / 2] = ScalarField(0); // its value plays no part in reactions
    conditions.push_back(condition);
  }
  return conditions;
}

TEST(ReactionForces, OfAStretchedBoxAreStressTimesArea)
{
  const double strain[3] = {0.01, -0.02, 0.005};
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const int dim = element.dim;
    const auto box = small_box(element);
    const auto d = bulged_body(element, world());
    const auto u = interpolate(d, [&](const Point &x) {
      return Point{strain[0] * x[0], strain[1] * x[1], strain[2] * x[2]};
    });
    const auto reactions =
        fem::reaction_forces(d, fem::dirichlet_dofs(d, rollers(d)), 2 * dim, *fem::internal_work(d, steel, *u).forces);
    ASSERT_EQ(static_cast<int>(reactions.size()), 2 * dim);
    double trace = 0, volume = 1;
    for (int c = 0; c < dim; ++c) {
      trace += strain[c];
      volume *= box.upper[c] - box.lower[c];
    }
    for (int k = 0; k < 2 * dim; ++k) { // what pulls an upper side points along its normal
      const int across = k / 2;
      const double area = volume / (box.upper[across] - box.lower[across]);
      const double pull = (steel.lambda() * trace + 2 * steel.mu() * strain[across]) * area * (k % 2 == 0 ? -1 : 1);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(reactions[k][c], c == across ? pull : 0, 1e-12 * std::abs(pull)) << d.mesh->sides[k].name;
    }
  }
}

TEST(ReactionForces, CountANodeOfTwoConditionsOnce)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    DirichletCondition wall{"wall", "left", {}}, floor{"floor", "bottom", {}};
    wall.displacement[0] = wall.displacement[1] = floor.displacement[0] = ScalarField(0);
    const auto dirichlet = fem::dirichlet_dofs(d, {wall, floor});
    Vector ones(d.owned_dofs);
    ones.putScalar(1);
    const auto reactions = fem::reaction_forces(d, dirichlet, 2, ones);
    std::array<int, 3> nodes{1, 1, 1};
    for (int c = 0; c < d.dim(); ++c) nodes[c] = box.cells[c] * element.order + 1;
    const std::array<double, 3> of_wall{(nodes[1] - 1.) * nodes[2], double(nodes[1] * nodes[2]), 0},
        of_floor{double(nodes[0] * nodes[2]), 0, 0};
    EXPECT_EQ(reactions[0], of_wall);
    EXPECT_EQ(reactions[1], of_floor);
    EXPECT_EQ(of_wall[0] + of_wall[1] + of_floor[0], dirichlet.num_fixed);
  }
}

TEST(ReactionForces, AreTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    const auto reactions = [&](const RCP<const Comm> &comm) {
      const auto d = bulged_body(element, comm);
      std::vector<double> all;
      for (const auto &force :
           fem::reaction_forces(d, fem::dirichlet_dofs(d, held_and_pushed(d)), 2, *interpolate(d, wild)))
        all.insert(all.end(), force.begin(), force.end());
      return all;
    };
    EXPECT_LT(difference(reactions(world()), reactions(alone())), 1e-13) << text_of(element);
  }
}

TEST(ReactionForces, BalanceTheLoad)
{
  // Whatever the displacement, it is in balance under a load that equals its internal forces at the free unknowns.
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto dirichlet = fem::dirichlet_dofs(d, held_and_pushed(d));
    Vector out_of_balance(*fem::internal_work(d, steel, *interpolate(d, wild)).forces, Teuchos::Copy);
    const double scale = out_of_balance.norm1();
    Vector load(out_of_balance, Teuchos::Copy);
    {
      const auto fixed = to_host(dirichlet.fixed);
      const auto to = load.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (std::size_t dof = 0; dof < to.extent(0); ++dof)
        if (fixed(dof)) to(dof, 0) = std::sin(double(dof)); // on held nodes too
    }
    out_of_balance.update(-1., load, 1.);
    const auto reactions = fem::reaction_forces(d, dirichlet, 2, out_of_balance);
    const Point sum = resultant(d, load);
    for (int c = 0; c < d.dim(); ++c) EXPECT_NEAR(reactions[0][c] + reactions[1][c], -sum[c], 1e-13 * scale);
    EXPECT_GT(std::abs(reactions[1][0]), 1e-6 * scale);
    EXPECT_EQ(reactions[1][1], 0); // pushed in x alone
  }
}

} // namespace
} // namespace reactions_test
