// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "rpc/fem/measure.hpp"
#include "rpc/fem/rigid_motion.hpp"
#include "rpc/mesh/unrolled.hpp"

#include <algorithm>

/// Boxes that repeat themselves: the nodes of joined sides, where cells and facets lie, and what is integrated over them.
namespace periodic_box_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr double period = 2.5; // of all boxes here, along x; in space along z, too

/// As many cells along y as ranks divide.
mesh::BoxOptions periodic_box(const mesh::Element &element)
{
  mesh::BoxOptions box{{-1, 2}, {1.5, 3}, {5, 4}, element};
  if (element.dim == 3) box = {{-1, 2, 0}, {1.5, 3, 0.75}, {5, 4, 3}, element};
  box.periodic = {true, false, element.dim == 3};
  return box;
}

GO num_nodes(const mesh::Mesh &mesh)
{
  return static_cast<GO>(mesh.owned_nodes->getGlobalNumElements());
}

TEST(PeriodicBox, JoinedSidesHaveTheSameNodesAndAreNone)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = periodic_box(element);
    const auto mesh = mesh::make_box(box, world());
    GO nodes = GO(element.order_along(0)) * 5 * (GO(element.order_along(1)) * 4 + 1);
    if (element.dim == 3) nodes *= GO(element.order_along(2)) * 3;
    EXPECT_EQ(num_nodes(mesh), nodes);
    std::vector<std::string> names;
    for (const auto &side : mesh.sides) names.push_back(side.name);
    EXPECT_EQ(names, (std::vector<std::string>{"bottom", "top"}));
    EXPECT_TRUE(mesh.points.empty());
  }
}

/// Of a cell no node is there twice, and each lies where the node does or on the upper side, a period further.
TEST(PeriodicBox, CellsAndFacetsLieAtNodesOrTheirImages)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = periodic_box(element);
    const auto mesh = mesh::make_box(box, world());
    const auto x = to_host(mesh.coords);
    const auto look = [&](const DeviceView<LO **> &nodes_of, const DeviceView<LO **> &places_of) {
      const auto nodes = to_host(nodes_of), places = to_host(places_of);
      GO images = 0;
      for (std::size_t c = 0; c < nodes.extent(0); ++c) {
        std::vector<LO> of_cell;
        for (std::size_t a = 0; a < nodes.extent(1); ++a) {
          of_cell.push_back(nodes(c, a));
          images += places(c, a) != nodes(c, a);
          for (int d = 0; d < element.dim; ++d) {
            const double further = x(places(c, a), d) - x(nodes(c, a), d);
            if (further == 0) continue;
            EXPECT_TRUE(box.periodic[d]);
            EXPECT_NEAR(further, box.upper[d] - box.lower[d], 1e-14);
            EXPECT_NEAR(x(places(c, a), d), box.upper[d], 1e-14);
          }
        }
        std::sort(of_cell.begin(), of_cell.end());
        EXPECT_EQ(std::adjacent_find(of_cell.begin(), of_cell.end()), of_cell.end());
        for (int d = 0; d < element.dim; ++d) {
          double least = x(places(c, 0), d), most = least;
          for (std::size_t a = 1; a < places.extent(1); ++a) {
            least = std::min(least, x(places(c, a), d));
            most = std::max(most, x(places(c, a), d));
          }
          EXPECT_LT(most - least, box.cell_length(d) + 1e-14);
        }
      }
      return sum_all(mesh.comm(), images);
    };
    EXPECT_GT(look(mesh.cells, mesh.places()), 0);
    for (const auto &side : mesh.sides) EXPECT_GT(look(side.facets, side.places()), 0) << side.name;
  }
}

TEST(PeriodicBox, HasTheVolumeAndTheAreasOfTheBox)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = body(periodic_box(element), world());
    const bool space = element.dim == 3;
    const double area = space ? period * 0.75 : period;
    const auto measure = fem::body_measure(d);
    EXPECT_NEAR(measure.volume, area, 1e-13);
    EXPECT_EQ(measure.lower, (Point{-1, 2, 0}));
    EXPECT_EQ(measure.upper, (Point{1.5, 3, space ? 0.75 : 0}));
    for (const char *const name : {"bottom", "top"}) {
      const auto side = fem::side_measure(d, d.mesh->side(name, "test"));
      EXPECT_NEAR(side.area, area, 1e-13) << name;
      EXPECT_LT(length(difference(side.normal, {0, name[0] == 'b' ? -1. : 1., 0})), 1e-13) << name;
    }
    // Expressions are seen at images: the mean of x over the side is that of the box, not less by a cell.
    const fem::TractionLoad load{"top", "top", {ScalarField("x", [](const Point &x) { return x[0]; }), {}, {}}};
    EXPECT_NEAR(fem::resultant(d, load)[0], 0.25 * area, 1e-13);
  }
}

