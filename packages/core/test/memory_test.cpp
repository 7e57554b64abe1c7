// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace memory_test
{
namespace
{

TEST(MemoryLimit, IsThatOfAMachine)
{
  EXPECT_GT(rpc::memory_limit(), 1e8);
}

TEST(MemoryLimit, TheShellsBoundCounts)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer's own tables take more than any bound on the memory";
#endif
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  if (before.rlim_max != RLIM_INFINITY) GTEST_SKIP() << "the address space is bound already";
  const double machine = rpc::memory_limit();
  rlimit bound = before;
  bound.rlim_cur = static_cast<rlim_t>(machine / 2);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &bound), 0);
  const double found = rpc::memory_limit();
  setrlimit(RLIMIT_AS, &before);
  EXPECT_NEAR(found, machine / 2, 1);
}

} // namespace
} // namespace memory_test
