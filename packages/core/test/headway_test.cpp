// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/headway.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace headway_test
{
namespace
{

using rpc::Headway;
using Answer = Headway::Answer;

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
constexpr int unlimited = Headway::unlimited;

std::vector<Answer> answers(Headway headway, const std::vector<double> &measures)
{
  std::vector<Answer> all;
  for (const double measure : measures) all.push_back(headway.add(measure));
  return all;
}

TEST(Headway, AMeasureIsComparedWithTheLeastBefore)
{
  EXPECT_EQ(answers(Headway({0.9}), {10, 8, 20, 7.5, 6}),
            (std::vector{Answer::progress, Answer::progress, Answer::slow, Answer::slow, Answer::progress}));
}

TEST(Headway, WithoutLimitsNothingIsStuck)
{
  EXPECT_EQ(answers(Headway({}), std::vector<double>(100, 1.)).back(), Answer::slow);
}

TEST(Headway, IsStuckAfterMoreThanSoManyInARow)
{
  EXPECT_EQ(answers(Headway({1, 1}), {5, 6, 4, 4, 4}),
            (std::vector{Answer::progress, Answer::slow, Answer::progress, Answer::slow, Answer::stuck}));
}

TEST(Headway, IsStuckAfterMoreThanSoManyWithProgressBetweenThem)
{
  EXPECT_EQ(answers(Headway({1, unlimited, 1}), {5, 6, 4, 4}),
            (std::vector{Answer::progress, Answer::slow, Answer::progress, Answer::stuck}));
}

TEST(Headway, IsStuckAfterMoreThanSoManyInAll)
{
  EXPECT_EQ(answers(Headway({1, unlimited, unlimited, 2}), {3, 2, 1}),
            (std::vector{Answer::progress, Answer::progress, Answer::stuck}));
}

TEST(Headway, WhatIsNoNumberIsNoProgress)
{
  EXPECT_EQ(answers(Headway({}), {nan, infinity, 3, nan, 2}),
            (std::vector{Answer::slow, Answer::slow, Answer::progress, Answer::slow, Answer::progress}));
}

TEST(Headway, AGivenReferenceReplacesTheLeast)
{
  Headway headway({0.5, 0});
  EXPECT_EQ(headway.add(4, 10), Answer::progress);
  EXPECT_EQ(headway.add(4, 8), Answer::stuck);
  EXPECT_EQ(headway.add(30, 100), Answer::progress);
}

TEST(Headway, APointWithoutProgressMayCountTwice)
{
  Headway headway({1, unlimited, 2});
  EXPECT_EQ(headway.take(false, 2), Answer::slow);
  EXPECT_EQ(headway.take(true, 2), Answer::progress);
  EXPECT_EQ(headway.take(false), Answer::stuck);
}

TEST(Headway, StartsOver)
{
  Headway headway({1, 0});
  headway.add(1);
  EXPECT_EQ(headway.add(2), Answer::stuck);
  headway.start_over();
  EXPECT_EQ(headway.count(), 0);
  EXPECT_EQ(headway.add(2), Answer::progress);
}

TEST(Headway, APointThatComesBackIsACycle)
{
  Headway headway({});
  EXPECT_EQ(headway.visit(7), Answer::progress);
  EXPECT_EQ(headway.visit(8), Answer::progress);
  EXPECT_EQ(headway.visit(7, 3), Answer::slow);
  EXPECT_EQ(headway.visit(7, 3), Answer::slow);
  EXPECT_EQ(headway.visit(7, 3), Answer::cycle);
  headway.start_over();
  EXPECT_EQ(headway.visit(8), Answer::cycle);
  headway.forget_visits();
  EXPECT_EQ(headway.visit(8), Answer::progress);
}

} // namespace
} // namespace headway_test
