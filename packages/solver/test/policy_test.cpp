// SPDX-License-Identifier: BSD-3-Clause
#include "../src/policy.hpp"

#include <gtest/gtest.h>
#include <iterator>

namespace policy_test
{
namespace
{

using namespace rpc::solver;

constexpr Used all_used[] = {Used::mixed,     Used::meshes,       Used::meshes_again, Used::stand_in,    Used::factor,
                             Used::algebraic, Used::from_scratch, Used::sparse,       Used::sparse_fresh};
constexpr Outcome all_outcomes[] = {slow, failed, broken, dear};

TEST(Policy, HasOneRowForEachCase)
{
  for (const Used used : all_used)
    for (const Outcome outcome : all_outcomes) {
      int rows = 0;
      for (const PolicyRow &rule : policy) rows += rule.used == used && (rule.outcomes & outcome) != 0;
      EXPECT_EQ(rows, 1) << static_cast<int>(used) << " " << outcome;
      const PolicyRow &rule = rule_for(used, outcome);
      EXPECT_EQ(rule.used, used);
      EXPECT_NE(rule.outcomes & outcome, 0U);
    }
}

/// What is used once a row has been followed.
Used after(const Next next, const Used used)
{
  if (next == Next::whole || next == Next::whole_once) return Used::meshes;
  if (next == Next::stand_in) return Used::stand_in;
  if (next == Next::sparse || used == Used::sparse) return Used::sparse_fresh;
  return Used::from_scratch;
}

/// Whether memory allows a sparse factor or not: no case leads in circles. A strengthened hierarchy cannot become stronger.
TEST(Policy, EndsForEachOutcomeThatRepeats)
{
  for (const bool sparse_fits : {true, false})
    for (const Used first : all_used)
      for (const Outcome outcome : {failed, broken, dear}) {
        Used used = first;
        int turns = 0;
        for (bool strengthened = false; turns < 10; ++turns) {
          const PolicyRow &rule = rule_for(used, outcome);
          const auto can_be_had = [&](const Next next) {
            return next != Next::nothing && next != Next::meshes_back && !(next == Next::stronger && strengthened) &&
                   !(next == Next::sparse && !sparse_fits);
          };
          const Next next = can_be_had(rule.next) ? rule.next : rule.otherwise;
          if (!can_be_had(next)) break;
          strengthened = strengthened || next == Next::stronger;
          used = after(next, used);
        }
        EXPECT_LE(turns, 3) << static_cast<int>(first) << " " << outcome;
      }
}

/// Where multigrid on meshes is slow the algebraic one is no faster: of nearly incompressible P1 it took up to three times as long.
TEST(Policy, LeavesSlowMeshesInUse)
{
  for (const Used used : {Used::meshes, Used::mixed, Used::meshes_again})
    EXPECT_EQ(rule_for(used, slow).next, Next::nothing);
}

/// A matrix that is singular is nobody's fault: nothing stronger is tried.
TEST(Policy, BlamesTheMatrixWhereAllThatIsFreshBreaksDown)
{
  for (const Used used : {Used::factor, Used::from_scratch, Used::meshes_again, Used::sparse_fresh})
    EXPECT_EQ(rule_for(used, broken).next, Next::nothing);
  EXPECT_EQ(rule_for(Used::stand_in, broken).next, Next::meshes_back);
}

} // namespace
} // namespace policy_test
