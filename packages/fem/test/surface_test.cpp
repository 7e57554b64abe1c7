// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/surface.hpp"

#include "bodies.hpp"
#include "rpc/fem/elasticity.hpp"

#include <set>

namespace surface_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// Weight and normal of each node of a side by node id; weight 0 off the side. `dim + 1` numbers to a node.
std::vector<double> weights_and_normals(const fem::Discretization &d, const std::string &side)
{
  const auto surface = fem::surface_nodes(d, d.mesh->side(side, "test"));
  const auto node = to_host(surface.node);
  const auto weight = to_host(surface.weight);
  const auto normal = to_host(surface.normal);
  std::vector<std::vector<double>> of_node(d.mesh->num_owned_nodes(), std::vector<double>(d.dim() + 1, 0.));
  for (std::size_t i = 0; i < node.extent(0); ++i) {
    EXPECT_TRUE(i == 0 || node(i - 1) < node(i)); // ascending
    of_node[node(i)][0] = weight(i);
    for (int c = 0; c < d.dim(); ++c) of_node[node(i)][1 + c] = normal(i, c);
  }
  return by_node_id(*d.mesh, d.dim() + 1, [&](const LO n, const int k) { return of_node[n][k]; });
}

/// Weights along the bottom of a 2D box, from left to right.
std::vector<double> bottom_weights(const mesh::BoxOptions &box)
{
  const auto all = weights_and_normals(body(box, world()), "bottom");
  std::vector<double> weights;
  for (int k = 0; k <= box.cells[0] * box.element.order; ++k) weights.push_back(all[3 * k]);
  return weights;
}

TEST(SurfaceNodes, Q1WeightsAreTheTrapezoidRule)
{
  EXPECT_LT(difference(bottom_weights({{0, 0}, {6, 1}, {4, 1}, {2, 1}}), {0.75, 1.5, 1.5, 1.5, 0.75}), 1e-15);
}

TEST(SurfaceNodes, Q2WeightsAreSimpsonsRule)
{
  EXPECT_LT(difference(bottom_weights({{0, 0}, {9, 1}, {3, 1}, {2, 2}}), {0.5, 2, 1, 2, 1, 2, 0.5}), 1e-15);
}

TEST(SurfaceNodes, Q1WeightsIn3dAreTheProductRule)
{
  const auto d = body({{0, 0, 0}, {3, 1, 2}, {3, 1, 2}, {3, 1}}, world());
  const auto all = weights_and_normals(d, "bottom");
  std::vector<double> weights, expected;
  for (int z = 0; z <= 2; ++z) {
    for (int x = 0; x <= 3; ++x) {
      weights.push_back(all[4 * (x + 4 * 2 * z)]);
      expected.push_back((x % 3 == 0 ? 0.5 : 1) * (z % 2 == 0 ? 0.5 : 1));
    }
  }
  EXPECT_LT(difference(weights, expected), 1e-15);
}

TEST(SurfaceNodes, WeightsArePositiveOnTheSideAloneAndSumToItsArea)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    for (const auto &side : d.mesh->sides) {
      SCOPED_TRACE(side.name);
      const int across = side.name == "left" || side.name == "right"   ? 0
                         : side.name == "bottom" || side.name == "top" ? 1
                                                                       : 2;
      const bool upper = side.name == "right" || side.name == "top" || side.name == "front";
      double area = 1, sum = 0;
      int without = 0;
      for (int c = 0; c < d.dim(); ++c) area *= c == across ? 1 : box.upper[c] - box.lower[c];
      const auto all = weights_and_normals(d, side.name);
      const auto points = by_node_id(*d.mesh, d.dim(), [&](const LO n, const int c) { return point_of(d, n)[c]; });
      for (std::size_t node = 0; node < all.size() / (d.dim() + 1); ++node) {
        const double weight = all[(d.dim() + 1) * node];
        sum += weight;
        const bool on_side = points[d.dim() * node + across] == (upper ? box.upper : box.lower)[across];
        EXPECT_TRUE(weight >= 0 && (weight == 0 || on_side)) << weight;
        without += on_side && weight == 0;
        if (!on_side) continue;
        for (int c = 0; c < d.dim(); ++c)
          EXPECT_NEAR(all[(d.dim() + 1) * node + 1 + c], c == across ? (upper ? 1 : -1) : 0, 1e-14);
      }
      EXPECT_NEAR(sum, area, 1e-14 * area);
      int vertices = 1;
      for (int c = 0; c < d.dim(); ++c) vertices *= c == across ? 1 : box.cells[c] + 1;
      const bool quadratic_triangles = element == mesh::Element{3, 2, mesh::Shape::simplex};
      EXPECT_EQ(without, quadratic_triangles ? vertices : 0);
    }
  }
}

