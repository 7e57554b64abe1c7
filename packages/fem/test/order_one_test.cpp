// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/order_one.hpp"

#include "bodies.hpp"

#include <algorithm>

namespace order_one_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

std::vector<mesh::Element> quadratic()
{
  std::vector<mesh::Element> found;
  for (const mesh::Element &element : elements())
    if (element.order == 2) found.push_back(element);
  return found;
}

fem::Discretization box_of(const mesh::Element &element)
{
  return fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(small_box(element), world())));
}

TEST(OrderOne, HasTheVerticesOfAllCells)
{
  for (const mesh::Element &element : quadratic()) {
    const fem::OrderOne lower = fem::order_one(box_of(element));
    auto box = small_box(element);
    box.element.order = 1;
    const mesh::Mesh same = mesh::make_box(box, world());
    const std::string text = text_of(element);
    EXPECT_EQ(lower.mesh->owned_nodes->getGlobalNumElements(), same.owned_nodes->getGlobalNumElements()) << text;
    EXPECT_EQ(lower.mesh->num_owned_cells, same.num_owned_cells) << text;
    EXPECT_TRUE(lower.mesh->element == box.element) << text;
    ASSERT_TRUE(lower.mesh->box) << text;
    EXPECT_EQ(lower.mesh->box->element.order, 1) << text;
    EXPECT_EQ(lower.mesh->owned_nodes->getMinAllGlobalIndex(), 0) << text;
    EXPECT_EQ(lower.mesh->owned_nodes->getMaxAllGlobalIndex() + 1,
              static_cast<GO>(lower.mesh->owned_nodes->getGlobalNumElements()))
        << text;
    const fem::Discretization d = fem::discretize(lower.mesh); // whose lists need all nodes that cells have
    EXPECT_GT(d.owned_dofs->getGlobalNumElements(), 0U) << text;
  }
}

/// Coordinates of straight cells are linear functions: the vertices' give those of all nodes.
TEST(OrderOne, InterpolatesLinearFunctionsExactly)
{
  for (const mesh::Element &element : quadratic()) {
    const fem::Discretization d = box_of(element);
    const fem::OrderOne lower = fem::order_one(d);
    const int dim = element.dim;
    MultiVector vertices(lower.mesh->owned_nodes, dim + 1), nodes(d.mesh->owned_nodes, dim + 1);
    {
      const auto to = vertices.getLocalViewHost(Tpetra::Access::OverwriteAll);
      const auto coords = to_host(lower.mesh->coords);
      for (LO v = 0; v < lower.mesh->num_owned_nodes(); ++v) {
        for (int k = 0; k < dim; ++k) to(v, k) = coords(v, k);
        to(v, dim) = 1;
      }
    }
    lower.interpolation->apply(vertices, nodes);
    const auto found = nodes.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto coords = to_host(d.mesh->coords);
    double worst = 0;
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      for (int k = 0; k < dim; ++k) worst = std::max(worst, std::abs(found(n, k) - coords(n, k)));
      worst = std::max(worst, std::abs(found(n, dim) - 1));
    }
    EXPECT_LT(worst, 1e-14) << text_of(element);
  }
}

TEST(OrderOne, KeepsSidesAndCorners)
{
  for (const mesh::Element &element : quadratic()) {
    const fem::Discretization d = box_of(element);
    const auto lower = fem::order_one(d).mesh;
    ASSERT_EQ(lower->sides.size(), d.mesh->sides.size()) << text_of(element);
    ASSERT_EQ(lower->points.size(), d.mesh->points.size()) << text_of(element);
    const auto coords = to_host(lower->coords), all = to_host(d.mesh->coords);
    for (std::size_t s = 0; s < lower->sides.size(); ++s) {
      const std::string &name = lower->sides[s].name;
      EXPECT_EQ(name, d.mesh->sides[s].name);
      const auto here = lower->nodes_of(name, "test"), there = d.mesh->nodes_of(name, "test");
      const int normal = (name == "left" || name == "right") ? 0 : (name == "bottom" || name == "top") ? 1 : 2;
      for (const LO n : here) EXPECT_EQ(coords(n, normal), all(there.front(), normal)) << name;
      EXPECT_EQ(here.empty(), there.empty());
    }
    for (std::size_t s = 0; s < lower->points.size(); ++s)
      EXPECT_EQ(lower->points[s].node.size(), d.mesh->points[s].node.size());
  }
}

TEST(OrderOne, IsOfOrderTwoOnly)
{
  EXPECT_THROW(fem::order_one(box_of({2, 1})), Error);
}

} // namespace
} // namespace order_one_test
