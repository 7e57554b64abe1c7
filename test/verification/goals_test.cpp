// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Guaranteed intervals of mean displacements and pressures, doc/bounds.md (13.14) - (13.18).

namespace goals_test
{
namespace
{

using namespace rpc;
using Numbers = std::vector<std::string>;

const std::string decks = std::string(RPC_TEST_DECKS) + "/";

std::vector<bound::GoalBound> goals_of(const std::string &deck, Numbers numbers, const Numbers &more = {})
{
  numbers.insert(numbers.end(), more.begin(), more.end());
  numbers.push_back("Adapt->Error Bound=guaranteed");
  const Solution s = run_scene(decks + deck, numbers);
  EXPECT_TRUE(s.bound);
  EXPECT_EQ(s.bound->missing, "");
  for (const auto &goal : s.bound->goals) EXPECT_EQ(goal.missing, "") << goal.goal.name;
  return s.bound->goals;
}

void expect_holds(const bound::GoalBound &goal, const double value)
{
  const double rounding = 1e-10 * (std::abs(goal.lower) + std::abs(goal.upper));
  EXPECT_LE(goal.lower, value + rounding) << goal.goal.name;
  EXPECT_GE(goal.upper, value - rounding) << goal.goal.name;
}

TEST(Goals, OfAColumnUnderItsWeightHoldTheClosedForm)
{
  // E u'' = f, u(1) = -d; at y = 0 the pressure is p = E d + f/2 where u = 0, or the yield stress. The mean of u over y is
  // (f/6 - p/2)/E, or -d + (p/2 - f/3)/E where the foundation yields. Elements of order 2 have u.
  const double E = 1000, f = 2, d = 0.003;
  const Numbers column = {"Material->Poisson's Ratio=0",  "Body Force->Y=-2",
                          "Traction->right->X=0",         "Mesh->Cells={8, 4}",
                          "Goals->right->Component=Y",    "Goals->p->Type=mean pressure",
                          "Goals->p->Side=bottom",        "Goals->p->Box={0.25, 0, 1.5, 0}",
                          "Goals->q->Type=mean pressure", "Goals->q->Side=bottom",
                          "Goals->top->Component=Y"};
  for (const char *limit : {"inf", "3.5"})
    for (const std::string element : {"P1", "Q1", "P2", "Q2"}) {
      SCOPED_TRACE(limit + (", " + element));
      const bool rigid = std::string(limit) == "inf";
      const double p = rigid ? E * d + f / 2 : 3.5, mean = rigid ? (f / 6 - p / 2) / E : -d + (p / 2 - f / 3) / E;
      const auto goals = goals_of("even_block.xml", column,
                                  {"Mesh->Element=" + element, std::string("Contact->Yield Stress=") + limit});
      ASSERT_EQ(goals.size(), 4u);
      expect_holds(goals[0], mean);
      expect_holds(goals[1], p);
      expect_holds(goals[2], p);
      expect_holds(goals[3], -d);
      EXPECT_LE(goals[3].upper - goals[3].lower, 1e-9 * d); // it is prescribed
      const double width = goals[0].upper - goals[0].lower, of_all = goals[2].upper - goals[2].lower;
      if (element[1] == '1') {
        EXPECT_LT(width, 0.3 * std::abs(mean));
        EXPECT_LT(of_all, 0.2 * p);
        continue;
      }
      EXPECT_NEAR(goals[0].value, mean, 1e-9 * std::abs(mean));
      EXPECT_LT(width, 1e-5 * std::abs(mean));
      EXPECT_LT(of_all, 1e-5 * p);
      // Half of a cell at both ends of the part of 5 cells is not seen, or too much.
      EXPECT_NEAR(goals[1].lower, p * 4 / 5, 1e-5 * p);
      EXPECT_NEAR(goals[1].upper, rigid ? p * 6 / 5 : p, 1e-5 * p);
    }
}

TEST(Goals, OfFoundationsWithAllLawsHoldThoseOfAMeshEightTimesAsFine)
{
  const Numbers goals = {"Goals->right->Component=Y", "Goals->bottom->Component=X",
                         "Goals->top->Component=X",   "Goals->part->Type=contact force",
                         "Goals->part->Side=bottom",  "Goals->part->Box={0.1, -1, 0.8, 1}"};
  for (const Numbers &law :
       {Numbers{}, {"Contact->Hardening=400"}, {"Contact->Stiffness=3e3"}, {"Contact->Friction Bound=0.5"}}) {
    SCOPED_TRACE(law.empty() ? "yielding" : law[0]);
    Numbers scene = goals;
    scene.insert(scene.end(), law.begin(), law.end());
    const bool limited = law.empty() || law[0] != "Contact->Hardening=400"; // else nothing is known of the held end
    if (!limited) scene[5] = "Goals->part->Box={0.5, -1, 0.9, 1}";
    const auto fine = goals_of("heavy_block.xml", scene, {"Mesh->Cells={64, 48}", "Mesh->Element=Q1"});
    ASSERT_EQ(fine.size(), 4u);
    for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
      SCOPED_TRACE(element);
      const auto coarse = goals_of("heavy_block.xml", scene, {"Mesh->Cells={8, 6}", "Mesh->Element=" + element});
      for (int k = 0; k < 4; ++k) {
        expect_holds(coarse[k], fine[k].value);
        EXPECT_LT(fine[k].upper - fine[k].lower, coarse[k].upper - coarse[k].lower);
      }
    }
  }
}

TEST(Goals, HaveEstimatesThatAreNearTheErrorOfElementsOfOrderOne)
{
  const Numbers goals = {"Goals->right->Component=Y", "Goals->bottom->Component=X"};
  for (const Numbers &law : {Numbers{}, {"Contact->Yield Stress=inf"}, {"Contact->Friction Bound=0.5"}}) {
    SCOPED_TRACE(law.empty() ? "yielding" : law[0]);
    Numbers scene = goals;
    scene.insert(scene.end(), law.begin(), law.end());
    const auto fine = goals_of("heavy_block.xml", scene, {"Mesh->Cells={32, 24}", "Mesh->Element=P2"});
    EXPECT_TRUE(std::isnan(fine[0].estimated_error)); // of order 2 it is none
    for (const std::string element : {"P1", "Q1"}) {
      SCOPED_TRACE(element);
      for (const auto &goal : goals_of("heavy_block.xml", scene, {"Mesh->Element=" + element})) {
        const double exact = (goal.goal.name == "right" ? fine[0] : fine[1]).value;
        EXPECT_NEAR(goal.value + goal.estimated_error, exact, 0.5 * std::abs(goal.value - exact)) << goal.goal.name;
      }
    }
  }
}

TEST(Goals, InSpaceHoldThoseOfAFinerMesh)
{
  const Numbers scene = {"Contact->Yield Stress=6",   "Goals->right->Component=Z",
                         "Goals->front->Component=X", "Goals->part->Type=mean pressure",
                         "Goals->part->Side=back",    "Goals->part->Box={0.3, 0.2, -1, 1, 0.8, 1}"};
  for (const std::string element : {"P1", "Q1", "P2"}) {
    SCOPED_TRACE(element);
    Numbers coarse = scene, fine = scene;
    coarse.insert(coarse.end(), {"Mesh->Element=" + element, "Mesh->Cells={4, 3, 2}"});
    fine.insert(fine.end(), {"Mesh->Element=" + element,
                             std::string("Mesh->Cells=") + (element == "P2" ? "{8, 6, 4}" : "{16, 12, 8}")});
    const auto a = goals_of("clamped_block.xml", coarse), b = goals_of("clamped_block.xml", fine);
    ASSERT_EQ(a.size(), 3u);
    for (int k = 0; k < 3; ++k) {
      expect_holds(a[k], b[k].value);
      EXPECT_LT(b[k].upper - b[k].lower, a[k].upper - a[k].lower);
    }
  }
}

TEST(Goals, OfAnEvenlyPressedCylinderHoldTheClosedForm)
{
  const double p = 1000 * 0.01, area = std::acos(-1.);
  for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
    SCOPED_TRACE(element);
    const auto goals = goals_of("barrel.xml", {"Dirichlet->top->X=", "Mesh->Element=" + element, "Mesh->Cells={8, 8}",
                                               "Goals->all->Type=mean pressure", "Goals->all->Side=bottom",
                                               "Goals->disc->Type=contact force", "Goals->disc->Side=bottom",
                                               "Goals->disc->Box={0, -1, 0.5, 1}", "Goals->ring->Type=mean pressure",
                                               "Goals->ring->Side=bottom", "Goals->ring->Box={0.5, -1, 2, 1}"});
    ASSERT_EQ(goals.size(), 3u);
    expect_holds(goals[0], p);
    EXPECT_LT(goals[0].upper - goals[0].lower, 2e-6 * p);
    expect_holds(goals[1], p * area / 4);
    expect_holds(goals[2], p);
    EXPECT_NEAR(goals[0].value, p, 1e-6 * p);
    EXPECT_NEAR(goals[1].value, p * area / 4, 0.02 * p * area / 4); // p r of the nodes
    // p r is seen up to (1 - s) r over the cells beside r = 1/2, of 1/8: of r^2/2 = 1/8 they have (1/2 -+ 1/24)/16 more or less.
    EXPECT_NEAR(goals[1].lower, 2 * area * p * (1. / 8 - (1. / 2 - 1. / 24) / 16), 1e-5 * p);
    EXPECT_NEAR(goals[1].upper, 2 * area * p * (1. / 8 + (1. / 2 + 1. / 24) / 16), 1e-5 * p);
  }
}

