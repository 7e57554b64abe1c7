// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/facets.hpp"

#include "blocks.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace facets_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::FacetSurface;
using contact::StraightFacets;

TEST(FacetSurface, OfSegmentsIsMetFromInsideAtTheNearestPlace)
{
  // Two runs one below the other, from left to right: their normals lead down.
  const FacetSurface surface(StraightFacets{2, {0, 0, 1, 0, 1, 0, 2, 1, 0, -3, 2, -3}, {1, 2, 2, 4, 7, 7}});
  const Point down = {0, -1, 0}, up = {0, 1, 0};
  EXPECT_NEAR(surface.along({0.25, 5, 0}, down).value().value, 1.25, 1e-14);
  EXPECT_NEAR(surface.along({0.25, -1, 0}, down).value().value, 1.25, 1e-14) << "behind";
  EXPECT_NEAR(surface.along({0.25, -2, 0}, down).value().value, 7, 1e-14);
  EXPECT_NEAR(surface.along({1.5, 0, 0}, down).value().value, 3, 1e-14);
  EXPECT_NEAR(surface.along({1.5, 0.5, 0}, {std::sqrt(0.5), -std::sqrt(0.5), 0}).value().value, 3, 1e-14);
  EXPECT_FALSE(surface.along({0.25, 0, 0}, up)) << "its normals lead the other way";
  EXPECT_FALSE(surface.along({5, 0, 0}, down));
}

TEST(FacetSurface, EndsHalfAFacetBeyondItsEdgeOrWhereItIsTold)
{
  const StraightFacets facets{2, {0, 0, 1, 0, 1, 0, 2, 0}, {1, 2, 2, 4}};
  const Point down = {0, -1, 0};
  EXPECT_EQ(FacetSurface(facets).along({2.4, 0, 0}, down).value().value, 4);
  EXPECT_EQ(FacetSurface(facets).along({-0.4, 0, 0}, down).value().value, 1);
  EXPECT_FALSE(FacetSurface(facets).along({2.6, 0, 0}, down));
  EXPECT_EQ(FacetSurface(facets, 0.7).along({2.6, 0, 0}, down).value().value, 4);
  EXPECT_FALSE(FacetSurface(facets, 0.7).along({2.8, 0, 0}, down));
}

TEST(FacetSurface, WithoutFacetsIsMetNowhere)
{
  EXPECT_FALSE(FacetSurface(StraightFacets{3, {}, {}}).along({0, 0, 0}, {0, -1, 0}));
}

/// The same direction for all; each rank asks for all lines.
std::vector<std::optional<double>> values_of_all(const FacetSurface &mine, const std::vector<Point> &x,
                                                 const Point &direction)
{
  std::vector<std::optional<double>> values;
  for (const auto &met :
       contact::meetings_along(*Tpetra::getDefaultComm(), mine, x, std::vector<Point>(x.size(), direction)))
    values.push_back(met ? std::optional<double>(met->value) : std::nullopt);
  return values;
}

/// This rank's facets of a side, each node where `place` says.
StraightFacets facets_of(const fem::Discretization &d, const std::string &name, const PointFunction &place,
                         const Function &values)
{
  const mesh::Side &side = d.mesh->side(name, "test");
  const auto facets = to_host(side.facets);
  const auto cell = to_host(side.cell);
  std::vector<Point> places;
  std::vector<double> at;
  for (std::size_t f = 0; f < facets.extent(0); ++f)
    for (std::size_t a = 0; a < facets.extent(1) && cell(f) < d.mesh->num_owned_cells; ++a) {
      const Point x = place_of(d, facets(f, a));
      places.push_back(place(x));
      at.push_back(values(x));
    }
  return contact::straight_facets(d.mesh->element.facet(), places, at);
}

/// Each rank has a segment of [0, ranks], and a lower one of another value below it.
TEST(FacetSurface, OfAllRanksIsMetAtTheNearestPlace)
{
  const auto comm = Tpetra::getDefaultComm();
  const double r = comm->getRank(), ranks = comm->getSize();
  const double below = ranks - 1 - r; // the lower ones are dealt out the other way round
  const FacetSurface mine(
      StraightFacets{2, {r, 0, r + 1, 0, below, -3, below + 1, -3}, {r, r + 1, 10 + below, 11 + below}});
  const double mid = 0.3 + 0.5 * (ranks - 1);
  const auto found = values_of_all(
      mine, {{mid, 5, 0}, {mid, -1, 0}, {mid, -2, 0}, {ranks + 0.4, 0, 0}, {ranks + 2, 0, 0}}, {0, -1, 0});
  EXPECT_NEAR(found[0].value(), mid, 1e-14);
  EXPECT_NEAR(found[1].value(), mid, 1e-14) << "behind";
  EXPECT_NEAR(found[2].value(), 10 + mid, 1e-14);
  EXPECT_EQ(found[3].value(), ranks) << "half a facet beyond the edge";
  EXPECT_FALSE(found[4]);
}

