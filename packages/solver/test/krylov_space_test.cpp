// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/krylov_space.hpp"

#include "supported_grid.hpp"

#include <gtest/gtest.h>

namespace krylov_space_test
{
namespace
{

using namespace rpc;
using rpc::test::SupportedGrid;

constexpr int n = 12;

/// A grid on springs that turn forces aside, its preconditioner, and forces on it.
struct Scene {
  SupportedGrid on{n};
  std::unique_ptr<solver::LinearSolver> linear;
  const solver::Preconditioner *B;
  Vector b{on.grid.map};

  Scene()
  {
    on.hold(0, n, 5, 0.5);
    linear = on.solver({}, [this] { return on.levels(); });
    B = linear->preconditioner();
    b.randomize();
  }
  /// F <- b + H d
  void add(const Vector &d, Vector &F) const { on.H->apply(d, F, Teuchos::NO_TRANS, 1., 1.); }
};

/// |H z . F| for the vector of the space that turns F aside least, which is 0 at the least residual: over |F|^2.
double left_in(solver::KrylovSpace &space, const Vector &F)
{
  Vector d(F.getMap()), rest(F, Teuchos::Copy);
  const double least = space.minimize(d, rest);
  return 1 - least / F.norm2();
}

TEST(KrylovSpace, LeavesNoMoreThanGmres)
{
  const Scene scene;
  ASSERT_NE(scene.B, nullptr);
  solver::KrylovSpace space(scene.on.H);
  Vector x(scene.b.getMap()), F(scene.b, Teuchos::Copy), d(F.getMap());
  double norm = F.norm2();
  while (norm > 1e-9 * scene.b.norm2() && space.size() < 50) {
    ASSERT_TRUE(space.extend(*scene.B, F));
    const double now = space.minimize(d, F);
    ASSERT_LT(now, norm);
    norm = now;
    x.update(1., d, 1.);
  }
  EXPECT_LT(left_in(space, F), 1e-6);
  Vector exact(scene.b, Teuchos::Copy);
  scene.add(x, exact);
  EXPECT_LT(exact.norm2(), 1.1e-9 * scene.b.norm2());

  const auto gmres = scene.on.solver({}, [&] { return scene.on.levels(); })->solve(scene.b, x, 1e-9);
  ASSERT_TRUE(gmres.converged);
  EXPECT_LE(space.size(), gmres.iterations + 1);
}

TEST(KrylovSpace, FollowsAChangeOfTheOperatorWithTheVectorsThatItHas)
{
  const Scene scene;
  solver::KrylovSpace space(scene.on.H);
  Vector F(scene.b, Teuchos::Copy), d(F.getMap());
  for (int k = 0; k < 6; ++k) {
    ASSERT_TRUE(space.extend(*scene.B, F));
    space.minimize(d, F);
  }
  scene.on.hold(0, n, 4, -0.3);
  F.assign(scene.b);
  Vector alone(F.getMap());
  space.find_least(F, alone);
  const double least = space.minimize(d, F);
  alone.update(-1., d, 1.);
  EXPECT_EQ(alone.normInf(), 0);
  Vector exact(scene.b, Teuchos::Copy);
  scene.add(d, exact);
  exact.update(-1., F, 1.);
  EXPECT_LT(exact.norm2(), 1e-12 * scene.b.norm2()); // F is b + H d with the new H
  EXPECT_LT(left_in(space, F), 1e-9);
  EXPECT_LT(least, 0.1 * scene.b.norm2());
}

TEST(KrylovSpace, IsNotForWhatTheDeckHasItsOwnMethodFor)
{
  const Scene scene;
  solver::LinearSolverOptions options;
  options.method = "BiCGStab";
  EXPECT_EQ(scene.on.solver(options)->preconditioner(), nullptr);
}

TEST(KrylovSpace, IsNotExtendedByNothing)
{
  const Scene scene;
  solver::KrylovSpace space(scene.on.H);
  EXPECT_FALSE(space.extend(*scene.B, Vector(scene.b.getMap())));
  EXPECT_EQ(space.size(), 0);
}

} // namespace
} // namespace krylov_space_test
