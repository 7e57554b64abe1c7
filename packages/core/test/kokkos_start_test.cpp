// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/kokkos_start.hpp"

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>
#include <stdexcept>
#include <string>

namespace kokkos_start_test
{
namespace
{

using rpc::kokkos_spelling;
using rpc::start_or_throw;

/// What `start` throws, "" where it throws nothing.
std::string thrown_by(const std::function<void()> &start)
{
  try {
    start_or_throw(start);
  } catch (const std::exception &error) {
    return error.what();
  }
  return "";
}

TEST(StartOrThrow, AbortIsAnExceptionWithItsReason)
{
  for (int repeated = 0; repeated < 2; ++repeated) {
    testing::internal::CaptureStderr();
    const std::string reason = thrown_by([] {
      std::fputs("Error: there are no such threads. Raised by Kokkos::initialize().\n\nBacktrace: many lines\n",
                 stderr);
      std::abort();
    });
    EXPECT_EQ(reason, "there are no such threads.");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  }
  EXPECT_EQ(thrown_by([] { std::abort(); }), "it gave no reason");
}

TEST(StartOrThrow, ExceptionsPassAndWarningsAppearAfterwards)
{
  testing::internal::CaptureStderr();
  EXPECT_EQ(thrown_by([] { throw std::runtime_error("refused"); }), "refused");
  bool called = false;
  EXPECT_EQ(
      thrown_by([&] {
        called = true;
        std::cerr << "Warning: command line argument '--kokkos-x' is not recognized. Raised by Kokkos::initialize().\n"
                  << "Warning: one thread only\n";
      }),
      "");
  EXPECT_TRUE(called);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "Warning: one thread only\n");
}

TEST(KokkosSpelling, NumberOfThreadsHasOneOfTwoNames)
{
  const std::string known = kokkos_spelling("--kokkos-threads");
  EXPECT_TRUE(known == "--kokkos-threads" || known == "--kokkos-num-threads");
  for (const std::string name : {"--kokkos-threads", "--kokkos-num-threads"}) {
    EXPECT_EQ(kokkos_spelling(name), known);
    EXPECT_EQ(kokkos_spelling(name + "=2"), known + "=2");
  }
  for (const std::string other : {"rpc", "--kokkos-device-id=1", "--kokkos-threads-of=2", "--kokkos-help"})
    EXPECT_EQ(kokkos_spelling(other), other);
}

} // namespace
} // namespace kokkos_start_test
