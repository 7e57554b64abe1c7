#include "rpc/contact/law/rigid_plastic.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace
{

using namespace rpc::contact;
constexpr double inf = std::numeric_limits<double>::infinity();

// The paper's Xi(v) with l = lambda - xi/2, as printed there.
double paper_energy(const double v, const double l, const double r, const double xi)
{
  if (v < -(0.5 * xi + l) / r) return -0.5 * xi * v - std::pow(0.5 * xi + l, 2) / (2 * r);
  if (v <= (0.5 * xi - l) / r) return l * v + 0.5 * r * v * v;
  return 0.5 * xi * v - std::pow(0.5 * xi - l, 2) / (2 * r);
}

TEST(FoundationLaw, SmoothedEnergyIsThePapersWithItsLinearPart)
{
  const double xi = 3, r = 50;
  for (const double lambda : {0., 0.4, 1.5, 3.})
    for (double v = -0.2; v < 0.2; v += 0.0173)
      EXPECT_NEAR(smoothed_energy(v, lambda, r, xi), paper_energy(v, lambda - xi / 2, r, xi) + xi / 2 * v, 1e-14)
          << lambda << " " << v;
}

TEST(FoundationLaw, PressureIsTheDerivativeOfTheEnergyWithSecondOrderDifferences)
{
  const double xi = 3, r = 50, lambda = 1.2;
  // Inside the closed piece the energy is quadratic, central differences are exact; across a kink they are not: sample
  // beside it.
  for (const double v : {-0.1, -0.0245, -0.01, 0., 0.02, 0.0355, 0.1}) {
    const double h = 1e-4;
    const double slope = (smoothed_energy(v + h, lambda, r, xi) - smoothed_energy(v - h, lambda, r, xi)) / (2 * h);
    EXPECT_NEAR(slope, pressure(v, lambda, r, xi), 1e-10) << v;
  }
}

TEST(FoundationLaw, KinksLieWherePressureReachesZeroAndTheYieldLimit)
{
  const double xi = 3, r = 50, lambda = 1.2, eps = 1e-9;
  EXPECT_EQ(state(-lambda / r - eps, lambda, r, xi), State::open);
  EXPECT_EQ(state(-lambda / r + eps, lambda, r, xi), State::closed);
  EXPECT_EQ(state((xi - lambda) / r - eps, lambda, r, xi), State::closed);
  EXPECT_EQ(state((xi - lambda) / r + eps, lambda, r, xi), State::yielding);
  EXPECT_EQ(pressure(-1, lambda, r, xi), 0);
  EXPECT_EQ(pressure(1, lambda, r, xi), xi);
}

TEST(FoundationLaw, RigidFoundationNeverYields)
{
  EXPECT_EQ(state(1e6, 5, 1e8, inf), State::closed);
  EXPECT_EQ(pressure(2, 5, 10, inf), 25);
  EXPECT_EQ(pressure(-2, 5, 10, inf), 0);
  EXPECT_DOUBLE_EQ(smoothed_energy(2, 5, 10, inf), 5 * 2 + 0.5 * 10 * 4);
  EXPECT_EQ(plastic_energy(-0.5, inf), 0);
  EXPECT_EQ(plastic_energy(0.5, 4), 2);
  EXPECT_EQ(plastic_energy(-0.5, 4), 0);
}

TEST(FoundationLaw, BestMoveEndsWhereTheForceOfOnePointVanishes)
{
  const double r = 50, w = 0.3, stiffness = 2;
  for (const double xi : {3., inf})
    for (const double lambda : {0., 1.2, 3.})
      for (const double v : {-0.5, -0.01, 0., 0.01, 0.5})
        for (const double slope : {-10., -0.5, -0.1, 0., 0.7, 9.}) {
          const double s = best_move(slope, stiffness, w, v, lambda, r, xi);
          EXPECT_NEAR(slope + stiffness * s + w * pressure(v + s, lambda, r, xi), 0, 1e-13) << v << " " << slope;
        }
}

} // namespace
