#include "rpc/mesh/box.hpp"

#include "expect_error.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace
{

using rpc::ExitCode;
using rpc::GO;
using rpc::LO;
using rpc::mesh::BoxOptions;
using rpc::mesh::Element;
using rpc::mesh::make_box;
using rpc::mesh::Mesh;
using rpc::mesh::Shape;
using rpc::mesh::Side;
using rpc::test::expect_error;
using Position = std::array<GO, 3>;

/// A cell of the lattice, or of a mesh of simplices one of those that it is divided into.
struct Cell {
  Position corner{};
  int part = 0;
};

/// Boxes of different shapes, flat and thin ones too, all divisible among up to 4 ranks.
std::vector<BoxOptions> boxes()
{
  return {{{-1, 2}, {1.5, 3}, {5, 3}, Element{2, 1}},
          {{-1, 2}, {1.5, 3}, {3, 4}, Element{2, 2}},
          {{0, 0}, {7, 1}, {7, 1}, Element{2, 1}},
          {{0, 0}, {1, 7}, {1, 7}, Element{2, 2}},
          {{-1, 2, 0.5}, {0, 3, 4}, {3, 2, 4}, Element{3, 1}},
          {{-1, 2, 0.5}, {0, 3, 4}, {2, 2, 3}, Element{3, 2}},
          {{-1, 2}, {1.5, 3}, {5, 3}, Element{2, 1, Shape::simplex}},
          {{-1, 2}, {1.5, 3}, {3, 4}, Element{2, 2, Shape::simplex}},
          {{0, 0}, {1, 7}, {1, 7}, Element{2, 1, Shape::simplex}},
          {{0, 0}, {7, 1}, {7, 1}, Element{2, 2, Shape::simplex}},
          {{-1, 2, 0.5}, {0, 3, 4}, {3, 2, 4}, Element{3, 1, Shape::simplex}},
          {{-1, 2, 0.5}, {0, 3, 4}, {2, 2, 3}, Element{3, 2, Shape::simplex}},
          {{0, 0, 0}, {1, 1, 5}, {1, 1, 5}, Element{3, 1, Shape::simplex}}};
}

std::string text_of(const BoxOptions &box)
{
  std::ostringstream text;
  text << box.element.name() << ", cells";
  for (const int n : box.cells) text << ' ' << n;
  return text.str();
}

/// The lattices of a whole box, and where a rank's nodes and cells lie on them by their coordinates.
struct Lattice {
  const BoxOptions &box;
  int dim = box.element.dim, order = box.element.order;
  bool simplex = box.element.shape == Shape::simplex;
  int parts = !simplex ? 1 : (dim == 2 ? 2 : 6); // cells of the mesh in one of the lattice

  GO extent(const int d, const int per_cell) const { return GO(per_cell) * box.cells[d]; }
  GO num_nodes() const { return count(order, 1); }
  GO num_cells() const { return parts * count(1, 0); } // of the mesh
  GO count(const int per_cell, const int more) const
  {
    GO n = 1;
    for (int d = 0; d < dim; ++d) n *= extent(d, per_cell) + more;
    return n;
  }
  GO id(const Position &at, const int per_cell, const int more) const // x fastest
  {
    GO result = 0;
    for (int d = dim - 1; d >= 0; --d) result = result * (extent(d, per_cell) + more) + at[d];
    return result;
  }
  Position position(GO index, const int per_cell, const int more) const
  {
    Position at{};
    for (int d = 0; d < dim; ++d) {
      at[d] = index % (extent(d, per_cell) + more);
      index /= extent(d, per_cell) + more;
    }
    return at;
  }
  double coordinate(const GO at, const int d) const
  {
    return box.lower[d] + (box.upper[d] - box.lower[d]) * at / extent(d, order);
  }
  /// From a node's coordinates, which must lie on the lattice.
  template <class Coords>
  Position node_position(const Coords &coords, const LO lid) const
  {
    Position at{};
    for (int d = 0; d < dim; ++d) {
      const double t = (coords(lid, d) - box.lower[d]) / (box.upper[d] - box.lower[d]) * extent(d, order);
      at[d] = std::llround(t);
      EXPECT_NEAR(t, at[d], 1e-12 * extent(d, order));
    }
    return at;
  }
  GO node_id(const Position &at) const { return id(at, order, 1); }
  GO cell_id(const Cell &cell) const { return parts * id(cell.corner, 1, 0) + cell.part; }
  Cell cell(const GO cell_id) const { return {position(cell_id / parts, 1, 0), static_cast<int>(cell_id % parts)}; }
  /// Vertices of a tetrahedron in the unit cell: from (0, 0, 0) along its edges to (1, 1, 1), directions in the part's order;
  /// two of them are swapped where the volume would be negative.
  static std::vector<Position> tetrahedron(const int part)
  {
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    std::vector<Position> vertex(4);
    for (int v = 1; v < 4; ++v) {
      vertex[v] = vertex[v - 1];
      vertex[v][order[part][v - 1]] = 1;
    }
    const bool mirrored = part == 1 || part == 2 || part == 5;
    if (mirrored) std::swap(vertex[1], vertex[2]);
    return vertex;
  }
  Position node_of(const Cell &cell, const int a) const
  {
    Position at{};
    const auto &step = box.element.lattice()[a];
    for (int d = 0; d < dim; ++d) {
      at[d] = order * cell.corner[d];
      if (simplex && dim == 3) // vertex 0 is at the corner
        for (int k = 0; k < dim; ++k) at[d] += step[k] * tetrahedron(cell.part)[k + 1][d];
      else // the second triangle is the first turned by 180 degrees
        at[d] += cell.part == 0 ? step[d] : order - step[d];
    }
    return at;
  }
  std::set<GO> nodes_of(const Cell &cell) const
  {
    std::set<GO> nodes;
    for (int a = 0; a < box.element.num_nodes(); ++a) nodes.insert(node_id(node_of(cell, a)));
    return nodes;
  }
};

/// A box's mesh with the lattice position of each local node and cell.
struct Made {
  BoxOptions box;
  Lattice lattice{box};
  Mesh mesh = make_box(box, Tpetra::getDefaultComm());
  rpc::HostView<double **> coords{"coords", mesh.coords.extent(0), mesh.coords.extent(1)};
  rpc::HostView<LO **> cells{"cells", mesh.cells.extent(0), mesh.cells.extent(1)};
  std::vector<Position> node;
  std::vector<Cell> cell;

  explicit Made(const BoxOptions &options) : box(options)
  {
    Kokkos::deep_copy(coords, rpc::to_host(mesh.coords));
    Kokkos::deep_copy(cells, rpc::to_host(mesh.cells));
    for (LO n = 0; n < mesh.num_local_nodes(); ++n) node.push_back(lattice.node_position(coords, n));
    for (LO c = 0; c < mesh.num_cells(); ++c) cell.push_back(place_of(c));
  }
  Cell place_of(const LO c) const
  {
    Cell place{node[cells(c, 0)], 0};
    for (std::size_t a = 1; a < cells.extent(1); ++a)
      for (int d = 0; d < 3; ++d) place.corner[d] = std::min(place.corner[d], node[cells(c, a)][d]);
    for (GO &corner : place.corner) corner /= mesh.element.order;
    const auto fits = [&](const int part) {
      for (int a = 0; a < mesh.element.num_vertices(); ++a)
        if (lattice.node_of({place.corner, part}, a) != node[cells(c, a)]) return false;
      return true;
    };
    while (place.part < lattice.parts && !fits(place.part)) ++place.part;
    EXPECT_LT(place.part, lattice.parts) << "cell " << c << " is none of the parts of a cell of the lattice";
    return place;
  }
  GO node_id(const LO lid) const { return lattice.node_id(node[lid]); }
};

/// How often each id in [0, n) occurs over all ranks.
template <class Ids>
std::vector<int> occurrences(const Ids &ids, const GO n)
{
  std::vector<int> mine(n, 0), all(n, 0);
  for (std::size_t k = 0; k < ids.extent(0); ++k) {
    EXPECT_TRUE(0 <= ids(k) && ids(k) < n) << ids(k);
    if (0 <= ids(k) && ids(k) < n) ++mine[ids(k)];
  }
  Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_SUM, static_cast<int>(n), mine.data(), all.data());
  return all;
}

