// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/parallel.hpp"
#include "run_scene.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

// input/track.xml: a half cylinder presses a dent into the foundation, is moved along by 0.7, and presses another one beside it.

namespace track_test
{
namespace
{

using namespace rpc;

constexpr double moved = 0.7;

/// What contact nodes meet by where they are in the mesh, or stand along the foundation, on all ranks.
std::map<double, double> dents_met(const analysis::Solution &s, const bool as_they_stand = false)
{
  const contact::ContactNodes &points = s.step.contact;
  const auto node = to_host(points.node);
  const auto coords = to_host(s.discretization.mesh->coords);
  const auto dent = to_host(s.contact.dent);
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<double> x, w;
  for (LO i = 0; i < points.size(); ++i) {
    x.push_back(coords(node(i), 0) + (as_they_stand ? u(2 * node(i), 0) : 0));
    w.push_back(dent(i));
  }
  const Comm &comm = s.discretization.mesh->comm();
  x = gathered_by_all(comm, x);
  w = gathered_by_all(comm, w);
  std::map<double, double> dents;
  for (std::size_t i = 0; i < x.size(); ++i) dents[x[i]] = w[i];
  return dents;
}

double between(const std::map<double, double> &dents, const double x)
{
  const auto after = dents.lower_bound(x), before = std::prev(after);
  return before->second + (x - before->first) / (after->first - before->first) * (after->second - before->second);
}

/// Half the width of a dent about x = 0.
double reach(const std::map<double, double> &dents)
{
  double reach = 0;
  for (const auto &[x, w] : dents)
    if (w > 0) reach = std::max(reach, std::abs(x));
  return reach;
}

/// Solutions by their times.
std::map<double, analysis::Solution> track(const std::vector<std::string> &assignments = {})
{
  std::map<double, analysis::Solution> steps;
  std::ostream nowhere(nullptr);
  const auto scene = read_scene(std::string(RPC_TEST_DECKS) + "/../../../input/track.xml", assignments);
  solve(scene, Tpetra::getDefaultComm(), nowhere, {}, [&](const Scene &, const analysis::Solution &s) {
    EXPECT_TRUE(s.uzawa.converged) << s.time << ": " << s.uzawa.reason;
    steps[s.time] = s;
  });
  return steps;
}

TEST(Track, OfTheFirstDentStaysWhereTheSecondDoesNotReach)
{
  const auto steps = track();
  const auto first = dents_met(steps.at(2)), in_place = dents_met(steps.at(3)), both = dents_met(steps.at(5));
  const double width = reach(first);
  EXPECT_GT(width, 0.8);
  EXPECT_LT(width, 1.1);
  EXPECT_GT(moved, 0.6 * width) << "the first dent reaches beyond the second one";
  EXPECT_LT(moved, 2 * width) << "they overlap";
  int beside = 0, under = 0;
  for (const auto &[x, w] : both) {
    if (x + moved > first.rbegin()->first) continue;
    const double before = in_place.at(x);
    EXPECT_NEAR(before, between(first, x + moved), 2e-4) << "points stand between those of the first dent";
    EXPECT_GE(w, before - 1e-12);
    if (x < -1.05 * width) {
      EXPECT_NEAR(w, before, 1e-12) << x;
      beside += w > 0;
    } else if (std::abs(x) < 0.3 * width) {
      EXPECT_GT(w, before + 0.005) << x;
      ++under;
    }
  }
  EXPECT_GT(beside, 0);
  EXPECT_GT(under, 5);
  // Lifted off, points come back by the strain of the body's surface: to other places on the same dents.
  const auto pressed = dents_met(steps.at(4)), stood_on = dents_met(steps.at(4), true);
  const auto foundation = dents_met(steps.at(5), true);
  double off = 0, off_at_points = 0;
  for (const auto &[y, w] : stood_on)
    if (y > foundation.begin()->first) off += std::abs(w - between(foundation, y));
  for (const auto &[x, w] : pressed) off_at_points += std::abs(w - both.at(x));
  EXPECT_GT(off_at_points, 0);
  EXPECT_LT(off, 0.5 * off_at_points);
}

TEST(Track, BesideADentNeedsLessForce)
{
  const auto steps = track();
  const auto at = [&](const double t) -> const contact::ContactSums & { return steps.at(t).contact.total; };
  EXPECT_NEAR(at(1).force[1], 61.79, 0.1);
  EXPECT_NEAR(at(4).force[1], 47.80, 0.2);
  EXPECT_NEAR(at(2).dent_volume, 0.0721, 0.0005);
  EXPECT_NEAR(at(5).dent_volume, 0.1183, 0.0008);
  EXPECT_EQ(at(2).dent_volume, at(3).dent_volume);
  EXPECT_EQ(at(4).dent_volume, at(5).dent_volume);
  EXPECT_EQ(at(3).max_pressure, 0);
  EXPECT_GT(at(5).max_dent, 1.1 * at(2).max_dent);
  // Plastic work is the yield stress times the volume, up to the strain of the body's surface.
  const auto &last = steps.at(5).history.back();
  EXPECT_NEAR(last.energies.dissipated, 30 * at(5).dent_volume, 0.01 * last.energies.dissipated);
}

TEST(Track, WithDentsThatMoveWithTheBodyIsTheFirstDentAgain)
{
  const auto steps = track({"Contact->Dents Move With=body"});
  const auto &first = steps.at(2).contact.total, &last = steps.at(5).contact.total;
  EXPECT_NEAR(first.dent_volume, 0.0721, 0.0005);
  EXPECT_NEAR(last.dent_volume, first.dent_volume, 1e-8 * first.dent_volume);
}

} // namespace
} // namespace track_test
