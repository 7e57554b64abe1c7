// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/law/foundation.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

namespace foundation_test
{
namespace
{

using namespace rpc::contact;
constexpr double inf = std::numeric_limits<double>::infinity();

/// Perfectly plastic, hardening, elastic, both, and each with a foundation that never yields.
std::vector<Foundation> all_laws()
{
  return {{3}, {3, 7}, {3, 0, 0.02}, {3, 7, 0.02}, {inf}, {inf, 0, 0.02}};
}
std::string name(const Foundation &f)
{
  return "xi " + std::to_string(f.yield) + ", H " + std::to_string(f.hardening) + ", c " + std::to_string(f.compliance);
}

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
      EXPECT_NEAR(smoothed_energy(v, lambda, r, {xi}), paper_energy(v, lambda - xi / 2, r, xi) + xi / 2 * v, 1e-14)
          << lambda << " " << v;
}

// The law as it is where nothing but a yield stress is known: (3.1) to (3.3) and (4.5) in their shortest form.
namespace shortest
{
double pressure(const double v, const double lambda, const double r, const double xi)
{
  return clamp(lambda + r * v, 0, xi);
}
double smoothed_energy(const double v, const double lambda, const double r, const double xi)
{
  const double z = lambda + r * v;
  if (z < 0) return -lambda * lambda / (2 * r);
  if (z <= xi) return v * (lambda + 0.5 * r * v);
  return xi * v - (xi - lambda) * (xi - lambda) / (2 * r);
}
State state(const double v, const double lambda, const double r, const double xi)
{
  const double z = lambda + r * v;
  return z < 0 ? State::open : (z > xi ? State::yielding : State::closed);
}
double best_move(const double slope, const double stiffness, const double w, const double v, const double lambda,
                 const double r, const double xi)
{
  const double open = -slope / stiffness;
  if (lambda + r * (v + open) < 0) return open;
  if (!is_rigid(xi)) {
    const double yielding = -(slope + w * xi) / stiffness;
    if (lambda + r * (v + yielding) > xi) return yielding;
  }
  return -(slope + w * (lambda + r * v)) / (stiffness + w * r);
}
double plastic_energy(const double v, const double xi)
{
  return v > 0 ? xi * v : 0;
}
} // namespace shortest

TEST(FoundationLaw, WithAYieldStressAloneIsThePapersToTheLastBit)
{
  int pieces[3] = {0, 0, 0};
  for (const double xi : {1e-7, 0.3, 3., 1.7e9, inf})
    for (const double r : {0.7, 50., 1.3e11})
      for (const double part : {0., 0.1, 1 / 3., 1.}) {
        const double pressure_scale = std::isfinite(xi) ? xi : 5., lambda = part * pressure_scale;
        for (double z = -1.03; z < 2.5; z += 0.0917) {
          const double v = z * pressure_scale / r;
          const Foundation f{xi};
          ++pieces[static_cast<int>(state(v, lambda, r, f))];
          ASSERT_EQ(state(v, lambda, r, f), shortest::state(v, lambda, r, xi));
          ASSERT_EQ(pressure(v, lambda, r, f), shortest::pressure(v, lambda, r, xi));
          ASSERT_EQ(smoothed_energy(v, lambda, r, f), shortest::smoothed_energy(v, lambda, r, xi));
          ASSERT_EQ(foundation_energy(v, f), shortest::plastic_energy(v, xi));
          for (const double slope : {-2.1, 0.3}) {
            const double force = 0.2 * slope * pressure_scale, stiffness = 0.11 * r;
            ASSERT_EQ(best_move(force, stiffness, 0.2, v, lambda, r, f),
                      shortest::best_move(force, stiffness, 0.2, v, lambda, r, xi));
          }
        }
      }
  for (const int visits : pieces) EXPECT_GT(visits, 100);
}

TEST(FoundationLaw, KinksLieWherePressureReachesZeroAndTheYieldLimit)
{
  const double r = 50, lambda = 1.2, eps = 1e-9;
  for (const Foundation &f : {Foundation{3}, {3, 7}, {3, 0, 0.02}, {3, 7, 0.02}}) {
    // lambda + r v = (1 + r c) xi
    const double opens = -lambda / r, yields = ((1 + r * f.compliance) * 3 - lambda) / r;
    EXPECT_EQ(state(opens - eps, lambda, r, f), State::open) << name(f);
    EXPECT_EQ(state(opens + eps, lambda, r, f), State::closed) << name(f);
    EXPECT_EQ(state(yields - eps, lambda, r, f), State::closed) << name(f);
    EXPECT_EQ(state(yields + eps, lambda, r, f), State::yielding) << name(f);
    EXPECT_NEAR(pressure(opens + eps, lambda, r, f), 0, 2 * r * eps) << name(f);
    EXPECT_NEAR(pressure(yields, lambda, r, f), 3, 1e-13) << name(f);
  }
  EXPECT_EQ(pressure(-1, lambda, r, {3}), 0);
  EXPECT_EQ(pressure(1, lambda, r, {3}), 3);
}

TEST(FoundationLaw, RigidFoundationNeverYields)
{
  EXPECT_EQ(state(1e6, 5, 1e8, {inf}), State::closed);
  EXPECT_EQ(pressure(2, 5, 10, {inf}), 25);
  EXPECT_EQ(pressure(-2, 5, 10, {inf}), 0);
  EXPECT_DOUBLE_EQ(smoothed_energy(2, 5, 10, {inf}), 5 * 2 + 0.5 * 10 * 4);
  EXPECT_EQ(foundation_energy(-0.5, {inf}), 0);
  EXPECT_EQ(foundation_energy(0.5, {4}), 2);
  EXPECT_EQ(foundation_energy(-0.5, {4}), 0);
}

TEST(FoundationLaw, NumbersOfEachPieceByHand)
{
  const double r = 50, lambda = 1.5;
  const Foundation hardening{3, 10}, elastic{3, 0, 0.02}, both{3, 10, 0.02}; // 1 + r c = 2
  // z = lambda + r v = 8.5 at v = 0.14
  EXPECT_NEAR(pressure(0.14, lambda, r, hardening), 3 + 10 * 5.5 / 60, 1e-14); // beyond xi: 5.5
  EXPECT_EQ(pressure(0.14, lambda, r, elastic), 3);
  EXPECT_NEAR(pressure(0.14, lambda, r, both), 3 + 10 * 2.5 / 70, 1e-14); // beyond 2 xi: 2.5
  EXPECT_NEAR(branch_stiffness(State::yielding, r, hardening), 50 * 10 / 60., 1e-13);
  EXPECT_EQ(branch_stiffness(State::yielding, r, elastic), 0);
  EXPECT_NEAR(branch_stiffness(State::yielding, r, both), 50 * 10 / 70., 1e-13);
  // z = 4 at v = 0.05: beyond xi, but not beyond 2 xi
  EXPECT_NEAR(pressure(0.05, lambda, r, hardening), 3 + 10 * 1 / 60., 1e-14);
  EXPECT_NEAR(pressure(0.05, lambda, r, elastic), 2, 1e-14);
  EXPECT_NEAR(pressure(0.05, lambda, r, both), 2, 1e-14);
  EXPECT_EQ(branch_stiffness(State::closed, r, hardening), 50);
  EXPECT_EQ(branch_stiffness(State::closed, r, elastic), 25);
  EXPECT_EQ(branch_stiffness(State::closed, r, both), 25);
  for (const Foundation &f : {hardening, elastic, both}) {
    EXPECT_EQ(pressure(-0.1, lambda, r, f), 0);
    EXPECT_EQ(branch_stiffness(State::open, r, f), 0);
  }
}

TEST(FoundationLaw, LawItselfByHand)
{
  // The foundation's spring takes up c xi = 0.06, then in series 1/50 + 1/10: slope 50/6.
  const Foundation both{3, 10, 0.02};
  EXPECT_EQ(elastic_limit(both), 0.06);
  EXPECT_NEAR(pressure_at(0.03, both), 1.5, 1e-15);
  EXPECT_NEAR(pressure_at(0.12, both), 3 + 0.06 * 50 / 6, 1e-14);
  EXPECT_NEAR(foundation_energy(0.03, both), 0.5 * 0.03 * 1.5, 1e-15);
  EXPECT_NEAR(foundation_energy(0.12, both), 0.5 * 0.06 * 3 + 0.06 * 3 + 0.5 * 0.06 * 0.06 * 50 / 6, 1e-14);
  EXPECT_NEAR(new_dent(0.12, 3.5, both), 0.12 - 0.07, 1e-16); // xi + H w = 3.5
  EXPECT_EQ(new_dent(0.05, 2.5, both), 0);
  EXPECT_NEAR(dissipation(0.05, 3.5, both), 3 * 0.05 + 0.5 * 10 * 0.05 * 0.05, 1e-15);
  EXPECT_NEAR(conjugate_energy(3.5, both), 0.5 * 0.02 * 3.5 * 3.5 + 0.5 * 0.25 / 10, 1e-15);
  EXPECT_EQ(conjugate_energy(2, {3}), 0);
  EXPECT_EQ(pressure_at(0.12, {3}), 3);
  EXPECT_EQ(pressure_at(0., {3}), 0);
  EXPECT_NEAR(pressure_at(0.12, {inf, 0, 0.02}), 6, 1e-14); // Winkler's
  EXPECT_EQ(pressure_at(-0.12, {inf, 0, 0.02}), 0);
  EXPECT_EQ(new_dent(0.12, 6, {inf, 0, 0.02}), 0);
  EXPECT_EQ(new_dent(0.3, 3, {3}), 0.3);
  EXPECT_EQ(new_dent(0.3, 2.9, {3}), 0);
  EXPECT_EQ(new_dent(-0.3, 3, {3}), 0);
  EXPECT_EQ(dissipation(0.3, 3, {3}), 3 * 0.3);
}

TEST(FoundationLaw, AdmitsPressuresThatSomePenetrationHas)
{
  for (const Foundation &f : all_laws()) {
    EXPECT_EQ(admissible(-1, f), 0) << name(f);
    EXPECT_EQ(admissible(2, f), 2) << name(f);
    EXPECT_EQ(admissible(4, f), std::isfinite(f.yield) && f.hardening == 0 ? 3 : 4) << name(f);
  }
}

/// Places on all pieces, with their kinks in between.
std::vector<double> places(const double lambda, const double r, const Foundation &f)
{
  const double yield = std::isfinite(f.yield) ? f.yield : 5, opens = -lambda / r,
               yields = (softening(r, f) * yield - lambda) / r;
  return {opens - 0.07,   opens - 0.003,  opens + 0.003, 0.5 * (opens + yields),
          yields - 0.003, yields + 0.003, yields + 0.11};
}

TEST(FoundationLaw, PressureIsTheDerivativeOfTheEnergyOnEachPieceAndStiffnessThatOfPressure)
{
  const double r = 50, h = 1e-4; // keeps to a piece, where differences of a quadratic are exact
  for (const Foundation &f : all_laws())
    for (const double lambda : {0., 1.2, 3.})
      for (const double v : places(lambda, r, f)) {
        const double energy_slope =
            (smoothed_energy(v + h, lambda, r, f) - smoothed_energy(v - h, lambda, r, f)) / (2 * h);
        EXPECT_NEAR(energy_slope, pressure(v, lambda, r, f), 1e-10) << name(f) << " " << v;
        const double pressure_slope = (pressure(v + h, lambda, r, f) - pressure(v - h, lambda, r, f)) / (2 * h);
        EXPECT_NEAR(pressure_slope, branch_stiffness(state(v, lambda, r, f), r, f), 1e-9) << name(f) << " " << v;
      }
}

TEST(FoundationLaw, AcrossKinksDifferencesOfTheEnergyConvergeAtFirstOrder)
{
  // Central differences about a kink miss the pressure by (jump of stiffness) h/4.
  const double r = 50, lambda = 1.2;
  for (const Foundation &f : {Foundation{3}, {3, 7}, {3, 0, 0.02}, {3, 7, 0.02}}) {
    const double kinks[] = {-lambda / r, (softening(r, f) * f.yield - lambda) / r};
    const double closed = branch_stiffness(State::closed, r, f),
                 jumps[] = {closed, branch_stiffness(State::yielding, r, f) - closed};
    for (int k = 0; k < 2; ++k)
      for (const double h : {1e-3, 5e-4, 2.5e-4}) {
        const double v = kinks[k],
                     slope = (smoothed_energy(v + h, lambda, r, f) - smoothed_energy(v - h, lambda, r, f)) / (2 * h);
        EXPECT_NEAR(slope - pressure(v, lambda, r, f), 0.25 * jumps[k] * h, 1e-6 * std::abs(jumps[k]) * 1e-3)
            << name(f) << " kink " << k;
      }
  }
}

TEST(FoundationLaw, EnergyAndPressureAreContinuousAtBothKinks)
{
  for (const double r : {0.7, 50., 1e8})
    for (const Foundation &f : all_laws())
      for (const double lambda : {0., 1.2, 3.}) {
        const double scale = std::isfinite(f.yield) ? f.yield : 5;
        for (const double kink : {-lambda / r, (softening(r, f) * f.yield - lambda) / r}) {
          if (!std::isfinite(kink)) continue;
          const double below = kink - 1e-12 / r, above = kink + 1e-12 / r;
          EXPECT_NE(state(kink - 1e-6 / r, lambda, r, f), state(kink + 1e-6 / r, lambda, r, f)) << name(f);
          EXPECT_NEAR(pressure(below, lambda, r, f), pressure(above, lambda, r, f), 1e-11) << name(f) << " " << kink;
          EXPECT_NEAR(smoothed_energy(below, lambda, r, f), smoothed_energy(above, lambda, r, f),
                      1e-11 * scale * (std::abs(kink) + scale / r))
              << name(f) << " " << kink;
        }
      }
}

TEST(FoundationLaw, BestMoveEndsWhereTheForceOfOnePointVanishes)
{
  const double r = 50, w = 0.3, stiffness = 2;
  int ends[3] = {0, 0, 0};
  for (const Foundation &f : all_laws())
    for (const double lambda : {0., 1.2, 3.})
      for (const double v : {-0.5, -0.01, 0., 0.01, 0.5})
        for (const double slope : {-10., -0.9, -0.5, -0.1, 0., 0.7, 9.}) {
          const double s = best_move(slope, stiffness, w, v, lambda, r, f);
          EXPECT_NEAR(slope + stiffness * s + w * pressure(v + s, lambda, r, f), 0, 2e-13)
              << name(f) << " " << v << " " << slope;
          ++ends[static_cast<int>(state(v + s, lambda, r, f))];
        }
  for (const int count : ends) EXPECT_GT(count, 20);
}

TEST(FoundationLaw, EnergyAndConjugateMeetWhereTheLawHoldsAndNowhereElse)
{
  for (const Foundation &f : all_laws())
    for (double v = -0.2; v < 0.5; v += 0.0317) {
      if (f.compliance == 0 && std::isinf(f.yield) && v > 0) continue; // no pressure stops there
      const double obeys = pressure_at(v, f);
      EXPECT_NEAR(foundation_energy(v, f) + conjugate_energy(obeys, f) - obeys * v, 0, 1e-14) << name(f) << " " << v;
      for (double p = 0; p < 9; p += 0.217) {
        if (p != admissible(p, f)) continue;
        const double gap = foundation_energy(v, f) + conjugate_energy(p, f) - p * v;
        EXPECT_GE(gap, -1e-14) << name(f) << " " << v << " " << p;
        if (std::abs(p - obeys) > 0.01) {
          EXPECT_GT(gap, 1e-7) << name(f) << " " << v << " " << p;
        }
      }
    }
}

TEST(FoundationLaw, ConjugateIsTheSupremumOverPenetrations)
{
  for (const Foundation &f : all_laws())
    for (const double p : {0., 0.4, 2.9, 3., 3.4, 6.}) {
      if (p != admissible(p, f)) continue;
      double most = 0, error = 0; // v = 0 gives 0
      const double step = 1e-4;
      for (double v = -0.01; v < 1; v += step)
        if (std::isfinite(foundation_energy(v, f))) most = std::max(most, p * v - foundation_energy(v, f));
      // concave, with at most the closed slope: the largest value between two places is that near the largest of the places
      if (f.compliance > 0) error = 0.5 * step * step / f.compliance;
      if (f.hardening > 0) error = std::max(error, 0.5 * step * step * f.hardening);
      EXPECT_NEAR(conjugate_energy(p, f), most, error + 1e-14) << name(f) << " " << p;
    }
}

TEST(FoundationLaw, PressureAtAPenetrationIsTheDerivativeOfTheEnergy)
{
  const double h = 1e-5;
  for (const Foundation &f : all_laws())
    for (const double v : {-0.3, 0.01, 0.0517, 0.0701, 0.4}) {
      if (f.compliance == 0 && std::isinf(f.yield) && v > 0) continue;
      EXPECT_NEAR((foundation_energy(v + h, f) - foundation_energy(v - h, f)) / (2 * h), pressure_at(v, f), 1e-9)
          << name(f) << " " << v;
    }
}

TEST(FoundationLaw, NewDentBringsTheYieldLimitToThePressureAndTheRestIsInTheSpring)
{
  for (const Foundation &f : all_laws())
    for (const double v : {-0.1, 0.013, 0.059, 0.061, 0.2, 0.7}) {
      if (f.compliance == 0 && std::isinf(f.yield) && v > 0) continue;
      const double p = pressure_at(v, f), w = new_dent(v, p, f);
      EXPECT_GE(w, 0) << name(f);
      EXPECT_LE(p, (f.yield + f.hardening * w) * (1 + 1e-14)) << name(f);
      if (v > 0) {
        EXPECT_NEAR(w + f.compliance * p, v, 1e-15) << name(f) << " " << v;
      }
      // What pressing in took is in the spring, or lost.
      EXPECT_NEAR(foundation_energy(v, f), 0.5 * f.compliance * p * p + dissipation(w, p, f), 1e-14) << name(f);
      // Pressed again, as far as it is, it gives way no further.
      const Foundation after{f.yield + f.hardening * w, f.hardening, f.compliance};
      EXPECT_NEAR(new_dent(v - w, p, after), 0, 1e-16) << name(f);
      if (f.compliance > 0) {
        EXPECT_NEAR(pressure_at(v - w, after), p, 1e-13) << name(f);
      }
    }
}

TEST(FoundationLaw, MultiplierUpdatesAtAGivenPenetrationLeadToTheLaw)
{
  const double r = 50;
  for (const Foundation &f : all_laws())
    for (const double start : {0., 1.3, 3.})
      for (const double v : {-0.2, 0.011, 0.055, 0.07, 0.3}) {
        if (f.compliance == 0 && std::isinf(f.yield) && v > 0) continue; // grows by r v each time
        double lambda = start;
        for (int k = 0; k < 300; ++k) lambda = pressure(v, lambda, r, f);
        EXPECT_NEAR(lambda, pressure_at(v, f), 1e-12) << name(f) << " " << v;
        EXPECT_EQ(lambda, admissible(lambda, f)) << name(f) << " " << v;
      }
}

} // namespace
} // namespace foundation_test
