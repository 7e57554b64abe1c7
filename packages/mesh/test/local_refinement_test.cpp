// SPDX-License-Identifier: BSD-3-Clause
// Triangles and tetrahedra that are halved where a field of sizes asks for it.

#include "ancestor.hpp"
#include "expect_error.hpp"
#include "refined_meshes.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "rpc/mesh/refinement.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numeric>

namespace local_refinement_test
{
namespace
{

using namespace rpc;
using mesh::Element;
using mesh::Mesh;
using mesh::MeshData;
using mesh::Shape;
using mesh::SizeField;
using test::alone;
using test::dealt;
using test::Shared;
using test::sheared_block;
using test::world;

/// The field on the cells of a serial mesh, by the vertices' places.
SizeField field_on(const Mesh &mesh, const std::function<double(const double *)> &size)
{
  SizeField field;
  field.dim = mesh.dim();
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  for (LO n = 0; n < mesh.num_local_nodes(); ++n) {
    double x[3] = {};
    for (int d = 0; d < field.dim; ++d) field.coords.push_back(x[d] = coords(n, d));
    field.size.push_back(size(x));
  }
  for (LO c = 0; c < mesh.num_cells(); ++c)
    for (int v = 0; v <= field.dim; ++v) field.simplices.push_back(cells(c, v));
  return field;
}

/// Sizes that grow from a corner of the sheared block, on a mesh that is finer than the block.
SizeField graded(const int dim, const double least, const double growth = 0.3)
{
  Shared mesh = dealt(sheared_block({dim, 1, Shape::simplex}), alone());
  for (int k = 0; k < 3; ++k) mesh = std::make_shared<Mesh>(mesh::refined(mesh));
  return field_on(*mesh, [&](const double *x) { return least + growth * std::hypot(x[0], x[1], x[2]); });
}

template <class Check>
void for_each_simplex(const Check &check)
{
  for (const int dim : {2, 3})
    for (const int order : {1, 2}) {
      SCOPED_TRACE(std::to_string(dim) + "D, order " + std::to_string(order));
      check(Element{dim, order, Shape::simplex});
    }
}

template <int dim>
double size_of(const Mesh &mesh, const LO cell)
{
  mesh::SimplexVertices<dim> vertex;
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  for (int v = 0; v <= dim; ++v)
    for (int d = 0; d < dim; ++d) vertex[v][d] = coords(cells(cell, v), d);
  return mesh::cell_size<dim>(vertex);
}

double size_of(const Mesh &mesh, const LO cell)
{
  return mesh.dim() == 2 ? size_of<2>(mesh, cell) : size_of<3>(mesh, cell);
}

TEST(LocalRefinement, MeetsTheSizesThatWereAskedForWithAboutAsManyCells)
{
  for_each_simplex([](const Element &element) {
    const int dim = element.dim;
    const double least = dim == 2 ? 0.01 : 0.05, growth = 0.1;
    const SizeField field = graded(dim, least, growth);
    const Shared fine = mesh::refined_to(dealt(sheared_block(element), world()), field);
    for (LO c = 0; c < fine->num_owned_cells; ++c) {
      double centre[3] = {};
      for (int v = 0; v <= dim; ++v)
        for (int d = 0; d < dim; ++d) centre[d] += test::places(*fine, c, {v})[0][d] / (dim + 1);
      const double wanted = least + growth * std::hypot(centre[0], centre[1], centre[2]);
      EXPECT_LT(size_of(*fine, c), 1.03 * std::pow(2, 1. / (2 * dim)) * wanted); // the field is linear in parts
    }
    const double cells = static_cast<double>(sum_all(fine->comm(), GO(fine->num_owned_cells)));
    EXPECT_GT(cells, 0.8 * mesh::expected_cells(field));
    EXPECT_LT(cells, 1.8 * mesh::expected_cells(field));
  });
}

TEST(LocalRefinement, IsConformingAndKeepsTheBodyItsSidesAndItsPoints)
{
  for_each_simplex([](const Element &element) {
    const Shared coarse = dealt(sheared_block(element), world());
    const Shared fine = mesh::refined_to(coarse, graded(element.dim, element.dim == 2 ? 0.01 : 0.08));
    EXPECT_GT(test::expect_conforming(*fine), 2 * test::expect_conforming(*coarse));
    const double volume = element.dim == 2 ? 6 : 12;
    EXPECT_NEAR(test::body_measure(*fine), volume, 1e-12 * volume);
    for (const char *const side : {"low", "high", "rest"}) {
      const double size = test::side_measure(*coarse, side);
      EXPECT_NEAR(test::side_measure(*fine, side), size, 1e-12 * size) << side;
    }
    EXPECT_EQ(fine->blocks, coarse->blocks);
    ASSERT_EQ(fine->points.size(), 2u);
    EXPECT_EQ(sum_all(fine->comm(), GO(fine->points[0].node.size() + fine->points[1].node.size())), 2);
  });
}

TEST(LocalRefinement, IsTheSameOnAnyNumberOfRanks)
{
  for_each_simplex([](const Element &element) {
    const MeshData whole = sheared_block(element);
    const SizeField field = graded(element.dim, element.dim == 2 ? 0.01 : 0.08);
    const Shared mesh = mesh::refined_to(dealt(whole, world()), field),
                 serial = mesh::refined_to(dealt(whole, alone()), field);
    EXPECT_GT(serial->num_cells(), 2 * whole.num_cells());
    for (Shared part = mesh, all = serial; part; part = test::ancestor(part, 1), all = test::ancestor(all, 1)) {
      test::expect_part_of(*all, *part);
      test::expect_cells_around_owned_nodes(*all, *part);
    }
  });
}

/// From tetrahedra of several shapes to a corner, over 30 halvings: no cell gets worse than a part of the first ones, and the last levels add
/// nothing to that.
TEST(LocalRefinement, TetrahedraDoNotDegenerate)
{
  for (const Shared &mesh : test::tetrahedra()) {
    const double first = test::worst_quality(*mesh);
    double coarser = 0;
    for (const double least : {1e-1, 1e-3, 1e-6}) {
      SizeField field = field_on(*mesh, [](const double *) { return 1; });
      field.size = {least, 1, 1, 1};
      // Linear between the vertices: sizes grow from the first one as the distance from it.
      const Shared fine = mesh::refined_to(mesh, field);
      const double worst = test::worst_quality(*fine);
      EXPECT_GT(worst, 0.25 * first) << least;
      if (least < 1e-2) {
        EXPECT_GT(worst, 0.9 * coarser) << least;
      }
      coarser = worst;
    }
  }
}

/// Of a P2 mesh a point in the middle of an edge, which is no vertex, stays a node of its set.
TEST(LocalRefinement, KeepsPointsInTheMiddleOfEdges)
{
  for (const int dim : {2, 3}) {
    MeshData body = sheared_block({dim, 2, Shape::simplex});
    const auto &edge = body.element.edges().front();
    const int node = body.cells[edge.back()];
    body.points.push_back({"middle", {node}});
    const std::vector<double> at(body.coords.begin() + std::ptrdiff_t(dim) * node,
                                 body.coords.begin() + std::ptrdiff_t(dim) * (node + 1));
    const Shared fine = mesh::refined_to(dealt(body, world()), graded(dim, dim == 2 ? 0.02 : 0.1));
    EXPECT_GT(sum_all(fine->comm(), GO(fine->num_owned_cells)), body.num_cells());
    const std::vector<LO> &kept = fine->points.back().node;
    EXPECT_EQ(sum_all(fine->comm(), GO(kept.size())), 1);
    const auto coords = to_host(fine->coords);
    for (const LO n : kept)
      for (int d = 0; d < dim; ++d) EXPECT_EQ(coords(n, d), at[d]);
  }
}

TEST(LocalRefinement, TrianglesKeepHalfOfTheLeastAngle)
{
  const auto least_angle = [](const Mesh &mesh) {
    double least = M_PI;
    for (LO c = 0; c < mesh.num_cells(); ++c) {
      const auto x = test::places(mesh, c, {0, 1, 2});
      for (int v = 0; v < 3; ++v) {
        const auto &a = x[v], &b = x[(v + 1) % 3], &d = x[(v + 2) % 3];
        const double p[2] = {b[0] - a[0], b[1] - a[1]}, q[2] = {d[0] - a[0], d[1] - a[1]};
        least = std::min(least, std::atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]));
      }
    }
    return least;
  };
  const Shared coarse = dealt(sheared_block({2, 1, Shape::simplex}), alone());
  for (const double least : {1e-2, 1e-4})
    EXPECT_GE(least_angle(*mesh::refined_to(coarse, graded(2, least))),
              0.5 * least_angle(*coarse)); // Rosenberg, Stenger 1975
}

