// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"
#include "judged.hpp"
#include "rpc/contact/energies.hpp"
#include "rpc/contact/iterate.hpp"
#include "rpc/solver/newton.hpp"

// Tresca's problem has a convex functional: J_T = J + sum_i w_i s_i |e_i|. The smoothed one falls with each of Newton's steps, its minima
// rise from one Uzawa iteration to the next, and J_T falls to the same value from above.

namespace friction_descent_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// J_T at u, from 0. Where points are open, closed or yield makes no difference: xi is finite.
double tresca(const analysis::Problem &problem, const analysis::Step &step, const Vector &u)
{
  const contact::ContactNodes &c = step.contact;
  const contact::ContactState state{rcp(new Vector(u, Teuchos::Copy)), {DeviceView<double *>("0", c.size())}, {}};
  // Without pressures energy() is that of the body alone, but for points whose normal displacement is prescribed.
  double sum = contact::energy(elastic_energy(*problem.stiffness(), step.elastic, u), c, state) +
               contact::friction_work(c, state);
  const auto x = u.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto fixed = to_host(c.fixed);
  const auto weight = to_host(c.weight), free_gap = to_host(c.free_gap);
  const auto direction = to_host(c.direction);
  const auto node = to_host(c.node);
  const auto yield = step.contact.law;
  for (LO i = 0; i < c.size(); ++i) {
    if (fixed(i)) continue;
    double v = -free_gap(i);
    for (int k = 0; k < c.dim; ++k) v += direction(i, k) * x(c.dim * node(i) + k, 0);
    sum += weight(i) * yield(i).yield * std::max(0., v);
  }
  return sum;
}

/// What Uzawa's iteration goes through.
struct Descent {
  std::vector<std::vector<double>> smoothed; ///< after each step of each minimization
  std::vector<double> tresca;                ///< at the end of each minimization
  double scale = 0;
};

Descent descent(const std::string &method, const double penalty)
{
  Scene scene =
      read_scene(friction_deck("block_tresca"), {"Mesh->Cells={8, 6, 4}", "NOX->Direction->Method=" + method,
                                                 "Contact->Penalty=" + text(penalty), "NOX->Residual Tolerance=1e-12"});
  const auto mesh = std::make_shared<mesh::Mesh>(mesh::make_mesh(scene.mesh, Tpetra::getDefaultComm()));
  const analysis::Problem problem(mesh, scene.model);
  const analysis::Step step = problem.step(1);
  analysis::SolverState state(problem, scene.linear_solver);
  contact::Iterate iterate(step.elastic, step.contact, state.hessian());
  const auto u = rcp(new Vector(*step.elastic.dirichlet.value, Teuchos::Copy));
  Descent found;
  for (int uzawa = 0; uzawa < 30; ++uzawa) {
    found.smoothed.emplace_back();
    const auto result = solver::minimize(
        iterate, state.linear(), u, iterate.force_scale(), scene.step.newton, nullptr,
        [&](const solver::NewtonStep &, const Vector &at) { found.smoothed.back().push_back(iterate.value(at)); });
    EXPECT_TRUE(result.converged) << result.reason;
    found.tresca.push_back(tresca(problem, step, *u));
    if (iterate.duals().update(*u) < 1e-9) break;
  }
  found.scale = std::abs(found.tresca.back());
  return found;
}

class TrescaDescent : public testing::TestWithParam<const char *>
{
};
INSTANTIATE_TEST_SUITE_P(Directions, TrescaDescent, testing::Values("Newton", "Sweep"));

TEST_P(TrescaDescent, EachStepLowersTheSmoothedFunctional)
{
  const Descent found = descent(GetParam(), 3e4);
  for (const auto &values : found.smoothed)
    for (std::size_t k = 1; k < values.size(); ++k) EXPECT_LE(values[k], values[k - 1] + 1e-13 * found.scale) << k;
  EXPECT_GE(found.smoothed.front().size(), 4u);
}

TEST_P(TrescaDescent, TrescasFunctionalFallsFromOneUzawaIterationToTheNext)
{
  const Descent found = descent(GetParam(), 3e3);
  ASSERT_GE(found.tresca.size(), 4u);
  std::string values;
  for (std::size_t k = 0; k < found.tresca.size(); ++k)
    values += text(found.smoothed[k].back()) + " <= " + text(found.tresca[k]) + "\n";
  for (std::size_t k = 1; k < found.tresca.size(); ++k) {
    EXPECT_LE(found.tresca[k], found.tresca[k - 1] + 1e-12 * found.scale) << k << "\n" << values;
    // The minima are values of the dual problem: they rise, and never exceed J_T.
    EXPECT_GE(found.smoothed[k].back(), found.smoothed[k - 1].back() - 1e-12 * found.scale) << k << "\n" << values;
  }
  for (std::size_t k = 0; k < found.tresca.size(); ++k)
    EXPECT_LE(found.smoothed[k].back(), found.tresca.back() + 1e-12 * found.scale);
  EXPECT_GT(found.tresca.front() - found.tresca.back(), 1e-6 * found.scale);
  EXPECT_NEAR(found.smoothed.back().back(), found.tresca.back(), 1e-8 * found.scale);
}

TEST_P(TrescaDescent, EndsAtTheProgramsSolution)
{
  const Solution s = solved("block_tresca", {"Mesh->Cells={8, 6, 4}"});
  const Descent found = descent(GetParam(), 3e4);
  EXPECT_NEAR(found.tresca.back(), s.energy + s.contact.total.friction_work, 1e-9 * found.scale);
}

} // namespace
} // namespace friction_descent_test
