// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/measure.hpp"

#include "bodies.hpp"

namespace measure_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

fem::VectorField field(const double x, const double y, const double z = 0)
{
  return {ScalarField(x), ScalarField(y), ScalarField(z)};
}

TEST(BodyMeasure, IsThatOfABox)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(element.name() + (element.dim == 3 ? " in space" : ""));
    const bool space = element.dim == 3;
    mesh::BoxOptions box{{-1, 2}, {4, 3}, {5, 4}, element};
    if (space) box = {{-1, 2, 0}, {4, 3, 2}, {3, 2, 4}, element};
    const auto d = body(box, world());
    const auto measure = fem::body_measure(d);
    EXPECT_NEAR(measure.volume, space ? 10 : 5, 1e-12);
    EXPECT_EQ(measure.lower, (Point{-1, 2, 0}));
    EXPECT_EQ(measure.upper, (Point{4, 3, space ? 2. : 0.}));
    const auto right = fem::side_measure(d, d.mesh->side("right", "test"));
    EXPECT_NEAR(right.area, space ? 2 : 1, 1e-12);
    EXPECT_LT(length(difference(right.normal, {1, 0, 0})), 1e-12);
    const auto bottom = fem::side_measure(d, d.mesh->side("bottom", "test"));
    EXPECT_NEAR(bottom.area, space ? 10 : 5, 1e-12);
    EXPECT_LT(length(difference(bottom.normal, {0, -1, 0})), 1e-12);
  }
}

TEST(BodyMeasure, OfARevolutionIsThatOfTheWholeBody)
{
  for (const auto &element : elements()) {
    if (element.dim == 3) continue;
    SCOPED_TRACE(element.name());
    const auto d = body({{1, 0}, {3, 2}, {4, 4}, element}, world(), {}, fem::Kinematics::axisymmetric);
    EXPECT_NEAR(fem::body_measure(d).volume, M_PI * (9 - 1) * 2, 1e-11);
    const auto right = fem::side_measure(d, d.mesh->side("right", "test")),
               top = fem::side_measure(d, d.mesh->side("top", "test"));
    EXPECT_NEAR(right.area, 2 * M_PI * 3 * 2, 1e-11);
    EXPECT_NEAR(top.area, M_PI * 8, 1e-11);
    EXPECT_LT(length(difference(top.normal, {0, 1, 0})), 1e-12);
    const Point force = fem::resultant(d, {"top", "top", field(7, -2)});
    EXPECT_EQ(force[0], 0);
    EXPECT_NEAR(force[1], -2 * M_PI * 8, 1e-11);
  }
}

TEST(Resultant, IsTheIntegralOfALoad)
{
  const auto d = body({{0, 0}, {5, 1}, {10, 2}, {2, 2}}, world());
  const Point of_top = fem::resultant(
      d, {"weight", "top", {ScalarField(3.), ScalarField("x", [](const Point &x) { return x[0]; }), {}}});
  EXPECT_NEAR(of_top[0], 15, 1e-12);
  EXPECT_NEAR(of_top[1], 12.5, 1e-12);
  const Point of_body = fem::resultant(d, field(0, -2));
  EXPECT_LT(length(difference(of_body, {0, -10, 0})), 1e-12);
}

} // namespace
} // namespace measure_test
