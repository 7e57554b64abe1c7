// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/rounding.hpp"

#include "bodies.hpp"

namespace rounding_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr fem::Material steel{2000, 0.3};

double strain_energy(const fem::Discretization &d, const Vector &u)
{
  return fem::internal_work(d, steel, u).energy_norm_squared;
}

TEST(RoundingEnergy, HoldsTheStrainEnergyOfRigidMotionsThatSolvesLeave)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    for (const double size : {1e-6, 1., 1e6}) {
      const auto u = interpolate(d, [&](const Point &x) {
        const Point wobble{std::sin(37 * x[0]), std::cos(91 * x[1]), std::sin(53 * x[1] + x[0])}; // of a solve
        return Point{size * (3 - x[1] + 1e-12 * wobble[0]), size * (x[0] - 5 + 1e-12 * wobble[1]),
                     size * 1e-12 * wobble[2]};
      });
      EXPECT_GT(strain_energy(d, *u), 0);
      EXPECT_LT(strain_energy(d, *u), fem::rounding_energy(d, steel, *u));
    }
  }
}

TEST(RoundingEnergy, HoldsRotationsFarFromTheOrigin)
{
  const double far = 1e7;
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    mesh::BoxOptions box = small_box(element);
    for (int i = 0; i < element.dim; ++i) {
      box.lower[i] += far;
      box.upper[i] += far;
    }
    const auto d = body(box, world());
    const auto u = interpolate(d, [&](const Point &x) { return Point{-0.01 * (x[1] - far), 0.01 * (x[0] - far)}; });
    EXPECT_LT(strain_energy(d, *u), fem::rounding_energy(d, steel, *u));
    // And it hides no strain that is a ten-thousandth of the rotation.
    const auto strained = interpolate(d, [&](const Point &x) {
      return Point{-0.01 * (x[1] - far) + 1e-6 * (x[0] - far), 0.01 * (x[0] - far)};
    });
    EXPECT_GT(strain_energy(d, *strained), 10 * fem::rounding_energy(d, steel, *strained));
  }
}

TEST(RoundingEnergy, IsFarBelowTheEnergyOfAStrainHoweverSmall)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    for (const double size : {1e-100, 1e-12, 1.}) {
      const auto u = interpolate(d, [&](const Point &x) { return Point{size * x[0] * x[1], size * x[1] * x[1]}; });
      EXPECT_LT(fem::rounding_energy(d, steel, *u), 1e-15 * strain_energy(d, *u)) << size;
    }
    // On top of a translation that is a million times larger.
    const auto u = interpolate(d, [&](const Point &x) { return Point{1e6 + x[0] * x[1], 1e6 + x[1] * x[1]}; });
    EXPECT_LT(fem::rounding_energy(d, steel, *u), 1e-6 * strain_energy(d, *u));
  }
}

TEST(RoundingEnergy, ScalesWithUnitsAsEnergiesDo)
{
  const double length = 1e-3, stress = 1e9;
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    mesh::BoxOptions box = small_box(element), small = box;
    for (int i = 0; i < element.dim; ++i) {
      small.lower[i] *= length;
      small.upper[i] *= length;
    }
    const auto d = body(box, world()), scaled = body(small, world());
    const auto field = [](const Point &x) { return Point{x[0] * x[1], x[1] * x[1]}; };
    const auto u = interpolate(d, field);
    const auto v = interpolate(scaled, [&](const Point &x) {
      const Point at = field({x[0] / length, x[1] / length, x[2] / length});
      return Point{length * at[0], length * at[1]};
    });
    const double expected = stress * std::pow(length, element.dim) * fem::rounding_energy(d, steel, *u);
    EXPECT_NEAR(fem::rounding_energy(scaled, fem::Material{stress * 2000, 0.3}, *v) / expected, 1, 1e-9);
  }
}

} // namespace
} // namespace rounding_test