TEST(Goals, AreRefusedWhereNothingIsCertain)
{
  const auto refused = [](const Numbers &numbers, const std::string &part, const char *deck = "heavy_block.xml") {
    SCOPED_TRACE(part);
    try {
      run_scene(decks + deck, numbers);
      ADD_FAILURE() << "not refused";
    } catch (const Error &error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  const std::string bound = "Adapt->Error Bound=guaranteed";
  refused({"Goals->top->Component=Y"}, "asks for a guaranteed interval");
  refused({bound, "Goals->top->Type=mean pressure"}, "side \"top\" has no contact. Contact sides are bottom");
  refused({bound, "Goals->nowhere->Component=Y"}, "nowhere");
  refused({bound, "Goals->top->Component=Z"}, "must be one of X, Y");
  refused({bound, "Goals->top->Box={0, 0, 1, 1}"}, "that of a whole side");
  refused({bound, "Goals->bottom->Type=contact force", "Goals->bottom->Box={0, 0, 1}"}, "must have 4 numbers");
  refused({bound, "Goals->top->Component=Y"}, "mean displacement of a body of revolution", "barrel.xml");
  refused({bound, "Goals->bottom->Type=contact area"}, "must be one of mean displacement");
}

TEST(Goals, SayWhyThereIsNoInterval)
{
  const Solution s =
      run_scene(decks + "heavy_block.xml",
                {"Adapt->Error Bound=guaranteed", "Contact->Yield Stress=inf", "Goals->all->Type=contact force",
                 "Goals->all->Side=bottom", "Goals->part->Type=contact force", "Goals->part->Side=bottom",
                 "Goals->part->Box={0.5, 0, 2, 0}", "Goals->off->Type=mean pressure", "Goals->off->Side=bottom",
                 "Goals->off->Box={3, 0, 4, 0}"});
  ASSERT_TRUE(s.bound);
  ASSERT_EQ(s.bound->goals.size(), 3u);
  EXPECT_NE(s.bound->goals[0].missing.find("no yield stress limits the pressure there"), std::string::npos);
  EXPECT_EQ(s.bound->goals[1].missing, "");
  EXPECT_NE(s.bound->goals[2].missing.find("nothing of the side is in its box"), std::string::npos);
}

} // namespace
} // namespace goals_test