template <class Check>
void for_each_box(const Check &check)
{
  for (const BoxOptions &box : boxes()) {
    SCOPED_TRACE(text_of(box));
    check(Made(box));
  }
}

TEST(Box, EachNodeAndCellIdOccursOnceOverAllRanks)
{
  for_each_box([](const Made &made) {
    EXPECT_EQ(made.mesh.owned_nodes->getGlobalNumElements(), std::size_t(made.lattice.num_nodes()));
    EXPECT_EQ(occurrences(made.mesh.node_id, made.lattice.num_nodes()), std::vector<int>(made.lattice.num_nodes(), 1));
    EXPECT_EQ(occurrences(made.mesh.cell_id, made.lattice.num_cells()), std::vector<int>(made.lattice.num_cells(), 1));
    EXPECT_EQ(static_cast<LO>(made.mesh.node_id.extent(0)), made.mesh.num_owned_nodes());
    EXPECT_EQ(static_cast<LO>(made.mesh.cell_id.extent(0)), made.mesh.num_owned_cells);
  });
}

TEST(Box, NodesAndCellsLieWhereTheirIdsSay)
{
  for_each_box([](const Made &made) {
    for (LO n = 0; n < made.mesh.num_owned_nodes(); ++n) {
      EXPECT_EQ(made.mesh.node_id(n), made.node_id(n));
      const Position at = made.lattice.position(made.mesh.node_id(n), made.lattice.order, 1);
      for (int d = 0; d < made.mesh.dim(); ++d)
        EXPECT_NEAR(made.coords(n, d), made.lattice.coordinate(at[d], d), 4e-16 * 8); // 8 > any coordinate
    }
    for (LO c = 0; c < made.mesh.num_owned_cells; ++c)
      EXPECT_EQ(made.mesh.cell_id(c), made.lattice.cell_id(made.cell[c]));
  });
}

