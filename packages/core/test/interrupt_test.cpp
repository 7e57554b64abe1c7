// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/interrupt.hpp"

#include "expect_error.hpp"
#include "rpc/core/on_root.hpp"

#include <Tpetra_Core.hpp>
#include <csignal>
#include <cstdlib>
#include <gtest/gtest.h>
#include <string>

namespace interrupt_test
{
namespace
{

void (*handler_of(const int signal))(int)
{
  struct sigaction action = {};
  sigaction(signal, nullptr, &action);
  return action.sa_handler;
}

TEST(Interrupt, OfOneRankStopsAllAndTheNextSignalHasItsDefaultAction)
{
  const auto comm = Tpetra::getDefaultComm();
  rpc::install_interrupt_handlers();
  EXPECT_FALSE(rpc::interrupted(*comm));
  EXPECT_NO_THROW(rpc::throw_if_interrupted(*comm, "here"));
  const bool asked = comm->getRank() == comm->getSize() - 1;
  const auto work_of_root = [] {
    for (int look = 0; look < 3; ++look) rpc::throw_if_asked("on the first rank");
  };
  EXPECT_NO_THROW(rpc::on_root(*comm, rpc::ExitCode::internal_error, work_of_root));
  if (asked) std::raise(SIGTERM);
  EXPECT_THROW(rpc::on_root(*comm, rpc::ExitCode::internal_error, work_of_root), rpc::Error);
  EXPECT_TRUE(rpc::interrupted(*comm));
  EXPECT_TRUE(rpc::interrupted(*comm));
  const bool below_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
  const std::string told =
      std::string("interrupted by SIGTERM") + (below_mpirun ? " (mpirun sends it for Ctrl-C, too)" : "");
  EXPECT_EQ(rpc::interruption(), told);
  rpc::test::expect_error(rpc::ExitCode::not_converged, told + " here",
                          [&] { rpc::throw_if_interrupted(*comm, "here"); });
  for (const int signal : {SIGINT, SIGTERM}) EXPECT_EQ(handler_of(signal) == SIG_DFL, asked);
}

} // namespace
} // namespace interrupt_test
