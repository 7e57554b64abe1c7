// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/iterate.hpp"

#include "foundation_scene.hpp"

#include <gtest/gtest.h>

namespace settled_points_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// A block that touches its foundation, on springs or rigid.
contact::ContactOptions foundation(const double compliance)
{
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = ScalarField(3.);
  options.penalty = 1e4;
  options.friction_coefficient = ScalarField(0.5);
  if (compliance > 0) options.stiffness = ScalarField(1 / compliance);
  return options;
}

/// (12.17)
TEST(RestOnMultipliers, MovesPointsToWhereTheirPenaltiesBearNothingAndKeepsTheirForces)
{
  for (const double compliance : {0., 0.02}) {
    const Scene scene(std::vector{foundation(compliance)});
    auto &iterate = *scene.iterate;
    Vector pressed(*scene.vector([](const Point &) { return Point{0, -1e-4, 0}; }), Teuchos::Copy);
    choose(iterate, pressed);
    iterate.take_active_set(iterate.choose_active_set(pressed, 0), pressed); // whose pressures are not 0
    Vector u(*scene.vector(1e-5, 0.4), Teuchos::Copy);
    Vector before(u.getMap()), after(u.getMap()), elastic(u.getMap());
    const auto contact_forces = [&](Vector &to) {
      active_set_gradient(iterate, u, to);
      iterate.functional().elastic_gradient(u, elastic);
      to.update(-1., elastic, 1.);
    };
    contact_forces(before);
    ASSERT_GT(iterate.pressure_error(u), 1e-5) << compliance;
    iterate.rest_on_multipliers(u);
    EXPECT_LT(iterate.pressure_error(u), 1e-13) << compliance;
    contact_forces(after);
    after.update(-1., before, 1.);
    EXPECT_LT(after.norm2(), 1e-12 * before.norm2()) << compliance;
  }
}

} // namespace
} // namespace settled_points_test