TEST(SurfaceNodes, WeightsAreTheForcesOfAUniformPressureOnFacetsOfAnyShape)
{
  for (const auto &element : elements()) {
    if (element == mesh::Element{3, 2, mesh::Shape::simplex}) continue; // curved by the map
    SCOPED_TRACE(text_of(element));
    const auto d = body(small_box(element), world(), [](const Point &x) {
      return Point{x[0] * (1 + 0.5 * x[2]), x[1], x[2] * (1 + 0.3 * x[0])}; // straight edges, no parallelograms
    });
    Vector load(d.owned_dofs);
    fem::add_traction(d, d.mesh->side("bottom", "test"), {ScalarField(0), ScalarField(1), ScalarField(0)}, "test",
                      load);
    const auto force = load.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto all = weights_and_normals(d, "bottom");
    std::vector<double> weight;
    for (std::size_t k = 0; k < all.size(); k += d.dim() + 1) weight.push_back(all[k]);
    EXPECT_LT(difference(weight, by_node_id(*d.mesh, 1, [&](const LO n, int) { return force(d.dim() * n + 1, 0); })),
              1e-14);
  }
}

/// A body whose bottom is a wave.
fem::Discretization wavy_body(const mesh::Element &element, const RCP<const Comm> &comm)
{
  return body(small_box(element), comm, [](const Point &x) {
    return Point{x[0], x[1] + 0.2 * (3 - x[1]) * std::sin(2 * x[0] + x[2]), x[2]};
  });
}

TEST(SurfaceNodes, AreTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    for (const char *side : {"bottom", "left", "top"})
      EXPECT_LT(difference(weights_and_normals(wavy_body(element, world()), side),
                           weights_and_normals(wavy_body(element, alone()), side)),
                1e-14);
  }
}

TEST(SurfaceNodes, NormalsOfACurvedSideHaveUnitLength)
{
  for (const auto &element : elements()) {
    const int stride = element.dim + 1;
    const auto all = weights_and_normals(wavy_body(element, world()), "bottom");
    int on_side = 0;
    for (std::size_t node = 0; node < all.size() / stride; ++node) {
      if (all[stride * node] == 0) continue;
      ++on_side;
      double square = 0;
      for (int c = 0; c < element.dim; ++c) square += std::pow(all[stride * node + 1 + c], 2);
      EXPECT_NEAR(square, 1, 1e-14);
    }
    EXPECT_GT(on_side, 2);
  }
}

TEST(SurfaceNodes, NormalAtAKinkIsTheMeanByArea)
{
  // The bottom falls by 45 degrees over the first cell and is level after it: area normals (-1, -1) and (0, -1).
  const auto d = body({{0, 0}, {3, 2}, {3, 2}, {2, 1}}, world(), [](const Point &x) {
    return Point{x[0], x[1] + (2 - x[1]) / 2 * std::max(0., 1 - x[0]), x[2]};
  });
  const auto all = weights_and_normals(d, "bottom");
  const std::vector<double> kink(all.begin() + 3, all.begin() + 6);
  EXPECT_LT(difference(kink, {(std::sqrt(2.) + 1) / 2, -1 / std::sqrt(5.), -2 / std::sqrt(5.)}), 1e-15);
}

