#include "rpc/mesh/refinement.hpp"

#include "block_mesh.hpp"
#include "expect_error.hpp"
#include "parts_measures.hpp"
#include "rpc/mesh/distribute.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "rpc/mesh/topology.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace
{

using namespace rpc;
using mesh::Element;
using mesh::Mesh;
using mesh::MeshData;
using mesh::Shape;
using Shared = std::shared_ptr<const Mesh>;

RCP<const Comm> world()
{
  return Tpetra::getDefaultComm();
}
/// This rank by itself: what it makes is the serial result, there to compare with.
RCP<const Comm> alone()
{
  static const RCP<const Comm> comm = world()->split(world()->getRank(), 0);
  return comm;
}

/// A block of 3 x 2 (x 2) cells, sheared, in two blocks, with its sides at both ends and all others, and a point.
MeshData sheared_block(const Element &element)
{
  const std::array<int, 3> cells{3, 2, 2};
  MeshData data = test::block(element, cells);
  const int dim = element.dim, width = element.num_nodes();
  data.blocks = {"near", "far"};
  for (int c = 0; c < data.num_cells(); ++c) data.block[c] = c % 2;
  const mesh::Entities facets = mesh::facets_of(element, data.cells);
  data.sides = {{"low", {}, {}}, {"high", {}, {}}, {"rest", {}, {}}};
  for (int f = 0; f < facets.size(); ++f) {
    if (facets.num_cells_at(f) != 1) continue;
    const auto at_x = [&](const double x) {
      return std::all_of(facets.vertices.begin() + std::ptrdiff_t(facets.num_vertices) * f,
                         facets.vertices.begin() + std::ptrdiff_t(facets.num_vertices) * (f + 1),
                         [&](const int n) { return data.coords[std::size_t(dim) * n] == x; });
    };
    auto &side = data.sides[at_x(0) ? 0 : at_x(3) ? 1 : 2];
    side.cell.push_back(facets.cell(f, 0));
    side.ordinal.push_back(facets.ordinal(f, 0));
  }
  data.points = {{"first", {data.cells[0]}}, {"last", {data.cells[std::size_t(width) * (data.num_cells() - 1)]}}};
  std::sort(data.points[1].node.begin(), data.points[1].node.end());
  for (int n = 0; n < data.num_nodes(); ++n) {
    double *const x = &data.coords[std::size_t(dim) * n];
    x[0] += 0.3 * x[1];
    if (dim == 3) x[1] -= 0.2 * x[2];
  }
  return data;
}

Shared dealt(const MeshData &whole, const RCP<const Comm> &comm)
{
  return std::make_shared<Mesh>(mesh::distribute(comm->getRank() == 0 ? whole : MeshData{}, comm));
}

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

/// Facets are shared by two cells, or lie on the boundary; those on the boundary are the parts of the coarse ones.
TEST(Refinement, IsConforming)
{
  for_each_element([](const Element &element) {
    const Shared coarse = dealt(sheared_block(element), world()), fine = refined(coarse, 2);
    const auto boundary = [](const Mesh &mesh) {
      const mesh::Topology topology = mesh::topology(mesh);
      GO count = 0;
      for (int f = 0; f < topology.facets.size(); ++f) {
        EXPECT_LE(topology.facets.num_cells_at(f), 2);
        count += topology.owns_facet[f] && topology.on_boundary(f);
      }
      return sum_all(mesh.comm(), count);
    };
    EXPECT_EQ(boundary(*fine), power(4, element.dim - 1) * boundary(*coarse));
    GO listed = 0;
    for (const mesh::Side &side : fine->sides) {
      const auto cell = to_host(side.cell);
      for (std::size_t f = 0; f < cell.extent(0); ++f) listed += cell(f) < fine->num_owned_cells;
    }
    EXPECT_EQ(sum_all(fine->comm(), listed), boundary(*fine));
  });
}

/// A rank's part holds what the whole mesh, refined by one rank, has there.
TEST(Refinement, IsTheSameOnAnyNumberOfRanks)
{
  for_each_element([](const Element &element) {
    const MeshData whole = sheared_block(element);
    const Shared mesh = refined(dealt(whole, world()), 2);
    const Shared serial = refined(dealt(whole, alone()), 2);
    const auto coords = to_host(mesh->coords), all_coords = to_host(serial->coords);
    const auto cells = to_host(mesh->cells), all_cells = to_host(serial->cells);
    const auto ids = mesh::overlap_node_ids(*mesh);
    std::vector<LO> node_of(serial->num_local_nodes()), cell_of(serial->num_cells());
    for (LO n = 0; n < serial->num_local_nodes(); ++n) node_of[serial->node_id(n)] = n;
    for (LO c = 0; c < serial->num_cells(); ++c) cell_of[serial->cell_id(c)] = c;
    for (LO n = 0; n < mesh->num_local_nodes(); ++n)
      for (int d = 0; d < element.dim; ++d) EXPECT_NEAR(coords(n, d), all_coords(node_of[ids(n)], d), 1e-14);
    for (LO c = 0; c < mesh->num_owned_cells; ++c) {
      const LO other = cell_of[mesh->cell_id(c)];
      for (std::size_t a = 0; a < cells.extent(1); ++a)
        EXPECT_EQ(ids(cells(c, a)), serial->node_id(all_cells(other, a)));
      EXPECT_EQ(to_host(mesh->block)(c), to_host(serial->block)(other));
    }
  });
}

/// All cells at an owned node are local, and there are no others.
TEST(Refinement, HoldsTheCellsAroundOwnedNodes)
{
  for_each_element([](const Element &element) {
    const MeshData whole = sheared_block(element);
    const Shared mesh = refined(dealt(whole, world()), 2);
    const Shared serial = refined(dealt(whole, alone()), 2);
    const auto cells = to_host(mesh->cells), all_cells = to_host(serial->cells);
    std::vector<int> around(serial->num_local_nodes(), 0);
    std::vector<LO> node_of(serial->num_local_nodes());
    for (LO n = 0; n < serial->num_local_nodes(); ++n) node_of[serial->node_id(n)] = n;
    for (std::size_t c = 0; c < all_cells.extent(0); ++c)
      for (std::size_t a = 0; a < all_cells.extent(1); ++a) ++around[all_cells(c, a)];
    std::vector<int> here(mesh->num_local_nodes(), 0);
    for (LO c = 0; c < mesh->num_cells(); ++c) {
      bool touches = c < mesh->num_owned_cells;
      for (std::size_t a = 0; a < cells.extent(1); ++a) {
        ++here[cells(c, a)];
        touches = touches || cells(c, a) < mesh->num_owned_nodes();
      }
      EXPECT_TRUE(touches);
    }
    for (LO n = 0; n < mesh->num_owned_nodes(); ++n) EXPECT_EQ(here[n], around[node_of[mesh->node_id(n)]]);
  });
}

/// Six times the volume over the cube of the root mean square edge, over what that is of a regular tetrahedron.
double quality(const std::vector<std::vector<double>> &x)
{
  double squares = 0, J[3][3];
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < a; ++b)
      for (int d = 0; d < 3; ++d) squares += (x[a][d] - x[b][d]) * (x[a][d] - x[b][d]) / 6;
  for (int k = 0; k < 3; ++k)
    for (int d = 0; d < 3; ++d) J[k][d] = x[k + 1][d] - x[0][d];
  const double six_volumes = J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) -
                             J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
                             J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
  return std::sqrt(2.) * six_volumes / std::pow(squares, 1.5);
}

