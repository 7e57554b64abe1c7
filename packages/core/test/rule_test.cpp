// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/rule.hpp"
#include "rpc/core/rule_registry.hpp"

#include <gtest/gtest.h>
#include <stdexcept>

namespace rule_test
{
namespace
{

using namespace rpc;

struct TestRules {
  Rule<int> most_idle{6, "test.most_idle", "updates in a row [-]", "this test"};
  Rule<double> much{0.5, "test.much", "part of the load [-]", "this test"};
};
constexpr_rules TestRules rules;

TEST(Rule, IsTheNumberThatItWasGiven)
{
  EXPECT_EQ(rules.most_idle, 6);
  EXPECT_EQ(2 * rules.much, 1.);
#ifndef RPC_ABLATION
  static_assert(rules.most_idle == 6, "a constant of the compiler");
#endif
}

TEST(Rule, SettingsReplaceTheValueOfTheirNameAlone)
{
  EXPECT_EQ(ablation::replaced(6, "test.most_idle", "test.most=1;test.most_idle=3;test.much=2e-1"), 3);
  EXPECT_EQ(ablation::replaced(0.5, "test.much", "test.most_idle=3;test.much=2e-1"), 0.2);
  EXPECT_EQ(ablation::replaced(6, "test.most", "test.most_idle=3"), 6);
  EXPECT_EQ(ablation::replaced(6, "test.most", ""), 6);
}

TEST(Rule, SettingsWithoutANumberAreRefused)
{
  for (const char *settings : {"test.much=", "test.much=three", "test.much=3 "})
    EXPECT_THROW(ablation::replaced(6, "test.much", settings), std::invalid_argument) << settings;
}

} // namespace
} // namespace rule_test