TEST(SurfaceNodes, DegenerateFacetsAreABadMeshOnEveryRank)
{
  const auto d =
      body({{0, 0}, {3, 3}, {3, 3}, {2, 1}}, world(), [](const Point &x) { // two facets at the left are points
        return Point{std::max(2., x[0]), x[1], x[2]};
      });
  expect_error(ExitCode::bad_mesh, {"2 nodes", "\"bottom\""},
               [&] { fem::surface_nodes(d, d.mesh->side("bottom", "test")); });
}

/// A nodal vector with value(id) for owned nodes.
template <class Value>
Vector nodal(const fem::Discretization &d, const Value &value)
{
  Vector result(d.mesh->owned_nodes);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) result.replaceLocalValue(n, value(d.mesh->node_id(n)));
  return result;
}
std::vector<double> extended(const fem::Discretization &d, const std::set<GO> &known,
                             const std::function<double(GO)> &value)
{
  Vector flags = nodal(d, [&](const GO id) { return known.count(id) > 0 ? 1. : 0.; });
  Vector result = nodal(d, [&](const GO id) { return known.count(id) > 0 ? value(id) : -99.; });
  fem::extend_to_unknown(d, d.mesh->side("bottom", "test"), result, flags);
  const auto values = result.getLocalViewHost(Tpetra::Access::ReadOnly);
  return by_node_id(*d.mesh, 1, [&](const LO n, int) { return values(n, 0); });
}

TEST(ExtendToUnknown, UnknownNodesGetTheMeanOfTheirKnownNeighbours)
{
  // Bottom nodes 0 .. 6; 0, 3 and 6 are unknown.
  const auto d = body({{0, 0}, {6, 1}, {6, 1}, {2, 1}}, world());
  const auto all = extended(d, {1, 2, 4, 5}, [](const GO id) { return double(id * id); });
  EXPECT_EQ(std::vector<double>(all.begin(), all.begin() + 7), (std::vector<double>{1, 1, 4, 10, 16, 25, 25}));
}

TEST(ExtendToUnknown, EndsOfQuadraticEdgesGetTheLineThroughTheOtherNodes)
{
  for (const auto shape : {mesh::Shape::tensor, mesh::Shape::simplex}) {
    // Bottom nodes 0 .. 6, of three edges; 0, 4 and, in the middle of the last edge, 5 are unknown.
    const auto d = body({{0, 0}, {3, 1}, {3, 1}, {2, 2, shape}}, world());
    const auto all = extended(d, {1, 2, 3, 6}, [](const GO id) { return 3. - double(id); });
    EXPECT_EQ(std::vector<double>(all.begin(), all.begin() + 7), (std::vector<double>{3, 2, 1, 0, -1, -3, -3}));
  }
}

TEST(ExtendToUnknown, TheAxisGetsTheParabolaWithoutSlope)
{
  const auto d = body({{0, 0}, {3, 1}, {3, 1}, {2, 2}}, world(), {}, fem::Kinematics::axisymmetric);
  const auto all = extended(d, {1, 2, 3, 4, 5}, [](const GO id) { return 8. - double(id * id); });
  EXPECT_NEAR(all[0], 8, 1e-14);
  EXPECT_NEAR(all[6], 2 * (8 - 25) - (8 - 16), 1e-13); // the other end: the line
}

TEST(ExtendToUnknown, NodesWithoutKnownNeighboursGetZero)
{
  const auto d = body({{0, 0}, {6, 1}, {6, 1}, {2, 1}}, world());
  const auto all = extended(d, {0}, [](GO) { return 7.; });
  EXPECT_EQ(std::vector<double>(all.begin(), all.begin() + 7), (std::vector<double>{7, 7, 0, 0, 0, 0, 0}));
}

TEST(ExtendToUnknown, IsTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    std::set<GO> known;
    for (GO id = 0; id < 100; ++id)
      if (id % 3 == 1) known.insert(id);
    const auto value = [](const GO id) { return std::sin(double(id)); };
    EXPECT_LT(difference(extended(body(small_box(element), world()), known, value),
                         extended(body(small_box(element), alone()), known, value)),
              1e-14);
  }
}

} // namespace
} // namespace surface_test