/// Straight cells: the weights of a parent's nodes give the places of its children's nodes.
TEST(LocalRefinement, LeadsBackToItsParents)
{
  for_each_simplex([](const Element &element) {
    const Shared coarse = dealt(sheared_block(element), world());
    Shared fine = mesh::refined_to(coarse, graded(element.dim, element.dim == 2 ? 0.005 : 0.04));
    int levels = 0;
    for (; fine != coarse; fine = test::ancestor(fine, 1), ++levels) {
      ASSERT_TRUE(fine->parents);
      const Mesh &parent = *fine->parents->mesh;
      const auto weights = mesh::child_weights(parent.element, fine->element, fine->parents->vertices);
      const auto cells = to_host(fine->cells), parents = to_host(parent.cells);
      const auto x = to_host(fine->coords), X = to_host(parent.coords);
      for (LO c = 0; c < fine->num_cells(); ++c)
        for (std::size_t a = 0; a < cells.extent(1); ++a)
          for (int d = 0; d < element.dim; ++d) {
            double at = 0;
            const auto &weight = weights[fine->parents->kind[c]][a];
            for (std::size_t b = 0; b < weight.size(); ++b)
              at += weight[b] * X(parents(fine->parents->cell[c], static_cast<int>(b)), d);
            EXPECT_NEAR(at, x(cells(c, static_cast<int>(a)), d), 1e-14);
          }
      // Levels that add little to the one before are left out.
      const auto nodes = [](const Mesh &mesh) { return static_cast<double>(mesh.owned_nodes->getGlobalNumElements()); };
      EXPECT_GT(nodes(*fine), (fine->parents->mesh == coarse ? 1 : 1.3) * nodes(parent));
    }
    EXPECT_GE(levels, 2);
  });
}