TEST(Box, EndsOfTheBoxAreMetExactly)
{
  const BoxOptions box{{0.1, -0.7}, {0.3, 1. / 3}, {7, 4}, Element{2, 1}};
  const Made made(box);
  for (LO n = 0; n < made.mesh.num_local_nodes(); ++n) {
    for (int d = 0; d < 2; ++d) {
      const GO at = made.node[n][d];
      if (at == 0 || at == box.cells[d]) {
        EXPECT_EQ(made.coords(n, d), at == 0 ? box.lower[d] : box.upper[d]);
      }
    }
  }
}

TEST(Box, GlobalIndicesAreConsecutiveAndOwnedNodesComeFirstInTheOverlap)
{
  for_each_box([](const Made &made) {
    const rpc::Comm &comm = made.mesh.comm();
    const LO num_owned = made.mesh.num_owned_nodes();
    GO end = 0;
    Teuchos::scan(comm, Teuchos::REDUCE_SUM, GO(num_owned), Teuchos::outArg(end));
    ASSERT_LE(num_owned, made.mesh.num_local_nodes());
    for (LO n = 0; n < num_owned; ++n) {
      EXPECT_EQ(made.mesh.owned_nodes->getGlobalElement(n), end - num_owned + n);
      EXPECT_EQ(made.mesh.overlap_nodes->getGlobalElement(n), end - num_owned + n);
    }
    for (LO n = num_owned; n < made.mesh.num_local_nodes(); ++n)
      EXPECT_FALSE(made.mesh.owned_nodes->isNodeGlobalElement(made.mesh.overlap_nodes->getGlobalElement(n)));
  });
}

TEST(Box, GhostNodesLieWhereTheirOwnersHaveThem)
{
  for_each_box([](const Made &made) {
    rpc::Vector id(made.mesh.owned_nodes), id_overlap(made.mesh.overlap_nodes);
    for (LO n = 0; n < made.mesh.num_owned_nodes(); ++n)
      id.replaceLocalValue(n, static_cast<double>(made.mesh.node_id(n)));
    id_overlap.doImport(id, rpc::Import(made.mesh.owned_nodes, made.mesh.overlap_nodes), Tpetra::INSERT);
    const auto ids = id_overlap.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO n = 0; n < made.mesh.num_local_nodes(); ++n) EXPECT_EQ(ids(n, 0), made.node_id(n)) << "node " << n;
  });
}

TEST(Box, LocalCellsAreThoseThatTouchAnOwnedNodeAndNoOthers)
{
  for_each_box([](const Made &made) {
    std::set<GO> owned, touching, local;
    for (LO n = 0; n < made.mesh.num_owned_nodes(); ++n) owned.insert(made.node_id(n));
    for (GO c = 0; c < made.lattice.num_cells(); ++c)
      for (const GO node : made.lattice.nodes_of(made.lattice.cell(c)))
        if (owned.count(node) > 0) touching.insert(c);
    const int parts = made.lattice.parts;
    std::set<GO> expected; // the parts of one cell of the lattice go together
    for (const GO c : touching)
      for (int part = 0; part < parts; ++part) expected.insert(c - c % parts + part);
    for (const Cell &cell : made.cell) local.insert(made.lattice.cell_id(cell));
    EXPECT_EQ(local, expected);
    EXPECT_EQ(local.size(), made.cell.size()); // each once
  });
}

