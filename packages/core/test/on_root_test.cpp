// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/on_root.hpp"

#include "expect_error.hpp"
#include "rpc/core/tpetra.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>
#include <new>

namespace on_root_test
{
namespace
{

using rpc::Error;
using rpc::ExitCode;
using rpc::on_root;
using rpc::test::expect_error;

TEST(OnRoot, WorkRunsOnceOnRankZero)
{
  const auto comm = Tpetra::getDefaultComm();
  int runs = 0;
  on_root(*comm, ExitCode::internal_error, [&] { ++runs; });
  EXPECT_EQ(runs, comm->getRank() == 0 ? 1 : 0);
}

TEST(OnRoot, TextGoesToEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  const std::string text("a\0b", 3);
  EXPECT_EQ(rpc::text_of_root(*comm, ExitCode::internal_error, [&] { return text; }), text);
  EXPECT_EQ(rpc::text_of_rank(*comm, comm->getSize() - 1, std::to_string(comm->getRank())),
            std::to_string(comm->getSize() - 1));
  expect_error(ExitCode::bad_input, "no such file", [&] {
    rpc::text_of_root(*comm, ExitCode::bad_input, []() -> std::string { throw std::runtime_error("no such file"); });
  });
}

TEST(OnRoot, ErrorKeepsItsCodeAndMessageOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  expect_error(ExitCode::bad_input, "no such folder", [&] {
    on_root(*comm, ExitCode::internal_error, [] { throw Error(ExitCode::bad_input, "no such folder"); });
  });
}

TEST(OnRoot, OtherExceptionsGetTheDefaultCodeOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  expect_error(ExitCode::bad_mesh, "out of paper",
               [&] { on_root(*comm, ExitCode::bad_mesh, [] { throw std::runtime_error("out of paper"); }); });
}

TEST(OnRoot, MemoryThatRunsOutIsAnInternalErrorOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  expect_error(ExitCode::internal_error, "out of memory",
               [&] { on_root(*comm, ExitCode::bad_mesh, [] { throw std::bad_alloc(); }); });
}

TEST(OnEach, WorkRunsOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  int runs = 0;
  rpc::on_each(*comm, ExitCode::internal_error, [&] { ++runs; });
  EXPECT_EQ(runs, 1);
}

TEST(OnEach, WhatTheLowestRankMeetsWithIsThrownOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  const int last = comm->getSize() - 1;
  expect_error(ExitCode::bad_input, "no folder on rank " + std::to_string(last), [&] {
    rpc::on_each(*comm, ExitCode::internal_error, [&] {
      if (comm->getRank() == last) throw Error(ExitCode::bad_input, "no folder on rank " + std::to_string(last));
    });
  });
  expect_error(ExitCode::bad_mesh, "rank 0", [&] {
    rpc::on_each(*comm, ExitCode::bad_mesh,
                 [&] { throw std::runtime_error("rank " + std::to_string(comm->getRank())); });
  });
}

} // namespace
} // namespace on_root_test
