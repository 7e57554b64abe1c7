// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/hinges.hpp"

#include "bodies.hpp"
#include "drawn_mesh.hpp"

#include <map>

namespace hinges_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

fem::DirichletCondition hold(const std::string &side, const std::vector<int> &components)
{
  fem::DirichletCondition condition{side, side, {}};
  for (const int c : components) condition.displacement[c] = ScalarField(0.);
  return condition;
}
using Held = std::vector<fem::DirichletCondition>;

void check(const mesh::MeshData &mesh, const Held &held)
{
  const auto d = fem::discretize(distributed(mesh));
  fem::require_stiff_joints(d, fem::dirichlet_dofs(d, held));
}
void check(const std::vector<std::string> &rows, const Held &held)
{
  check(drawn(rows), held);
}

/// Refused, naming what stands in `parts`.
template <class Mesh>
void refuses(const Mesh &mesh, const Held &held, const std::initializer_list<std::string> &parts)
{
  expect_error(ExitCode::no_solution, parts, [&] { check(mesh, held); });
}

const std::vector<std::string> corner = {"aa..", "..bb"};

TEST(Hinges, OfTwoSquaresInACornerTurn)
{
  refuses(corner, {hold("a left", {0, 1})},
          {"joins a piece of 2 cells around (1, 1.5) and one of 2 cells around (3, 0.5) in single points only",
           "as at (2, 1)", "Join them over an edge of cells", "\"Dirichlet\""});
  refuses(corner, {}, {"as at (2, 1)"});
  refuses(corner, {hold("a left", {0, 1}), hold("b top", {0})}, {"as at (2, 1)"}); // the hinge lies on that line
}

TEST(Hinges, ThatPrescribedDisplacementsStopAreStiff)
{
  check(corner, {hold("a left", {0, 1}), hold("b right", {0, 1})});
  check(corner, {hold("a left", {0, 1}), hold("b right", {0})});
  check(corner, {hold("a left", {0, 1}), hold("b bottom", {1})});
}

TEST(Hinges, ATriangleOfThemIsStiff)
{
  const std::vector<std::string> triangle = {".b.", "a.c", ".cc"};
  check(triangle, {});
  check(triangle, {hold("a left", {0, 1})});
}

TEST(Hinges, ARingOfFourSquaresIsAMechanism)
{
  const std::vector<std::string> ring = {".b.", "a.c", ".d."};
  refuses(ring, {hold("a left", {0, 1})}, {"1 cell around"});
  check(ring, {hold("a left", {0, 1}), hold("c right", {0, 1})}); // an arch on either side
}

TEST(Hinges, AChainHangsTogetherByTheOnesThatAreHeld)
{
  const std::vector<std::string> chain = {"a....", ".b...", "..c..", "...d.", "....e"};
  refuses(chain, {hold("a left", {0, 1}), hold("e right", {0, 1})}, {"as at"});
  check(chain, {hold("a left", {0, 1}), hold("b bottom", {1}), hold("c bottom", {1}), hold("d bottom", {1}),
                hold("e bottom", {1})});
}

TEST(Hinges, ABodyThatTouchesItselfInACornerHasNone)
{
  check({"aaa", "a.a", "aa.", "aaa"}, {});
  check({"aaaa", "a..a", "aa.a", "a.aa", "aaaa"}, {hold("a left", {0})});
}

TEST(Hinges, ManyPiecesInPointsAreRefused)
{
  std::vector<std::string> board(21);
  for (int j = 0; j < 21; ++j)
    for (int i = 0; i < 21; ++i) board[j] += (i + j) % 2 ? '.' : 'a';
  refuses(board, {}, {"joins 221 pieces of the body in single points only"});
}

TEST(Hinges, OrdinaryBodiesHaveNone)
{
  for (const mesh::Element &element : elements()) {
    const auto d = bulged_body(element, world());
    fem::require_stiff_joints(d, fem::dirichlet_dofs(d, {}));
  }
}

/// Unit cubes at the given places.
mesh::MeshData cubes(const std::vector<std::array<int, 3>> &places)
{
  mesh::MeshData mesh;
  mesh.element = {3, 1};
  mesh.blocks = {"all"};
  std::map<std::array<int, 3>, int> node;
  for (const auto &place : places) {
    const int cell = static_cast<int>(mesh.block.size());
    mesh.block.push_back(0);
    for (const auto &corner : mesh.element.lattice()) {
      const std::array<int, 3> at{place[0] + corner[0], place[1] + corner[1], place[2] + corner[2]};
      const auto [entry, fresh] = node.emplace(at, static_cast<int>(node.size()));
      if (fresh)
        for (const int x : at) mesh.coords.push_back(x);
      mesh.cells.push_back(entry->second);
    }
    mesh.sides.push_back({"cube" + std::to_string(cell), {cell}, {3}}); // its face x = 0
  }
  return mesh;
}

TEST(Hinges, InSpaceTurnAboutEdgesAndPoints)
{
  if (world()->getSize() > 2) GTEST_SKIP() << "two cells";
  const Held one = {hold("cube0", {0, 1, 2})}, both = {hold("cube0", {0, 1, 2}), hold("cube1", {0, 1, 2})};
  const mesh::MeshData edge = cubes({{0, 0, 0}, {1, 1, 0}}), point = cubes({{0, 0, 0}, {1, 1, 1}});
  refuses(edge, one, {"or along edges only", "as at (1, 1, ", "over a face of cells"});
  refuses(point, one, {"as at (1, 1, 1)"});
  check(edge, both);
  check(point, both);
  check(edge, {hold("cube0", {0, 1, 2}), hold("cube1", {0})});
  refuses(point, {hold("cube0", {0, 1, 2}), hold("cube1", {0})}, {"as at (1, 1, 1)"}); // turns about x
  check(cubes({{0, 0, 0}, {1, 0, 0}}), one);
}

} // namespace
} // namespace hinges_test