/// Area or volume, from the vertices: those of a parallelogram, a parallelepiped, or half and a sixth of these.
double measure_of(const Made &made, const LO cell)
{
  const int dim = made.mesh.dim();
  const bool simplex = made.lattice.simplex;
  const auto edge = [&](const int vertex, const int d) {
    return made.coords(made.cells(cell, vertex), d) - made.coords(made.cells(cell, 0), d);
  };
  const std::array<int, 3> ends = simplex ? std::array<int, 3>{1, 2, 3} : std::array<int, 3>{1, 3, 4};
  if (dim == 2) {
    const double area = edge(ends[0], 0) * edge(ends[1], 1) - edge(ends[0], 1) * edge(ends[1], 0);
    return simplex ? area / 2 : area;
  }
  double volume = 0;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    volume += edge(ends[0], d) * (edge(ends[1], e) * edge(ends[2], f) - edge(ends[1], f) * edge(ends[2], e));
  }
  return simplex ? volume / 6 : volume;
}

TEST(Box, CellsHaveEqualPositiveMeasuresThatSumToTheBox)
{
  for_each_box([](const Made &made) {
    double mine = 0, whole = 1;
    for (int d = 0; d < made.mesh.dim(); ++d) whole *= made.box.upper[d] - made.box.lower[d];
    for (LO c = 0; c < made.mesh.num_cells(); ++c) {
      const double measure = measure_of(made, c);
      EXPECT_NEAR(measure, whole / static_cast<double>(made.lattice.num_cells()), 1e-13 * whole) << "cell " << c;
      if (c < made.mesh.num_owned_cells) mine += measure;
    }
    EXPECT_NEAR(rpc::sum_all(made.mesh.comm(), mine), whole, 1e-13 * whole);
  });
}

TEST(Box, TetrahedraOfACellShareItsDiagonalAndNothingElse)
{
  // Each point of the cell lies in the tetrahedron of the order of its coordinates.
  for (int part = 0; part < 6; ++part) {
    std::vector<int> order{0, 1, 2};
    for (int k = 0; k < part; ++k) std::next_permutation(order.begin(), order.end());
    for (const Position &vertex : Lattice::tetrahedron(part))
      EXPECT_TRUE(vertex[order[0]] >= vertex[order[1]] && vertex[order[1]] >= vertex[order[2]]) << part;
  }
}

TEST(Box, IsOneBlock)
{
  for_each_box([](const Made &made) {
    EXPECT_EQ(made.mesh.blocks, std::vector<std::string>{"body"});
    const auto block = rpc::to_host(made.mesh.block);
    ASSERT_EQ(static_cast<LO>(block.extent(0)), made.mesh.num_cells());
    for (LO c = 0; c < made.mesh.num_cells(); ++c) EXPECT_EQ(block(c), 0);
  });
}

TEST(Box, CellNodesFollowTheElementsLattice)
{
  for_each_box([](const Made &made) {
    for (LO c = 0; c < made.mesh.num_cells(); ++c)
      for (int a = 0; a < made.mesh.element.num_nodes(); ++a)
        EXPECT_EQ(made.node[made.cells(c, a)], made.lattice.node_of(made.cell[c], a));
  });
}

TEST(Box, LocalNodesAreThoseOfLocalCellsEachOnce)
{
  for_each_box([](const Made &made) {
    std::set<GO> of_cells, local;
    for (const Cell &cell : made.cell) of_cells.merge(made.lattice.nodes_of(cell));
    for (LO n = 0; n < made.mesh.num_local_nodes(); ++n) local.insert(made.node_id(n));
    EXPECT_EQ(local, of_cells);
    EXPECT_EQ(static_cast<LO>(local.size()), made.mesh.num_local_nodes());
  });
}

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

TEST(Box, BlocksShareAsFewFacesAsPossible)
{
  const auto comm = Tpetra::getDefaultComm();
  if (comm->getSize() == 1) GTEST_SKIP() << "one rank shares nothing";
  for (const bool tall : {false, true}) {
    const Made made({{0, 0}, {1, 1}, {tall ? 4 : 40, tall ? 40 : 4}, Element{2, 1}});
    const GO ghosts = rpc::sum_all(*comm, GO(made.mesh.num_local_nodes() - made.mesh.num_owned_nodes()));
    EXPECT_EQ(ghosts,
              2 * 5 * (comm->getSize() - 1)); // cut across the short direction: 5 nodes wide, seen from both sides
  }
}

