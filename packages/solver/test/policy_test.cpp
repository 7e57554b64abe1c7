#include "../src/policy.hpp"

#include <gtest/gtest.h>
#include <iterator>

namespace
{

using namespace rpc::solver;

constexpr Used all_used[] = {Used::meshes, Used::meshes_again, Used::stand_in,
                             Used::factor, Used::algebraic,    Used::from_scratch};
constexpr Outcome all_outcomes[] = {slow, failed, broken};

TEST(Policy, HasOneRowForEachCase)
{
  for (const Used used : all_used)
    for (const Outcome outcome : all_outcomes) {
      int rows = 0;
      for (const Rule &rule : policy) rows += rule.used == used && (rule.outcomes & outcome) != 0;
      EXPECT_EQ(rows, 1) << static_cast<int>(used) << " " << outcome;
      const Rule &rule = rule_for(used, outcome);
      EXPECT_EQ(rule.used, used);
      EXPECT_NE(rule.outcomes & outcome, 0U);
    }
}

/// What is used once a row has been followed; a strengthened hierarchy cannot become stronger, which ends a solve.
Used after(const Next next)
{
  return next == Next::stand_in ? Used::stand_in : Used::from_scratch;
}

TEST(Policy, EndsForEachOutcomeThatRepeats)
{
  for (const Used first : all_used)
    for (const Outcome outcome : {failed, broken}) {
      Used used = first;
      int turns = 0;
      for (bool strengthened = false; turns < 10; ++turns) {
        const Next next = rule_for(used, outcome).next;
        if (next == Next::nothing || next == Next::meshes_back || (next == Next::stronger && strengthened)) break;
        strengthened = strengthened || next == Next::stronger;
        used = after(next);
      }
      EXPECT_LE(turns, 2) << static_cast<int>(first) << " " << outcome;
    }
}

/// A matrix that is singular is nobody's fault: nothing stronger is tried.
TEST(Policy, BlamesTheMatrixWhereAllThatIsFreshBreaksDown)
{
  for (const Used used : {Used::factor, Used::from_scratch, Used::meshes_again})
    EXPECT_EQ(rule_for(used, broken).next, Next::nothing);
  EXPECT_EQ(rule_for(Used::stand_in, broken).next, Next::meshes_back);
}

} // namespace
