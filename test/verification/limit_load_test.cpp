// SPDX-License-Identifier: BSD-3-Clause
// Bodies that contact alone holds, just inside and just outside of what the foundation carries.

#include "expect_error.hpp"
#include "run_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

namespace limit_load_test
{
namespace
{

using namespace rpc;
using Assignments = std::vector<std::string>;

const std::string block = std::string(RPC_TEST_DECKS) + "/block.xml";

std::string text(const double value, const char *format = "%.17g")
{
  char digits[32];
  std::snprintf(digits, sizeof digits, format, value);
  return digits;
}

/// block.xml with the usual tolerances, and more.
Assignments block_with(const std::string &element, const Assignments &more)
{
  Assignments scene = {"Mesh->Element=" + element, "Uzawa->Tolerance=1e-8", "NOX->Step Tolerance=1e-10",
                       "NOX->Residual Tolerance=1e-11", "Linear Solver->Tolerance=1e-8"};
  scene.insert(scene.end(), more.begin(), more.end());
  return scene;
}

void expect_solved(const Solution &s, const double load)
{
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_LE(s.uzawa.residuals.worst(), 1e-8);
  EXPECT_NEAR(s.contact.total.force[1], load, 1e-8 * load);
  EXPECT_TRUE(s.step.support.by_contact_only);
}

class LimitLoad : public testing::TestWithParam<const char *>
{
};
INSTANTIATE_TEST_SUITE_P(Elements, LimitLoad, testing::Values("Q1", "P1", "Q2", "P2"));

// Between rollers the block may only sink.
TEST_P(LimitLoad, OfABlockBetweenRollersIsTheIntegralOfTheYieldStress)
{
  for (const auto &foundation : {std::pair("10", 10.), std::pair("1+x", 1.5)}) {
    const std::string xi = foundation.first;
    const double carries = foundation.second;
    const auto loaded = [&](const double share) {
      return block_with(GetParam(), {"Contact->Yield Stress=" + xi, "Traction->top->Y=" + text(-share * carries)});
    };
    for (const double share : {0.99, 0.9999}) {
      SCOPED_TRACE(xi + (" " + text(share, "%g")));
      expect_solved(run_scene(block, loaded(share)), share * carries);
    }
    test::expect_error(ExitCode::no_solution,
                       {"with a resultant of " + text(1.01 * carries, "%g") + " [N/m]",
                        "carries at most " + text(carries, "%g") + " [N/m]"},
                       [&] { run_scene(block, loaded(1.01)); });
  }
}

TEST(LimitLoad3d, OfABlockBetweenRollersIsTheIntegralOfTheYieldStress)
{
  const double carries = 15;
  const auto loaded = [&](const double share) {
    return block_with("Q1", {"Mesh->Lower={0, 0, 0}", "Mesh->Upper={1, 1, 1}", "Mesh->Cells={5, 4, 3}",
                             "Dirichlet->back->Z=0", "Dirichlet->front->Z=0", "Contact->Yield Stress=10+6*x+4*z",
                             "Traction->top->Y=" + text(-share * carries)});
  };
  for (const double share : {0.99, 0.9999}) {
    SCOPED_TRACE(share);
    expect_solved(run_scene(block, loaded(share)), share * carries);
  }
  test::expect_error(ExitCode::no_solution, {"with a resultant of 15.15 [N]", "carries at most 15 [N]"},
                     [&] { run_scene(block, loaded(1.01)); });
}

/// What a foundation of yield stress xi under (0, 1) can do against a load P: the largest moment about the middle, and
/// the node about which more of it tilts the block.
struct Moment {
  double limit;   ///< [N m/m]
  double about;   ///< x [m]
  double carried; ///< about that node [N m/m]
};

/// All nodes from the right end on yield, one carries the rest of the load: a corner of Z, or on an edge of it.
Moment largest_moment(const std::vector<double> &weight, const double xi, const double load)
{
  const int last = static_cast<int>(weight.size()) - 1;
  Moment found{};
  double left = load;
  std::vector<double> force(weight.size());
  int k = last;
  for (; xi * weight[k] < left; --k) left -= force[k] = xi * weight[k];
  force[k] = left;
  found.about = double(k) / last;
  for (int i = 0; i <= last; ++i) {
    found.limit += force[i] * (double(i) / last - 0.5);
    found.carried += force[i] * (double(i) / last - found.about);
  }
  return found;
}

/// Weights of the rule whose points are the nodes: trapezoids or Simpson's.
std::vector<double> weights(const int cells, const int order)
{
  const double h = 1. / cells;
  std::vector<double> w(order * cells + 1, 0.);
  for (int c = 0; c < cells; ++c)
    for (int a = 0; a <= order; ++a) w[order * c + a] += order == 1 ? h / 2 : (a == 1 ? 4 * h / 6 : h / 6);
  return w;
}

// The bottom's X alone is held: the block may sink, and tilt about any point of its bottom.
TEST_P(LimitLoad, OfABlockThatMayTiltIsAMomentToo)
{
  const int cells = 10, order = GetParam()[1] - '0';
  const double load = 4, xi = 10;
  const Moment moment = largest_moment(weights(cells, order), xi, load);
  const auto loaded = [&](const std::string &xi, const double about_the_middle) {
    return block_with(GetParam(), {"Mesh->Cells={" + std::to_string(cells) + ",6}", "Dirichlet->left->Side=bottom",
                                   "Dirichlet->right->Side=bottom", "Contact->Yield Stress=" + xi,
                                   "Traction->top->Y=" + text(-load) + "-" + text(12 * about_the_middle) + "*(x-0.5)"});
  };
  for (const double share : {0.99, 0.9999}) {
    SCOPED_TRACE(share);
    expect_solved(run_scene(block, loaded(text(xi), share * moment.limit)), load);
    SCOPED_TRACE("rigid");
    expect_solved(run_scene(block, loaded("inf", share * load / 2)), load);
  }
  const double turning = 1.01 * moment.limit + load * (0.5 - moment.about);
  const std::string place = "about (" + text(moment.about, "%g") + ", 0), clockwise";
  test::expect_error(ExitCode::no_solution,
                     {place, "with a moment of " + text(turning, "%g") + " [N m/m]",
                      "carries at most " + text(moment.carried, "%g") + " [N m/m]"},
                     [&] { run_scene(block, loaded(text(xi), 1.01 * moment.limit)); });
  test::expect_error(ExitCode::no_solution,
                     {"away from the foundation: about (1, 0), clockwise", "its moment is 0.02 [N m/m]"},
                     [&] { run_scene(block, loaded("inf", 1.01 * load / 2)); });
}

TEST_P(LimitLoad, BlockAboveItsFoundationFallsOnItAndIsCompressed)
{
  const double p = 4, gap = 0.1, nu = 0.3, modulus = 2000 * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  for (const char *xi : {"4.001", "10", "inf"}) {
    SCOPED_TRACE(xi);
    const Solution s =
        run_scene(block, {std::string("Mesh->Element=") + GetParam(), std::string("Contact->Yield Stress=") + xi,
                          "Contact->Gap=0.1", "Uzawa->Tolerance=1e-11"});
    expect_solved(s, p);
    const auto x = to_host(s.discretization.mesh->coords);
    const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto pressure = to_host(s.contact.pressure);
    const double exact = 1e-11;
    for (LO n = 0; n < s.discretization.mesh->num_owned_nodes(); ++n) {
      EXPECT_NEAR(u(2 * n, 0), 0, exact * gap);
      EXPECT_NEAR(u(2 * n + 1, 0), -gap - p / modulus * x(n, 1), exact * gap);
    }
    for (std::size_t i = 0; i < pressure.extent(0); ++i) EXPECT_NEAR(pressure(i), p, 1e-9 * p);
    EXPECT_NEAR(s.energy, -p * gap - 0.5 * p * p / modulus, exact * p * gap);
  }
}

// Two slanted foundations of 5 Pa along 1 m each, 0.6 of which is upwards, carry 6 N/m of the load's 4 N/m.
TEST(Wedge, BetweenSlantedFoundationsIsHeldByBoth)
{
  for (const char *xi : {"5", "inf"}) {
    SCOPED_TRACE(xi);
    const Solution s =
        run_scene(std::string(RPC_TEST_DECKS) + "/vee.xml", {std::string("Contact->Sides->left->Yield Stress=") + xi,
                                                             std::string("Contact->Sides->right->Yield Stress=") + xi});
    expect_solved(s, 4);
    ASSERT_EQ(s.contact.sides.size(), 2u);
    for (const auto &side : s.contact.sides) EXPECT_NEAR(side.force[1], 2, 1e-8 * 2);
    EXPECT_NEAR(s.contact.sides[0].force[0], 8 / 3., 1e-8 * 8 / 3);
    EXPECT_NEAR(s.contact.sides[1].force[0], -8 / 3., 1e-8 * 8 / 3);
  }
}

} // namespace
} // namespace limit_load_test