TEST(Box, MoreRanksThanTheCellsCanServeIsABadMeshOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  if (comm->getSize() == 1) GTEST_SKIP() << "one rank can always have the whole box";
  const std::string ranks = std::to_string(comm->getSize()) + " ranks";
  expect_error(ExitCode::bad_mesh, {"1 x 1 cells", ranks.c_str(), "fewer ranks"}, [&] {
    make_box({{0, 0}, {1, 1}, {1, 1}, Element{2, 1}}, comm);
  });
  expect_error(ExitCode::bad_mesh, {"1 x 1 x 1 cells"}, [&] {
    make_box({{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, Element{3, 1}}, comm);
  });
}

TEST(HalvedBox, HasHalfTheCellsAndItsNodesAreAmongTheFinerOnes)
{
  const auto coarse = rpc::mesh::halved({{0, 0, 0}, {6, 4, 2}, {15, 10, 5}, Element{3, 2, Shape::simplex}});
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->cells, (std::vector<int>{7, 5, 2}));
  EXPECT_EQ(coarse->last, (std::vector<double>{1.5, 1, 1.5}));
  EXPECT_TRUE(coarse->element == (Element{3, 1, Shape::simplex}));
  EXPECT_EQ(coarse->upper, (std::vector<double>{6, 4, 2}));
}

TEST(HalvedBox, StretchedCellsBecomeSquareFirst)
{
  BoxOptions box{{0, 0}, {8, 1}, {8, 64}, Element{2, 1}}; // cells of 1 x 1/64
  for (const int across : {32, 16, 8, 4}) {
    box = *rpc::mesh::halved(box);
    EXPECT_EQ(box.cells, (std::vector<int>{8, across}));
  }
  box.cells = {8, 1};
  box = *rpc::mesh::halved(box);
  EXPECT_EQ(box.cells, (std::vector<int>{4, 1})) << "a direction of one cell stays";
}

/// Each coordinate of a coarse node is one of the finer box, level after level.
TEST(HalvedBox, MakesNestedMeshesOfAnyNumbersOfCells)
{
  const int ranks = Tpetra::getDefaultComm()->getSize();
  for (const int cells : {2, 3, 5, 7, 11, 23, 63, 65}) {
    if (cells < ranks) continue;
    BoxOptions box{{-1, 2}, {1, 4}, {cells, cells}, Element{2, 1}};
    const auto places = [](const BoxOptions &options) {
      const auto coords = rpc::to_host(make_box(options, Tpetra::getDefaultComm()).coords);
      std::vector<double> found;
      for (std::size_t n = 0; n < coords.extent(0); ++n) found.push_back(coords(n, 0));
      return found;
    };
    auto finer = places(box);
    while (const auto coarse = rpc::mesh::halved(box)) {
      EXPECT_LE(coarse->last[0], 2) << cells;
      EXPECT_GE(coarse->last[0], 1) << cells;
      if (coarse->cells[0] < ranks) break;
      const auto coarser = places(*coarse);
      if (ranks == 1)
        for (const double x : coarser)
          EXPECT_TRUE(std::any_of(finer.begin(), finer.end(), [x](const double y) { return std::abs(x - y) < 1e-14; }))
              << cells << ": " << x;
      box = *coarse;
      finer = coarser;
    }
  }
}

TEST(HalvedBox, IsNoneOfOneCell)
{
  EXPECT_FALSE(rpc::mesh::halved({{0, 0}, {1, 2}, {1, 1}, Element{2, 1}}));
}

TEST(Box, TheMeshKnowsIt)
{
  const Made made({{1, 2}, {4, 3}, {8, 4}, Element{2, 1}});
  ASSERT_TRUE(made.mesh.box);
  EXPECT_EQ(made.mesh.box->cells, (std::vector<int>{8, 4}));
}

TEST(Diameter, IsTheDiagonalWhereverTheBoxLies)
{
  for (const double shift : {0., 100., -100.}) {
    const Made flat({{shift, shift}, {shift + 4, shift + 3}, {8, 4}, Element{2, 1}});
    EXPECT_NEAR(rpc::mesh::diameter(flat.mesh), 5, 1e-13);
    const Made solid({{shift, shift, shift}, {shift + 2, shift + 3, shift + 6}, {2, 2, 4}, Element{3, 1}});
    EXPECT_NEAR(rpc::mesh::diameter(solid.mesh), 7, 1e-13);
  }
}

} // namespace
