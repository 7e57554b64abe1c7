// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/dofs.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <type_traits>

namespace dofs_test
{
namespace
{

using namespace rpc;

TEST(Dofs, RunThroughTheComponentsNodeByNode)
{
  for (const int dim : {2, 3}) {
    LO next = 0;
    for (LO node = 0; node < 5; ++node)
      for (int component = 0; component < dim; ++component, ++next) {
        EXPECT_EQ(rpc::dof(dim, node, component), next);
        EXPECT_EQ(rpc::node_of(dim, next), node);
        EXPECT_EQ(rpc::component_of(dim, next), component);
      }
    EXPECT_EQ(rpc::num_dofs(dim, LO(5)), next);
  }
}

TEST(Dofs, OfGlobalNodesDoNotOverflowLocalOrdinals)
{
  static_assert(std::is_same_v<decltype(rpc::dof(3, GO(1), 0)), GO>);
  static_assert(std::is_same_v<decltype(rpc::dof(3, LO(1), 0)), LO>);
  const GO node = std::numeric_limits<LO>::max();
  const GO dof = rpc::dof(3, node, 2);
  EXPECT_EQ(dof, 3 * node + 2);
  EXPECT_EQ(rpc::node_of(3, dof), node);
  EXPECT_EQ(rpc::component_of(3, dof), 2);
}

} // namespace
} // namespace dofs_test
