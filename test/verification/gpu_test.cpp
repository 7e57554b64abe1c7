// SPDX-License-Identifier: BSD-3-Clause
#include "gpu.hpp"

#include "rpc/core/halo.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace gpu_test
{
namespace
{

TEST(Gpu, TheLogSaysWhoHasWhichAndHowMessagesGo)
{
  EXPECT_EQ(rpc::gpu_text("NVIDIA X", 1, 1, false), "NVIDIA X");
  EXPECT_EQ(rpc::gpu_text("NVIDIA X", 4, 4, false),
            "4 x NVIDIA X, a rank each; messages through pinned memory of the host");
  EXPECT_EQ(rpc::gpu_text("NVIDIA X", 4, 4, true), "4 x NVIDIA X, a rank each; messages from the GPUs' memory");
  const auto shared = rpc::gpu_text("NVIDIA X", 8, 2, false);
  EXPECT_NE(shared.find("2 x NVIDIA X, shared by 8 ranks"), std::string::npos) << shared;
  EXPECT_NE(shared.find("MPS"), std::string::npos) << shared;
}

/// Kernels of the host take none, and MPI reads none.
TEST(Gpu, IsChosenWhereThereAreKernelsForIt)
{
  std::string program = "rpc", own = "--kokkos-device-id=0";
  EXPECT_EQ(rpc::gpu_option({program.data(), own.data()}), "");
  EXPECT_EQ(rpc::gpu_report(*Tpetra::getDefaultComm()).empty(), !rpc::on_gpu);
  if (rpc::on_gpu) return;
  EXPECT_EQ(rpc::gpu_option({program.data()}), "");
  EXPECT_FALSE(rpc::mpi_reads_gpu());
}

} // namespace
} // namespace gpu_test