/// A body without end moves without strain, but does not turn in a plane with a direction in which it repeats itself.
TEST(PeriodicBox, TranslationsAndTurnsAboutThePeriodAreItsRigidMotions)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    auto box = periodic_box(element);
    EXPECT_EQ(fem::all_motions(body(box, world())).size(), std::size_t(element.dim));
    box.periodic[2] = false;
    const auto d = body(box, world());
    EXPECT_EQ(fem::all_motions(d).size(), element.dim == 3 ? 4u : 2u);
    const auto energy = [&](const auto &u) {
      return fem::internal_work(d, fem::Material{2000, 0.3}, *interpolate(d, u)).energy_norm_squared;
    };
    const double of_any = energy([](const Point &x) { return Point{x[1], 0, 0}; });
    EXPECT_LT(energy([](const Point &) { return Point{0.3, -0.2, 0.1}; }), 1e-20 * of_any);
    EXPECT_GT(energy([](const Point &x) { return Point{-x[1], x[0], 0}; }), 1e-3 * of_any);
    if (element.dim == 3) {
      EXPECT_LT(energy([](const Point &x) { return Point{0, -x[2], x[1]}; }), 1e-20 * of_any);
    }
  }
}

TEST(PeriodicBox, CoarserOnesArePeriodicWithTwoCellsAtLeast)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    mesh::BoxOptions box = periodic_box(element);
    while (const auto coarse = mesh::coarsened(box)) {
      box = *coarse;
      EXPECT_EQ(box.periodic, periodic_box(element).periodic);
      if (box.cells[1] < world()->getSize()) break;
      const auto mesh = mesh::make_box(box, world());
      GO nodes = 1, places = 1;
      for (int d = 0; d < element.dim; ++d) {
        const GO intervals = GO(box.element.order_along(d)) * box.cells[d];
        if (box.periodic[d]) {
          EXPECT_GE(box.cells[d], 2);
        }
        nodes *= intervals + (box.periodic[d] ? 0 : 1);
        places *= intervals + 1;
      }
      EXPECT_EQ(num_nodes(mesh), nodes);
      if (world()->getSize() == 1) {
        EXPECT_EQ(GO(mesh.coords.extent(0)), places);
      }
    }
    if (world()->getSize() == 1) {
      EXPECT_LE(box.cells[0], 2);
    }
  }
}

TEST(PeriodicBox, UnrolledHasEachValueAtBothEnds)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto mesh = std::make_shared<const mesh::Mesh>(mesh::make_box(periodic_box(element), world()));
    const auto unrolled = mesh::unrolled(mesh);
    GO nodes = 1;
    for (int d = 0; d < element.dim; ++d) nodes *= GO(element.order_along(d)) * mesh->box->cells[d] + 1;
    EXPECT_EQ(num_nodes(*unrolled.mesh), nodes);
    EXPECT_EQ(unrolled.mesh->num_owned_cells, mesh->num_owned_cells);
    const auto x = to_host(mesh->coords), of_file = to_host(unrolled.mesh->coords);
    HostView<double *> values("values", mesh->num_owned_nodes());
    for (int d = 0; d < element.dim; ++d) {
      for (LO n = 0; n < mesh->num_owned_nodes(); ++n) values(n) = x(n, d);
      const auto at = unrolled.at_nodes(values);
      ASSERT_EQ(at.extent(0), std::size_t(unrolled.mesh->num_owned_nodes()));
      for (LO n = 0; n < unrolled.mesh->num_owned_nodes(); ++n) {
        const double length = mesh->box->upper[d] - mesh->box->lower[d];
        const bool upper = mesh->box->periodic[d] && of_file(n, d) > mesh->box->upper[d] - 1e-12;
        EXPECT_NEAR(at(n), of_file(n, d) - (upper ? length : 0), 1e-14);
      }
    }
  }
  const auto plain = std::make_shared<const mesh::Mesh>(mesh::make_box(small_box({2, 1}), world()));
  EXPECT_EQ(mesh::unrolled(plain).mesh, plain);
}

} // namespace
} // namespace periodic_box_test