TEST(FacetSurface, OfARankWithoutFacetsIsMetOnOthers)
{
  const auto comm = Tpetra::getDefaultComm();
  const bool has = comm->getRank() + 1 == comm->getSize();
  const FacetSurface mine(has ? StraightFacets{2, {0, 0, 1, 0}, {1, 2}} : StraightFacets{2, {}, {}});
  EXPECT_NEAR(values_of_all(mine, {{0.5, 1, 0}}, {0, -1, 0})[0].value(), 1.5, 1e-14);
  EXPECT_TRUE(contact::meetings_along(*comm, mine, {}, {}).empty());
}

TEST(FacetSurface, OfASideMeetsLinearValuesToRounding)
{
  const Function linear = [](const Point &x) { return 2 + 0.5 * x[0] - 0.75 * x[2]; };
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto d = block(element);
    // Moved along itself, tilted and stretched, and then looked up as it lies.
    const PointFunction move = [](const Point &x) {
      return Point{0.3 + 1.1 * x[0], 4 + x[1] + 0.2 * x[0] - 0.1 * x[2], x[2] + 0.2 * x[0]};
    };
    const FacetSurface still(facets_of(
        d, "bottom", [](const Point &x) { return x; }, linear));
    const FacetSurface moved(facets_of(d, "bottom", move, linear));
    const Point down = {0, -1, 0}, aslant = {0.6, -0.8, 0};
    std::vector<Point> above, beside, at_moved;
    std::vector<double> expected;
    for (int k = 0; k <= 20; ++k) {
      const Point x = {1 + 0.1 * k, 0, element.dim == 3 ? -0.5 + 0.5 * std::sin(5. * k) : 0};
      above.push_back({x[0], 3, x[2]});
      beside.push_back({x[0] - 0.6, 0.8, x[2]});
      Point y = move(x);
      for (int c = 0; c < 3; ++c) y[c] = c < element.dim ? y[c] - 0.1 * aslant[c] : 0;
      at_moved.push_back(y);
      expected.push_back(linear(x));
    }
    const auto from_above = values_of_all(still, above, down), from_beside = values_of_all(still, beside, aslant),
               of_moved = values_of_all(moved, at_moved, aslant);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_NEAR(from_above[k].value(), expected[k], 1e-14) << element.name();
      EXPECT_NEAR(from_beside[k].value(), expected[k], 1e-14) << element.name();
      EXPECT_NEAR(of_moved[k].value(), expected[k], 1e-13) << element.name();
    }
  }
}

TEST(FacetSurface, OfABentSideIsOfSecondOrder)
{
  // The bottom is an arc of radius 2 about the origin, the body around it: its normals lead to the origin.
  const PointFunction bend = [](const Point &x) {
    const double angle = x[0] - 2, radius = 2 + x[1];
    return Point{radius * std::sin(angle), radius * std::cos(angle), x[2]};
  };
  const Function values = [](const Point &x) { return std::sin(3 * std::atan2(x[0], x[1])) * (1 + x[2]); };
  for (const mesh::Element &element : mesh::all_elements()) {
    double worst[2] = {};
    for (const int refinement : {1, 2}) {
      const auto d = block(element, bend, refinement);
      const FacetSurface surface(facets_of(
          d, "bottom", [](const Point &x) { return x; }, values));
      std::vector<Point> places, inside, inwards;
      for (int k = 0; k <= 97; ++k) {
        const double angle = -1 + 2 * k / 97.;
        const Point x = {2 * std::sin(angle), 2 * std::cos(angle), element.dim == 3 ? -0.3 : 0};
        places.push_back(x);
        inside.push_back({0.9 * x[0], 0.9 * x[1], x[2]});
        inwards.push_back({-x[0] / 2, -x[1] / 2, 0});
      }
      const auto met = contact::meetings_along(*Tpetra::getDefaultComm(), surface, inside, inwards);
      for (std::size_t k = 0; k < met.size(); ++k) {
        ASSERT_TRUE(met[k]) << element.name();
        worst[refinement - 1] = std::max(worst[refinement - 1], std::abs(met[k]->value - values(places[k])));
      }
    }
    EXPECT_LT(worst[0], 0.08) << element.name() << " in " << element.dim;
    EXPECT_GT(worst[0] / worst[1], 3) << element.name() << " in " << element.dim;
  }
}

} // namespace
} // namespace facets_test
