// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/refinement.hpp"

#include "ancestor.hpp"
#include "expect_error.hpp"
#include "refined_meshes.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "rpc/mesh/topology.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace refinement_test
{
namespace
{

using namespace rpc;
using mesh::Element;
using mesh::Mesh;
using mesh::MeshData;
using mesh::Shape;
using test::alone;
using test::dealt;
using test::Shared;
using test::sheared_block;
using test::world;

Shared refined(Shared mesh, const int times)
{
  for (int k = 0; k < times; ++k) mesh = std::make_shared<Mesh>(mesh::refined(mesh));
  return mesh;
}

template <class Check>
void for_each_element(const Check &check)
{
  for (const Element &element : mesh::all_elements()) {
    SCOPED_TRACE(std::to_string(element.dim) + "D " + element.name());
    check(element);
  }
}

GO power(const GO base, const int exponent)
{
  GO result = 1;
  for (int k = 0; k < exponent; ++k) result *= base;
  return result;
}

TEST(Refinement, HasTheNodesAndCellsOfTheFinerLattice)
{
  for_each_element([](const Element &element) {
    const MeshData whole = sheared_block(element);
    const Shared mesh = refined(dealt(whole, world()), 2);
    GO nodes = 1;
    for (int d = 0; d < element.dim; ++d) nodes *= 4 * element.order * (d == 0 ? 3 : 2) + 1;
    EXPECT_EQ(static_cast<GO>(mesh->owned_nodes->getGlobalNumElements()), nodes);
    EXPECT_EQ(sum_all(mesh->comm(), GO(mesh->num_owned_cells)), power(4, element.dim) * whole.num_cells());
    // Sheared lattices: each node is on the lattice, and no two are at one place.
    std::set<std::vector<long>> taken;
    const auto coords = to_host(mesh->coords);
    for (LO n = 0; n < mesh->num_owned_nodes(); ++n) {
      std::vector<long> place;
      double x[3] = {coords(n, 0), coords(n, 1), element.dim == 3 ? coords(n, 2) : 0};
      x[1] += 0.2 * x[2];
      x[0] -= 0.3 * (x[1]);
      for (int d = 0; d < element.dim; ++d) {
        const double at = 4 * element.order * x[d];
        EXPECT_NEAR(at, std::round(at), 1e-11);
        place.push_back(std::lround(at));
      }
      EXPECT_TRUE(taken.insert(place).second);
    }
  });
}

TEST(Refinement, KeepsTheBodyItsSidesAndTheirNormals)
{
  for_each_element([](const Element &element) {
    const Shared coarse = dealt(sheared_block(element), world()), fine = refined(coarse, 2);
    const double volume = element.dim == 2 ? 6 : 12;
    EXPECT_NEAR(test::body_measure(*fine), volume, 1e-12 * volume);
    for (const char *const side : {"low", "high", "rest"}) {
      const double size = test::side_measure(*coarse, side);
      EXPECT_GT(size, 1);
      EXPECT_NEAR(test::side_measure(*fine, side), size, 1e-12 * size) << side;
    }
    EXPECT_EQ(fine->blocks, coarse->blocks);
    ASSERT_EQ(fine->points.size(), 2u);
    EXPECT_EQ(sum_all(fine->comm(), GO(fine->points[0].node.size() + fine->points[1].node.size())), 2);
  });
}

/// Facets on the boundary are the parts of the coarse ones.
TEST(Refinement, IsConforming)
{
  for_each_element([](const Element &element) {
    const Shared coarse = dealt(sheared_block(element), world()), fine = refined(coarse, 2);
    EXPECT_EQ(test::expect_conforming(*fine), power(4, element.dim - 1) * test::expect_conforming(*coarse));
  });
}

TEST(Refinement, IsTheSameOnAnyNumberOfRanks)
{
  for_each_element([](const Element &element) {
    const MeshData whole = sheared_block(element);
    const Shared mesh = refined(dealt(whole, world()), 2), serial = refined(dealt(whole, alone()), 2);
    test::expect_part_of(*serial, *mesh);
    test::expect_cells_around_owned_nodes(*serial, *mesh);
  });
}

/// Positive volumes, and no child of a child gets worse.
TEST(Refinement, TetrahedraDoNotDegenerate)
{
  for (Shared mesh : test::tetrahedra()) {
    const double first = test::worst_quality(*refined(mesh, 1));
    EXPECT_GT(first, 0.3 * test::worst_quality(*mesh));
    mesh = refined(mesh, 4);
    EXPECT_EQ(mesh->num_cells(), 4096);
    EXPECT_GT(test::worst_quality(*mesh), 0.9 * first);
  }
}

/// A cell of order 2 is a part of its parent: nodes lie where the parent's map has them, straight or curved.
TEST(Refinement, FollowsTheMapOfCurvedCells)
{
  for (const Element &element :
       {Element{2, 2, Shape::simplex}, Element{2, 2}, Element{3, 2, Shape::simplex}, Element{3, 2}}) {
    SCOPED_TRACE(std::to_string(element.dim) + "D " + element.name());
    MeshData body = test::block(element, {2, 2, 2});
    const auto bent = [&](double *const x) { // quadratic: cells of order 2 have it exactly
      const double y = x[1];
      x[0] += 0.1 * y * y;
      if (element.dim == 3) x[2] += 0.05 * y * y;
    };
    for (int n = 0; n < body.num_nodes(); ++n) bent(&body.coords[std::size_t(element.dim) * n]);
    const Shared mesh = refined(dealt(body, world()), 2);
    const auto coords = to_host(mesh->coords);
    for (LO n = 0; n < mesh->num_local_nodes(); ++n) {
      const double y = coords(n, 1), x = coords(n, 0) - 0.1 * y * y, lattice = 4 * 2 * x;
      EXPECT_NEAR(lattice, std::round(lattice), 1e-12);
    }
    EXPECT_NEAR(test::body_measure(*mesh), element.dim == 2 ? 4 : 8, 1e-12);
  }
}

TEST(Refinement, LeadsBackToItsParents)
{
  const Shared coarse = dealt(sheared_block({2, 1}), world()), fine = refined(coarse, 3);
  EXPECT_EQ(test::ancestor(fine, 3), coarse);
  EXPECT_EQ(test::ancestor(fine, 0), fine);
  EXPECT_EQ(test::ancestor(fine, 4), nullptr);
  EXPECT_EQ(fine->parents->cell.size(), std::size_t(fine->num_cells()));
}

/// New nodes lie on the arc, and the area converges.
TEST(Refinement, PutsNewNodesOnTheBoundarysShape)
{
  for (const int order : {1, 2}) {
    double last = 1;
    for (const int times : {2, 3, 4}) {
      const double error = test::quarter_disc_error(*refined(test::quarter_disc(order), times));
      if (times > 2) {
        EXPECT_NEAR(std::log2(last / error), 2 * order, 0.3) << "order " << order << ", " << times << " times";
      }
      last = error;
    }
  }
}

/// A .msh has no geometry but its own cells: the body keeps its size to rounding, curved or not.
TEST(Refinement, KeepsTheBodyOfAMshFile)
{
  for (const char *const name : {"sector_41.msh", "octant_41.msh"}) {
    SCOPED_TRACE(name);
    mesh::GmshOptions options{std::string(RPC_TEST_DATA_DIR) + "/" + name, 1, 0};
    const Mesh coarse = mesh::make_mesh(options, alone());
    options.refinements = 2;
    const Mesh fine = mesh::make_mesh(options, world());
    EXPECT_NEAR(test::body_measure(fine), test::body_measure(coarse), 1e-12 * test::body_measure(coarse));
    ASSERT_EQ(fine.sides.size(), coarse.sides.size());
    for (const mesh::Side &side : coarse.sides) {
      const double before = test::side_measure(coarse, side.name), after = test::side_measure(fine, side.name);
      EXPECT_NEAR(after, before, 1e-4 * before) << side.name; // by quadrature, of roots on curved sides
    }
    EXPECT_EQ(test::ancestor(std::make_shared<Mesh>(fine), 2)->element.name(), coarse.element.name());
    EXPECT_EQ(sum_all(fine.comm(), GO(fine.num_owned_cells)), power(4, coarse.dim()) * coarse.num_owned_cells);
  }
}

TEST(Refinement, RefusesCellsThatACurvedBoundaryInverts)
{
  MeshData body = test::block({2, 1, Shape::simplex}, {1, 1, 1});
  for (std::size_t n = 1; n < body.coords.size(); n += 2) body.coords[n] /= 2;
  mesh::BoundaryPart arc; // above the middle of the diagonal of the lower triangle
  arc.shape.kind = mesh::BoundaryShape::Kind::sphere;
  arc.shape.point = {0.5, -1, 0};
  arc.shape.radius = 1.3;
  const mesh::Entities facets = mesh::facets_of(body.element, body.cells);
  for (int f = 0; f < facets.size(); ++f) {
    const int *const ends = &facets.vertices[2 * std::size_t(f)];
    if (body.coords[2 * ends[0] + 1] != 0 || body.coords[2 * ends[1] + 1] != 0) continue;
    arc.cell = {facets.cell(f, 0)};
    arc.ordinal = {facets.ordinal(f, 0)};
  }
  ASSERT_EQ(arc.cell.size(), 1u);
  body.geometry = {arc};
  const auto comm = alone();
  test::expect_error(ExitCode::bad_mesh, {"inverts a cell", "Mesh->Refinements"},
                     [&] { refined(dealt(body, comm), 1); });
  body.geometry[0].shape.radius = 1.9;
  test::expect_error(ExitCode::bad_mesh, "too large for the curved boundary", [&] { refined(dealt(body, comm), 1); });
}

} // namespace
} // namespace refinement_test
