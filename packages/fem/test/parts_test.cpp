// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/parts.hpp"

#include "bodies.hpp"
#include "drawn_mesh.hpp"

namespace parts_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

fem::Discretization drawn_body(const std::vector<std::string> &rows)
{
  return fem::discretize(distributed(drawn(rows)));
}

TEST(Parts, OfABoxAreOne)
{
  for (const mesh::Element &element : elements()) {
    const auto box = small_box(element);
    const auto d = body(box, world());
    const fem::Parts parts = fem::connected_parts(d);
    ASSERT_EQ(parts.size(), 1);
    GO cells = parts_of_cell(element);
    double squares = 0;
    for (int c = 0; c < element.dim; ++c) {
      cells *= box.cells[c];
      squares += std::pow((box.upper[c] - box.lower[c]) / 2, 2);
      EXPECT_NEAR(parts.part[0].centre[c], (box.upper[c] + box.lower[c]) / 2, 1e-14);
    }
    EXPECT_EQ(parts.part[0].num_cells, cells);
    EXPECT_NEAR(parts.part[0].radius, std::sqrt(squares), 1e-14);
    EXPECT_EQ(parts.part[0].blocks, std::vector<int>{0});
    EXPECT_EQ(fem::name_of(*d.mesh, parts, 0), "the body");
  }
}

TEST(Parts, ThatShareNoNodeAreTold)
{
  const auto d = drawn_body({"bb..aaa", //
                             "....aca"});
  const fem::Parts parts = fem::connected_parts(d);
  ASSERT_EQ(parts.size(), 2);
  const int left = parts.part[0].num_cells == 2 ? 0 : 1, right = 1 - left;
  EXPECT_EQ(parts.part[left].num_cells, 2);
  EXPECT_EQ(parts.part[right].num_cells, 6);
  EXPECT_EQ(fem::name_of(*d.mesh, parts, left), "the part in block \"b\" (2 cells around (1, 1.5))");
  EXPECT_EQ(fem::name_of(*d.mesh, parts, right), "the part in blocks \"a\", \"c\" (6 cells around (5.5, 1))");
  EXPECT_NEAR(parts.part[right].radius, std::hypot(1.5, 1), 1e-14);
  const auto coords = to_host(d.mesh->coords);
  const auto part = to_host(parts.of_node);
  ASSERT_EQ(part.extent_int(0), d.mesh->num_local_nodes());
  for (LO n = 0; n < d.mesh->num_local_nodes(); ++n) EXPECT_EQ(part(n), coords(n, 0) < 3 ? left : right);
}

TEST(Parts, AreFoundAroundManyCorners)
{
  // Two snakes inside each other: ranks hold several pieces of both.
  const auto d = drawn_body({"aaaaaaaaaaaaaaa", //
                             "a.............a", //
                             "a.bbbbbbbbbbb.a", //
                             "a.b...........a", //
                             "a.b.aaaaaaaaaaa", //
                             "a.b.a..........", //
                             "a.b.aaaaaaaaaaa", //
                             "a.b...........a", //
                             "a.bbbbbbbbbbb.a", //
                             "..............a", //
                             "aaaaaaaaaaaaaaa"});
  const fem::Parts parts = fem::connected_parts(d);
  ASSERT_EQ(parts.size(), 2);
  std::vector<GO> cells = {parts.part[0].num_cells, parts.part[1].num_cells};
  std::sort(cells.begin(), cells.end());
  EXPECT_EQ(cells[0], 27);
  EXPECT_EQ(cells[1], 67);
}

TEST(Parts, ThatTouchInOneNodeAreOne)
{
  EXPECT_EQ(fem::connected_parts(drawn_body({"aa..", "..bb"})).size(), 1);
}

} // namespace
} // namespace parts_test
