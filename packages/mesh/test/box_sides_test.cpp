// SPDX-License-Identifier: BSD-3-Clause
#include "box_lattice.hpp"
#include "expect_error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/box.hpp"

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace box_sides_test
{
namespace
{

using namespace rpc::test;
using rpc::ExitCode;
using rpc::GO;
using rpc::LO;
using rpc::mesh::Side;

struct Direction {
  std::string name;
  int d;
  bool upper;
};
const std::vector<Direction> &directions()
{
  static const std::vector<Direction> all = {{"left", 0, false}, {"right", 0, true}, {"bottom", 1, false},
                                             {"top", 1, true},   {"back", 2, false}, {"front", 2, true}};
  return all;
}

TEST(Box, SidesAreNamedLeftRightBottomTopBackFront)
{
  for_each_box([](const Made &made) {
    std::vector<std::string> names, expected;
    for (const Side &side : made.mesh.sides) names.push_back(side.name);
    for (int k = 0; k < 2 * made.mesh.dim(); ++k) expected.push_back(directions()[k].name);
    EXPECT_EQ(names, expected);
  });
}

TEST(Box, CornersAreNamedAfterTheSidesThatMeetThere)
{
  for_each_box([](const Made &made) {
    const int dim = made.mesh.dim();
    std::set<std::string> names;
    for (const auto &corner : made.mesh.points) {
      SCOPED_TRACE(corner.name);
      names.insert(corner.name);
      const auto coords = rpc::to_host(made.mesh.coords);
      for (const LO node : corner.node)
        for (int k = 0; k < 2 * dim; ++k) {
          const Direction &side = directions()[k];
          if (corner.name.find(side.name) == std::string::npos) continue;
          const auto &end = side.upper ? made.lattice.box.upper : made.lattice.box.lower;
          EXPECT_EQ(coords(node, side.d), end[side.d]);
        }
      const int here = static_cast<int>(corner.node.size());
      EXPECT_EQ(rpc::sum_all(made.mesh.comm(), here), 1);
      EXPECT_EQ(made.mesh.nodes_of(corner.name, "test"), corner.node);
    }
    EXPECT_EQ(names.size(), dim == 2 ? 4u : 8u);
    EXPECT_EQ(names.count(dim == 2 ? "right bottom" : "right bottom front"), 1u);
  });
}

TEST(Box, NodesOfASideAreThoseOfItsFacets)
{
  for_each_box([](const Made &made) {
    const auto coords = rpc::to_host(made.mesh.coords);
    for (int k = 0; k < 2 * made.mesh.dim(); ++k) {
      const Direction &side = directions()[k];
      const auto &end = side.upper ? made.lattice.box.upper : made.lattice.box.lower;
      std::vector<LO> expected;
      for (LO n = 0; n < made.mesh.num_owned_nodes(); ++n)
        if (coords(n, side.d) == end[side.d]) expected.push_back(n);
      EXPECT_EQ(made.mesh.nodes_of(side.name, "test"), expected) << side.name;
    }
    expect_error(ExitCode::bad_input, {"\"Dirichlet->x->Side\"", "\"nowhere\"", "left", "top", "left bottom"},
                 [&] { made.mesh.nodes_of("nowhere", "Dirichlet->x->Side"); });
  });
}

TEST(Box, SidesHoldEachFacetThatTouchesAnOwnedNodeOnce)
{
  for_each_box([](const Made &made) {
    std::set<GO> owned;
    for (LO n = 0; n < made.mesh.num_owned_nodes(); ++n) owned.insert(made.node_id(n));
    for (int k = 0; k < 2 * made.mesh.dim(); ++k) {
      const Direction &direction = directions()[k];
      SCOPED_TRACE(direction.name);
      const auto on_side = [&](const GO node) {
        const GO end = direction.upper ? made.lattice.extent(direction.d, made.lattice.order) : 0;
        return made.lattice.position(node, made.lattice.order, 1)[direction.d] == end;
      };
      std::set<std::set<GO>> expected, found; // a facet by its nodes
      for (GO c = 0; c < made.lattice.num_cells(); ++c) {
        std::set<GO> facet;
        bool touches = false;
        for (const GO node : made.lattice.nodes_of(made.lattice.cell(c))) {
          if (!on_side(node)) continue;
          facet.insert(node);
          touches = touches || owned.count(node) > 0;
        }
        // a triangle may have a vertex on the side, and no edge
        if (touches && static_cast<int>(facet.size()) == made.mesh.element.num_facet_nodes()) expected.insert(facet);
      }
      const auto facets = rpc::to_host(made.mesh.side(direction.name, "test").facets);
      for (std::size_t f = 0; f < facets.extent(0); ++f) {
        std::set<GO> nodes;
        for (std::size_t a = 0; a < facets.extent(1); ++a) nodes.insert(made.node_id(facets(f, a)));
        found.insert(nodes);
      }
      EXPECT_EQ(found, expected);
      EXPECT_EQ(facets.extent(0), expected.size());
    }
  });
}

TEST(Box, EachFacetOfASideHasItsCellOwnedByOneRank)
{
  for_each_box([](const Made &made) {
    for (int k = 0; k < 2 * made.mesh.dim(); ++k) {
      const Side &side = made.mesh.side(directions()[k].name, "test");
      const auto cell = rpc::to_host(side.cell);
      GO mine = 0, all = 1;
      for (std::size_t f = 0; f < cell.extent(0); ++f) mine += cell(f) < made.mesh.num_owned_cells ? 1 : 0;
      for (int d = 0; d < made.mesh.dim(); ++d) all *= d == directions()[k].d ? 1 : made.box.cells[d];
      if (made.lattice.simplex && made.mesh.dim() == 3) all *= 2; // triangles of a rectangle
      EXPECT_EQ(rpc::sum_all(made.mesh.comm(), mine), all) << side.name;
    }
  });
}

TEST(Box, FacetsBelongToTheirCellsAndPointOutward)
{
  for_each_box([](const Made &made) {
    for (int k = 0; k < 2 * made.mesh.dim(); ++k) {
      const Direction &direction = directions()[k];
      SCOPED_TRACE(direction.name);
      const Side &side = made.mesh.side(direction.name, "test");
      const auto facets = rpc::to_host(side.facets);
      const auto cell = rpc::to_host(side.cell);
      const auto ordinal = rpc::to_host(side.ordinal);
      for (std::size_t f = 0; f < facets.extent(0); ++f) {
        const auto &nodes = made.mesh.element.facets()[ordinal(f)];
        for (std::size_t a = 0; a < nodes.size(); ++a) EXPECT_EQ(facets(f, a), made.cells(cell(f), nodes[a]));
        const auto edge = [&](const int node, const int d) {
          return d < made.mesh.dim() ? made.coords(facets(f, node), d) - made.coords(facets(f, 0), d) : 0.;
        };
        std::array<double, 3> normal{edge(1, 1), -edge(1, 0), 0};
        const int last = made.lattice.simplex ? 2 : 3;
        if (made.mesh.dim() == 3)
          for (int d = 0; d < 3; ++d)
            normal[d] = edge(1, (d + 1) % 3) * edge(last, (d + 2) % 3) - edge(1, (d + 2) % 3) * edge(last, (d + 1) % 3);
        const double length = std::hypot(normal[0], normal[1], normal[2]);
        ASSERT_GT(length, 0);
        EXPECT_NEAR(normal[direction.d] / length, direction.upper ? 1 : -1, 1e-14);
      }
    }
  });
}

TEST(Box, UnknownSideIsRefusedWithTheListOfSides)
{
  const Made made(boxes()[0]);
  expect_error(ExitCode::bad_input, {"\"Contact->Side\"", "\"floor\"", "left, right, bottom, top"},
               [&] { made.mesh.side("floor", "Contact->Side"); });
}

TEST(Box, SideOfAnEntryByItsNameAndSidesInOneTextAreExplained)
{
  const Made made(boxes()[0]);
  expect_error(
      ExitCode::bad_input,
      {"\"Traction->Load 1\" names the side \"Load 1\"", "Name the entry after a side", "as \"Side\". Its sides: left"},
      [&] { made.mesh.side("Load 1", "Traction->Load 1->Side"); });
  for (const std::string both : {"bottom, top", "bottom top", "{bottom;top}", "bottom and top"})
    expect_error(ExitCode::bad_input,
                 {"One entry has one side: write an entry each for \"bottom\", \"top\", in \"Contact->Sides\"."},
                 [&] { made.mesh.side(both, "Contact->Side"); });
  expect_error(ExitCode::bad_input, {"for \"top\"."}, [&] { made.mesh.side("pad, top", "Dirichlet->a->Side"); });
  expect_error(ExitCode::bad_input, {"Did you mean \"bottom\"?"}, [&] { made.mesh.side("bottom,", "Contact->Side"); });
}

} // namespace
} // namespace box_sides_test