/// From a regular one, a corner of a cube, a flat and a long one: positive volumes, and no child of a child gets worse.
TEST(Refinement, TetrahedraDoNotDegenerate)
{
  const std::vector<std::vector<double>> bodies = {
      {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1}, // regular: its corners are those of a cube
      {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
      {0, 0, 0, 1, 0, 0, 0, 1, 0, .4, .3, .1},
      {0, 0, 0, 1, .1, 0, 0, 1.2, 0, .2, .3, 5}};
  for (const auto &coords : bodies) {
    MeshData body;
    body.element = {3, 1, Shape::simplex};
    body.coords = coords;
    body.cells = {0, 1, 2, 3};
    body.blocks = {"body"};
    body.block = {0};
    Shared mesh = dealt(body, alone());
    const auto worst = [](const Mesh &mesh) {
      double least = 1;
      for (LO c = 0; c < mesh.num_cells(); ++c) least = std::min(least, quality(test::places(mesh, c, {0, 1, 2, 3})));
      return least;
    };
    if (worst(*mesh) < 0) { // the other way round
      body.cells = {0, 2, 1, 3};
      mesh = dealt(body, alone());
    }
    const double first = worst(*refined(mesh, 1));
    EXPECT_GT(first, 0.3 * worst(*mesh));
    mesh = refined(mesh, 4);
    EXPECT_EQ(mesh->num_cells(), 4096);
    EXPECT_GT(worst(*mesh), 0.9 * first);
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
  EXPECT_EQ(mesh::ancestor(fine, 3), coarse);
  EXPECT_EQ(mesh::ancestor(fine, 0), fine);
  EXPECT_EQ(mesh::ancestor(fine, 4), nullptr);
  EXPECT_EQ(fine->parents->cell.size(), std::size_t(fine->num_cells()));
}

/// A quarter of a disc, one triangle whose longest edge is an arc: new nodes lie on it, and the area converges.
TEST(Refinement, PutsNewNodesOnTheBoundarysShape)
{
  for (const int order : {1, 2}) {
    MeshData body;
    body.element = {2, order, Shape::simplex};
    body.coords = {0, 0, 1, 0, 0, 1};
    body.cells = {0, 1, 2};
    if (order == 2) {
      body.coords.insert(body.coords.end(), {.5, 0, std::sqrt(.5), std::sqrt(.5), 0, .5});
      body.cells.insert(body.cells.end(), {3, 4, 5});
    }
    body.blocks = {"body"};
    body.block = {0};
    mesh::BoundaryPart arc;
    arc.shape.kind = mesh::BoundaryShape::Kind::sphere;
    arc.shape.radius = 1;
    arc.cell = {0};
    arc.ordinal = {1};
    body.geometry = {arc};
    double last = 1;
    for (const int times : {2, 3, 4}) {
      const double error = std::abs(test::body_measure(*refined(dealt(body, alone()), times)) / (M_PI / 4) - 1);
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
    EXPECT_EQ(mesh::ancestor(std::make_shared<Mesh>(fine), 2)->element.name(), coarse.element.name());
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
