// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"

#include "expect_error.hpp"

#include <Tpetra_Core.hpp>
#include <optional>

namespace error_test
{
namespace
{

using rpc::ExitCode;
using rpc::throw_if_any;
using rpc::test::error_of;
using rpc::test::expect_error;

TEST(ThrowIfAny, SaysNothingIfNoRankBringsAMessage)
{
  EXPECT_NO_THROW(throw_if_any(*Tpetra::getDefaultComm(), ExitCode::bad_mesh, std::nullopt));
}

TEST(ThrowIfAny, OneRanksMessageIsThrownOnAll)
{
  const auto comm = Tpetra::getDefaultComm();
  for (int speaker = 0; speaker < comm->getSize(); ++speaker) {
    const std::string expected = "rank " + std::to_string(speaker) + " found a bad cell";
    std::optional<std::string> message;
    if (comm->getRank() == speaker) message = expected;
    const auto error = error_of([&] { throw_if_any(*comm, ExitCode::bad_mesh, message); });
    EXPECT_EQ(error.code(), ExitCode::bad_mesh);
    EXPECT_EQ(error.what(), expected);
  }
}

TEST(ThrowIfAny, LowestRanksMessageWinsOnAllWhateverTheLengths)
{
  const auto comm = Tpetra::getDefaultComm();
  const int rank = comm->getRank(), first = comm->getSize() > 1 ? 1 : 0;
  std::optional<std::string> message; // longer on each rank
  if (rank >= first) message = std::string(10 * (rank + 1), static_cast<char>('a' + rank));
  const auto error = error_of([&] { throw_if_any(*comm, ExitCode::bad_input, message); });
  EXPECT_EQ(error.what(), std::string(10 * (first + 1), static_cast<char>('a' + first)));
}

TEST(ThrowIfAny, EmptyMessageThrowsToo)
{
  const auto comm = Tpetra::getDefaultComm();
  const auto error = error_of([&] { throw_if_any(*comm, ExitCode::no_solution, std::string()); });
  EXPECT_EQ(error.code(), ExitCode::no_solution);
  EXPECT_STREQ(error.what(), "");
}

TEST(Require, ThrowsItsCodeAndTheStreamedMessageOnlyIfBroken)
{
  EXPECT_NO_THROW(RPC_REQUIRE(1 < 2, "never"));
  expect_error(ExitCode::bad_input, {"must be > 0 [Pa], got -2"},
               [] { RPC_REQUIRE(-2 > 0, "must be > 0 [Pa], got " << -2); });
  expect_error(ExitCode::bad_mesh, {"3 cells"}, [] { RPC_REQUIRE_CODE(false, ExitCode::bad_mesh, 3 << " cells"); });
}

} // namespace
} // namespace error_test