/// A cell of order 2 is a part of its parent: nodes lie where the parent's map has them.
TEST(LocalRefinement, FollowsTheMapOfCurvedCells)
{
  for (const int dim : {2, 3}) {
    MeshData body = sheared_block({dim, 2, Shape::simplex});
    for (int n = 0; n < body.num_nodes(); ++n) { // quadratic: cells of order 2 have it exactly
      double *const x = &body.coords[std::size_t(dim) * n];
      x[0] += 0.05 * x[1] * x[1];
    }
    const double volume = test::body_measure(*dealt(body, world()));
    const Shared fine = mesh::refined_to(dealt(body, world()), graded(dim, dim == 2 ? 0.02 : 0.1));
    EXPECT_NEAR(test::body_measure(*fine), volume, 1e-12 * volume);
    const auto coords = to_host(fine->coords);
    const auto cells = to_host(fine->cells);
    for (LO c = 0; c < fine->num_cells(); ++c) { // straightened, middle nodes lie in the middle
      const auto &edges = fine->element.edges();
      for (const auto &edge : edges)
        for (int d = 0; d < dim; ++d) {
          const auto straight = [&](const int a) {
            const double y = coords(cells(c, a), 1);
            return coords(cells(c, a), d) - (d == 0 ? 0.05 * y * y : 0);
          };
          EXPECT_NEAR(straight(edge[2]), (straight(edge[0]) + straight(edge[1])) / 2, 1e-13);
        }
    }
  }
}

/// New nodes lie on the arc, and the area converges as its cells shrink.
TEST(LocalRefinement, PutsNewNodesOnTheBoundarysShape)
{
  for (const int order : {1, 2}) {
    const auto error = [&](const double size) { // fine at the arc, coarse at the centre
      const SizeField field{{0, 0, 1, 0, 0, 1}, {0, 1, 2}, {1, size, size}, 2};
      return test::quarter_disc_error(*mesh::refined_to(test::quarter_disc(order), field));
    };
    EXPECT_NEAR(std::log2(error(0.08) / error(0.02)) / 2, 2 * order, 0.3) << "order " << order;
  }
}

TEST(LocalRefinement, LeavesCellsThatAreSmallEnough)
{
  const Shared mesh = dealt(sheared_block({3, 1, Shape::simplex}), world());
  SizeField field{{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2, 3}, {9, 9, 9, 9}, 3};
  EXPECT_EQ(mesh::refined_to(mesh, field), mesh);
}

/// METIS weighs cells by what becomes of them.
TEST(LocalRefinement, GivesRanksAboutAsManyCells)
{
  mesh::BoxOptions box;
  box.element = {3, 1};
  box.lower = {0, 0, 0};
  box.upper = {1, 1, 1};
  box.cells = {6, 6, 6};
  auto field =
      std::make_shared<SizeField>(SizeField{{0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0, 3}, {0, 1, 2, 3}, {.03, 1, 1, 1}, 3});
  const Mesh mesh = mesh::make_mesh(mesh::refined_to_sizes(box, field), world());
  EXPECT_EQ(mesh.element.name(), "P1");
  const double mean = static_cast<double>(sum_all(mesh.comm(), GO(mesh.num_owned_cells))) / world()->getSize();
  EXPECT_GT(mean, 200);
  EXPECT_LT(mesh.num_owned_cells, 1.35 * mean);
  EXPECT_NEAR(test::body_measure(mesh), 1, 1e-13);
  for (const char *const side : {"left", "right", "bottom", "top", "back", "front"})
    EXPECT_NEAR(test::side_measure(mesh, side), 1, 1e-13) << side;
}

TEST(LocalRefinement, Refusals)
{
  const SizeField field{{0, 0, 1, 0, 0, 1}, {0, 1, 2}, {.1, .1, .1}, 2};
  const auto refused = [&](const Element &element) {
    test::expect_error(ExitCode::bad_input, "only triangles and tetrahedra",
                       [&] { mesh::refined_to(dealt(sheared_block(element), world()), field); });
  };
  refused({2, 1});
  refused({3, 1, Shape::simplex});
  mesh::BoxOptions box;
  box.element = {2, 1};
  box.lower = {0, 0};
  box.upper = {1, 1};
  box.cells = {2, 2};
  auto bad = std::make_shared<SizeField>(field);
  bad->size[1] = 0;
  test::expect_error(ExitCode::bad_mesh, "cell sizes must be > 0",
                     [&] { mesh::make_mesh(mesh::refined_to_sizes(box, bad), world()); });
}

} // namespace
} // namespace local_refinement_test
