// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/message.hpp"

#include <gtest/gtest.h>
#include <new>
#include <stdexcept>

namespace message_test
{
namespace
{

using rpc::for_terminal;

TEST(ForTerminal, LeavesAnOrdinaryMessageAsItIs)
{
  const std::string message = "deck: \"Contact->Gap\" = \"naïve\" is not a number";
  EXPECT_EQ(for_terminal(message), message);
}

TEST(ForTerminal, LineBreaksAndEscapesCannotActOnIt)
{
  EXPECT_EQ(for_terminal("side \"a\nb\x1b[31m\t\x7f\""), "side \"a?b?[31m ?\"");
}

TEST(ForTerminal, TooMuchIsCutOutOfTheMiddle)
{
  const std::string cut = for_terminal("\"A->B\" = \"" + std::string(100000, 'n') + "\" must be > 0 [m]");
  EXPECT_EQ(cut.size(), 897);
  EXPECT_EQ(cut.rfind("\"A->B\" = \"nnn", 0), 0);
  EXPECT_EQ(cut.substr(cut.size() - 18), "n\" must be > 0 [m]");
  EXPECT_NE(cut.find("n [...] n"), cut.npos);
}

TEST(ForTerminal, NoCharacterIsCutInTwo)
{
  for (int shift = 0; shift < 4; ++shift) {
    std::string message(shift, 'x');
    for (int n = 0; n < 1000; ++n) message += "Ω";
    const std::string cut = for_terminal(message);
    const auto gap = cut.find(" [...] ");
    ASSERT_NE(gap, cut.npos);
    EXPECT_EQ(cut.substr(gap - 2, 2), "Ω");
    EXPECT_EQ(cut.substr(gap + 7, 2), "Ω");
    EXPECT_LE(cut.size(), 900);
  }
}

TEST(IsOutOfMemory, KnowsTheStandardsExceptionAndKokkos)
{
  EXPECT_TRUE(rpc::is_out_of_memory(std::bad_alloc()));
  EXPECT_TRUE(rpc::is_out_of_memory(std::runtime_error("Kokkos failed to allocate memory for label \"x\".")));
  EXPECT_TRUE(rpc::is_out_of_memory(
      std::runtime_error("Kokkos ERROR: Host memory space failed to allocate 2.5 TiB (label=\"x\").")));
  EXPECT_FALSE(rpc::is_out_of_memory(std::runtime_error("Kokkos failed")));
}

TEST(PassOnOutOfMemory, ThrowsWhatAllRanksCannotAnswerAlike)
{
  const auto handled = [](const auto &thrown) {
    try {
      throw thrown;
    } catch (const std::exception &error) {
      rpc::pass_on_out_of_memory(error);
    }
  };
  EXPECT_THROW(handled(std::bad_alloc()), std::bad_alloc);
  EXPECT_THROW(handled(std::runtime_error("Kokkos failed to allocate memory for label \"x\".")), std::runtime_error);
  EXPECT_NO_THROW(handled(std::runtime_error("a singular matrix")));
}

} // namespace
} // namespace message_test
