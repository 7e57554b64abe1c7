// SPDX-License-Identifier: BSD-3-Clause
#include "expect_error.hpp"
#include "rpc/core/child_process.hpp"
#include "rpc/core/interrupt.hpp"

#include <csignal>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <new>
#include <unistd.h>

namespace child_process_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

TEST(ChildProcess, ReturnsWhatWorkReturns)
{
  EXPECT_EQ(in_child_process([] { return std::string("a\0b", 3); }), std::string("a\0b", 3));
  EXPECT_EQ(in_child_process([] { return std::string(); }), "");
  const std::string large(3000001, 'x'); // more than a pipe holds
  EXPECT_EQ(in_child_process([&] { return large; }), large);
}

TEST(ChildProcess, ThrowsWhatWorkThrows)
{
  expect_error(ExitCode::bad_mesh, {"of the child"},
               [] { in_child_process([]() -> std::string { throw Error(ExitCode::bad_mesh, "of the child"); }); });
}

TEST(ChildProcess, OneThatBreaksDownReturnsNothingAndLeavesThisProcessAlone)
{
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE})
    EXPECT_FALSE(in_child_process([&]() -> std::string {
      std::raise(signal);
      return "not reached";
    })) << signal;
  EXPECT_FALSE(in_child_process([]() -> std::string { ::_exit(0); })); // a library that ends the process
  EXPECT_FALSE(in_child_process([]() -> std::string { throw std::bad_alloc(); }));
}

/// A signal may reach one rank of those that read a file: this rank goes on to where all look for it together.
TEST(ChildProcess, OneThatEndsWellIsNotGivenUpForASignalToThisProcess)
{
  const auto ends = [](const std::function<std::string()> &work) {
    install_interrupt_handlers();
    std::raise(SIGTERM);
    try {
      std::_Exit(in_child_process(work) == "done" ? 0 : 1);
    } catch (const Error &error) {
      std::_Exit(static_cast<int>(error.code()));
    }
  };
  EXPECT_EXIT(ends([] { return std::string("done"); }), testing::ExitedWithCode(0), "");
  EXPECT_EXIT(ends([]() -> std::string { ::_exit(1); }),
              testing::ExitedWithCode(static_cast<int>(ExitCode::not_converged)), "");
}

TEST(ChildProcess, WritesNothingToTheConsole)
{
  testing::internal::CaptureStderr();
  EXPECT_EQ(in_child_process([] {
              std::cerr << "a library's complaint" << std::endl;
              return std::string("done");
            }),
            "done");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

} // namespace
} // namespace child_process_test
