// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/parallel.hpp"
#include "run_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <string>
#include <tuple>
#include <vector>

/// What tests of friction share: scenes solved, and what their contact points bear on all ranks.
namespace rpc::test
{

using Assignments = std::vector<std::string>;

inline std::string friction_deck(const std::string &name)
{
  return std::string(RPC_TEST_DECKS) + "/friction_" + name + ".xml";
}

inline std::string text(const double value)
{
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.17g", value);
  return digits;
}

inline Assignments joined(Assignments a, const Assignments &b)
{
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The solvers' tolerances where two runs are compared.
inline const Assignments tight = {"Uzawa->Tolerance=1e-12", "NOX->Residual Tolerance=1e-13"};

/// Makes the column of friction_loop.xml a block in space, pressed on its back from the front.
inline const Assignments block_in_space = {
    "Mesh->Lower={0, 0, 0}", "Mesh->Upper={2, 1, 1}",  "Mesh->Cells={8, 4, 4}",   "Traction->left->X=0",
    "Traction->left->Y=0",   "Traction->right->X=0",   "Traction->right->Y=0",    "Dirichlet->top->Side=front",
    "Contact->Side=back",    "Steps->Times={1, 2, 3}", "Contact->Yield Stress=14"};

/// One of the decks friction_*.xml; it must converge.
inline Solution solved(const std::string &name, const Assignments &assignments = {})
{
  Solution s = run_scene(friction_deck(name), assignments);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_FALSE(s.failure) << s.failure->reason;
  return s;
}

/// The solutions of all its load steps.
inline std::vector<analysis::Solution> solved_steps(const std::string &name, const Assignments &assignments = {})
{
  std::vector<analysis::Solution> steps;
  std::ostream nowhere(nullptr);
  const Scene scene = read_scene(friction_deck(name), assignments);
  const Solution last = solve(scene, Tpetra::getDefaultComm(), nowhere, {},
                              [&](const Scene &, const analysis::Solution &s) { steps.push_back(s); });
  EXPECT_TRUE(last.uzawa.converged) << last.uzawa.reason;
  EXPECT_FALSE(last.failure) << last.failure->reason;
  EXPECT_EQ(steps.size(), scene.steps.times.size());
  return steps;
}

struct ContactPoint {
  std::array<double, 3> x{};
  double weight = 0, u_nu = 0, pressure = 0;
  std::array<double, 3> q{}, slip{}; ///< q: of the body on the foundation
  int state = 0, slip_state = 0;     ///< as in contact::ContactResult
  bool fixed = false;                ///< its normal displacement is prescribed

  double shear() const { return std::hypot(q[0], q[1], q[2]); }
};

/// Of all ranks, by their places.
inline std::vector<ContactPoint> contact_points(const analysis::Solution &s)
{
  const contact::ContactNodes &c = s.step.contact;
  const auto node = to_host(c.node);
  const auto weight = to_host(c.weight), p = to_host(s.contact.pressure), u_nu = to_host(s.contact.normal_displacement);
  const auto fixed = to_host(c.fixed);
  const auto x = to_host(s.discretization.mesh->coords);
  const auto q = to_host(s.contact.traction), e = to_host(s.contact.slip);
  const auto state = to_host(s.contact.state), slip_state = to_host(s.contact.slip_state);
  constexpr int width = 15;
  std::vector<double> mine;
  for (LO i = 0; i < c.size(); ++i) {
    const auto component = [&](const auto &field, const int k) {
      return k < c.dim && field.extent(0) > 0 ? field(i, k) : 0.;
    };
    for (int k = 0; k < 3; ++k) mine.push_back(k < c.dim ? x(node(i), k) : 0);
    mine.insert(mine.end(), {weight(i), u_nu(i), p(i)});
    for (int k = 0; k < 3; ++k) mine.push_back(component(q, k));
    for (int k = 0; k < 3; ++k) mine.push_back(component(e, k));
    mine.insert(mine.end(),
                {double(state(i)), slip_state.extent(0) > 0 ? double(slip_state(i)) : 0., double(fixed(i))});
  }
  const std::vector<double> all = gathered_by_all(s.discretization.mesh->comm(), mine);
  std::vector<ContactPoint> points;
  for (std::size_t i = 0; i < all.size(); i += width) {
    const double *const v = &all[i];
    points.push_back({{v[0], v[1], v[2]},
                      v[3],
                      v[4],
                      v[5],
                      {v[6], v[7], v[8]},
                      {v[9], v[10], v[11]},
                      static_cast<int>(v[12]),
                      static_cast<int>(v[13]),
                      v[14] != 0});
  }
  std::sort(points.begin(), points.end(),
            [](const ContactPoint &a, const ContactPoint &b) { return std::tie(a.x) < std::tie(b.x); });
  return points;
}

/// The largest difference of what the points bear, over the largest pressure; their order is the same.
inline double difference(const std::vector<ContactPoint> &a, const std::vector<ContactPoint> &b)
{
  EXPECT_EQ(a.size(), b.size());
  double worst = 0, scale = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    scale = std::max(scale, std::abs(b[i].pressure));
    worst = std::max(worst, std::abs(a[i].pressure - b[i].pressure));
    for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(a[i].q[k] - b[i].q[k]));
  }
  EXPECT_GT(scale, 0);
  return worst / scale;
}

/// How many of them stick, and slip, where they are pressed.
struct FrictionCounts {
  int stick = 0, slip = 0, forward = 0, backward = 0; ///< of those that slip, along x and against it
  int stick_open = 0, slip_open = 0;                  ///< where friction acts without pressure
};
inline FrictionCounts friction_counts(const std::vector<ContactPoint> &points)
{
  FrictionCounts n;
  for (const ContactPoint &point : points) {
    if (point.slip_state == 0) continue;
    const bool pressed = point.pressure > 0, sticks = point.slip_state == 1;
    ++(sticks ? (pressed ? n.stick : n.stick_open) : (pressed ? n.slip : n.slip_open));
    if (!sticks && pressed) ++(point.q[0] > 0 ? n.forward : n.backward);
  }
  return n;
}

} // namespace rpc::test
