// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/interpolation.hpp"

#include "bodies.hpp"
#include "rpc/fem/order_one.hpp"

#include <algorithm>

namespace interpolation_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// f(x), up to three numbers, at all owned nodes: (owned nodes; dim).
template <class Function>
MultiVector at_nodes(const fem::Discretization &d, const Function &f)
{
  MultiVector result(d.mesh->owned_nodes, d.dim());
  const auto values = result.getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
    const Point value = f(point_of(d, n));
    for (int c = 0; c < d.dim(); ++c) values(n, c) = value[c];
  }
  return result;
}

std::vector<double> by_node_id(const fem::Discretization &d, const MultiVector &nodal)
{
  const auto values = nodal.getLocalViewHost(Tpetra::Access::ReadOnly);
  return rpc::test::by_node_id(*d.mesh, d.dim(), [&](const LO n, const int c) { return values(n, c); });
}

/// f, known at the coarse nodes, at the fine ones.
template <class Function>
std::vector<double> interpolated(const fem::Discretization &coarse, const fem::Discretization &fine, const Function &f)
{
  MultiVector result(fine.mesh->owned_nodes, fine.dim());
  fem::interpolation(coarse, fine)->apply(at_nodes(coarse, f), result);
  return by_node_id(fine, result);
}

/// The largest error of f's interpolation, relative to f.
template <class Function>
double error_of(const fem::Discretization &coarse, const fem::Discretization &fine, const Function &f)
{
  return difference(interpolated(coarse, fine, f), by_node_id(fine, at_nodes(fine, f)));
}

/// The same mesh, which is no longer known to be a box: cells are searched for.
fem::Discretization no_box(fem::Discretization d)
{
  const auto mesh = std::make_shared<mesh::Mesh>(*d.mesh);
  mesh->box = nullptr;
  d.mesh = mesh;
  return d;
}

/// The small box with more cells; ranks divide it along another direction than the small one.
mesh::BoxOptions finer_box(const mesh::Element &element)
{
  auto box = small_box(element);
  box.cells = element.dim == 2 ? std::vector<int>{7, 11} : std::vector<int>{4, 3, 5};
  return box;
}

/// Calls work(coarse element, fine element) for all pairs of one dimension.
template <class Work>
void for_each_pair(const Work &work)
{
  for (const mesh::Element &coarse : elements())
    for (const mesh::Element &fine : elements())
      if (coarse.dim == fine.dim) {
        SCOPED_TRACE(text_of(coarse) + " to " + text_of(fine));
        work(coarse, fine);
      }
}

TEST(Interpolation, AffineFunctionsAreExactInCellsOfAnyShape)
{
  for_each_pair([](const mesh::Element &coarse, const mesh::Element &fine) {
    const auto from = bulged_body(coarse, world());
    const auto to = body(finer_box(fine), world());
    EXPECT_LT(error_of(from, to, [&](const Point &x) { return linear(x, from.dim()); }), 1e-13);
  });
}

TEST(Interpolation, ReproducesTheCoarseSpace)
{
  for_each_pair([](const mesh::Element &coarse, const mesh::Element &fine) {
    const auto from = body(small_box(coarse), world()), to = body(finer_box(fine), world());
    ASSERT_TRUE(from.mesh->box && to.mesh->box);
    const auto f = [&](const Point &x) {
      const double product = coarse.shape == mesh::Shape::tensor ? x[0] * x[1] * (from.dim() == 3 ? x[2] : 1) : 0;
      return coarse.order == 1 ? Point{product + x[1], x[0] - 1, product - x[0]}
                               : Point{x[0] * x[0] - x[0] * x[1] + product, 2 + x[1] * x[1]};
    };
    EXPECT_LT(error_of(from, to, f), 1e-13);
    EXPECT_LT(error_of(no_box(from), to, f), 1e-13);
  });
}

/// Rows of a matrix with gids of their columns, in the matrix' order of columns.
std::vector<std::vector<std::pair<GO, double>>> rows_of(const CrsMatrix &matrix)
{
  const auto local = matrix.getLocalMatrixHost();
  std::vector<std::vector<std::pair<GO, double>>> rows(local.numRows());
  for (LO row = 0; row < local.numRows(); ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k) {
      if (k > local.graph.row_map(row)) {
        EXPECT_LT(local.graph.entries(k - 1), local.graph.entries(k));
      }
      rows[row].emplace_back(matrix.getColMap()->getGlobalElement(local.graph.entries(k)), local.values(k));
    }
  return rows;
}

/// Indices give the matrix of the search, entry by entry.
void expect_rows_of_search(const fem::Discretization &from, const fem::Discretization &to)
{
  ASSERT_TRUE(from.mesh->box && to.mesh->box);
  const auto by_index = fem::interpolation(from, to), by_search = fem::interpolation(no_box(from), no_box(to));
  EXPECT_TRUE(by_index->getRowMap()->isSameAs(*by_search->getRowMap()));
  EXPECT_TRUE(by_index->getDomainMap()->isSameAs(*by_search->getDomainMap()));
  EXPECT_TRUE(by_index->getRangeMap()->isSameAs(*by_search->getRangeMap()));
  const auto rows = rows_of(*by_index), searched = rows_of(*by_search);
  ASSERT_EQ(rows.size(), searched.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    ASSERT_EQ(rows[row].size(), searched[row].size()) << "row " << row;
    double sum = 0;
    for (std::size_t k = 0; k < rows[row].size(); ++k) {
      EXPECT_EQ(rows[row][k].first, searched[row][k].first);
      EXPECT_NEAR(rows[row][k].second, searched[row][k].second, 1e-12);
      sum += rows[row][k].second;
    }
    EXPECT_NEAR(sum, 1, 1e-14);
  }
}

TEST(Interpolation, BetweenDivisionsOfABoxIsThatOfTheSearch)
{
  for_each_pair([](const mesh::Element &coarse, const mesh::Element &fine) {
    const auto from = body(small_box(coarse), world()), to = body(finer_box(fine), world());
    expect_rows_of_search(from, to);
    expect_rows_of_search(to, from);
  });
}

/// Down to boxes of a few cells, by ever longer last cells, and from the last one straight to the first and back.
TEST(Interpolation, BetweenHalvedBoxesIsThatOfTheSearch)
{
  for (const mesh::Element &element : elements()) {
    if (element.order == 2) continue;
    SCOPED_TRACE(text_of(element));
    auto box = small_box(element);
    box.cells = element.dim == 2 ? std::vector<int>{27, 13} : std::vector<int>{11, 7, 9};
    const auto finest = body(box, world());
    auto fine = finest;
    int levels = 0;
    for (auto coarse = mesh::coarsened(box); coarse && coarse->cells[0] >= 3;
         coarse = mesh::coarsened(*coarse), ++levels) {
      const auto next = body(mesh::divided(*coarse, world()->getSize(), 50), world()); // at last on one rank
      expect_rows_of_search(next, fine);
      fine = next;
    }
    EXPECT_GE(levels, 1);
    expect_rows_of_search(fine, finest);
    expect_rows_of_search(finest, fine);
  }
}

/// Far from the origin too, where coordinates are rounded.
TEST(Interpolation, OfHalvedCellsHasExactWeights)
{
  for (const mesh::Element &element : elements()) {
    if (element.order == 2) continue;
    SCOPED_TRACE(text_of(element));
    auto box = small_box(element);
    for (double &end : box.lower) end += 1e3;
    for (double &end : box.upper) end += 1e3;
    for (int &cells : box.cells) cells = 8;
    const auto fine = body(box, world()), coarse = body(*mesh::coarsened(*mesh::coarsened(box)), world());
    for (const auto &row : rows_of(*fem::interpolation(coarse, fine)))
      for (const auto &[gid, weight] : row) EXPECT_EQ(64 * weight, std::round(64 * weight));
    for (const auto &row : rows_of(*fem::interpolation(fine, coarse))) {
      ASSERT_EQ(row.size(), 1U);
      EXPECT_EQ(row[0].second, 1);
    }
  }
}

TEST(Interpolation, IsToldTheBoxOfTheVerticesOfOrderTwo)
{
  for (const mesh::Element &element : elements()) {
    if (element.order == 1) continue;
    SCOPED_TRACE(text_of(element));
    const auto quadratic = body(finer_box(element), world());
    const auto vertices = fem::discretize(fem::order_one(quadratic).mesh);
    const auto coarse = body(*mesh::coarsened(*vertices.mesh->box), world());
    expect_rows_of_search(coarse, vertices);
    expect_rows_of_search(vertices, coarse);
  }
}

TEST(Interpolation, RowsSumToOneEvenOutsideTheMesh)
{
  for_each_pair([](const mesh::Element &coarse, const mesh::Element &fine) {
    auto larger = finer_box(fine);
    for (int d = 0; d < fine.dim; ++d) larger.upper[d] += 0.4, larger.lower[d] -= 0.3;
    EXPECT_LT(error_of(bulged_body(coarse, world()), body(larger, world()),
                       [](const Point &) {
                         return Point{1, -2, 0.5};
                       }),
              1e-15);
  });
}

TEST(Interpolation, TakesTheNearestPointsValueOutside)
{
  for (const mesh::Element &element : elements()) {
    if (element.shape == mesh::Shape::simplex) continue; // not the nearest point
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    auto larger = finer_box(element);
    for (int d = 0; d < element.dim; ++d) larger.upper[d] += 0.7, larger.lower[d] -= 3;
    const auto from = body(box, world()), to = body(larger, world());
    const auto expected = at_nodes(to, [&](Point x) {
      for (int d = 0; d < element.dim; ++d) x[d] = std::min(std::max(x[d], box.lower[d]), box.upper[d]);
      return linear(x, element.dim);
    });
    EXPECT_LT(difference(interpolated(from, to, [&](const Point &x) { return linear(x, element.dim); }),
                         by_node_id(to, expected)),
              1e-13);
  }
}

/// [0, 1] x [0, 1] becomes a quarter of a ring, of radii 1 and 2.
Point ring(const Point &x)
{
  const double angle = std::acos(0.) * x[0], radius = 2 - x[1];
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

TEST(Interpolation, DeviatesAtCurvedBoundariesNoMoreThanTheBoundaryDoes)
{
  for (const mesh::Element &element : elements()) {
    if (element.dim == 3) continue;
    SCOPED_TRACE(text_of(element));
    const auto from = body({{0, 0}, {1, 1}, {8, 4}, element}, world(), ring);
    const auto to = body({{0, 0}, {1, 1}, {37, 19}, element}, world(), ring);
    const double angle = std::acos(0.) / 8, deviation = 2 * (1 - std::cos(angle / 2)); // of a chord from its arc
    const double error = error_of(from, to, [](const Point &x) { return Point{1 + x[0], 2 - x[1]}; });
    EXPECT_LT(error, deviation / 2);
    EXPECT_LT(element.order == 2 ? error : 0, deviation / 20); // edges of order 2 follow the arc
  }
}

TEST(Interpolation, IsExactAtPointsOfCurvedCells)
{
  for (const mesh::Element &element : elements()) {
    if (element.dim == 3) continue;
    SCOPED_TRACE(text_of(element));
    const mesh::BoxOptions box{{0, 0}, {1, 1}, {2, 1}, element}, finer{{0, 0}, {1, 1}, {15, 13}, {2, 2}};
    const auto straight = body(box, alone()), curved = body(box, alone(), ring),
               fine = body(finer, alone(), [](const Point &x) { return x; });
    MultiVector x(fine.mesh->owned_nodes, 2);
    fem::interpolation(straight, fine)->apply(*fem::node_coordinates(curved), x); // where the cells' own maps take them
    Kokkos::deep_copy(fine.mesh->coords, x.getLocalViewDevice(Tpetra::Access::ReadOnly));
    EXPECT_LT(error_of(curved, fine, [](const Point &at) { return linear(at, 2); }), 1e-12);
  }
}

TEST(Interpolation, FindsCellsOfVeryDifferentSizes)
{
  const auto graded = [](const Point &x) { return Point{x[0] * x[0] * x[0] * x[0] + 1e3, std::pow(x[1], 6), 0}; };
  for (const mesh::Element &element : elements()) {
    if (element.dim == 3) continue;
    SCOPED_TRACE(text_of(element));
    const auto from = body({{0, 0}, {1, 1}, {20, 10}, element}, world(), graded);
    const auto to = body({{0, 0}, {1, 1}, {40, 30}, element}, world(), graded);
    const auto f = [](const Point &x) { return Point{x[0] - 1e3, x[1]}; };
    EXPECT_LT(error_of(from, to, f), element.order == 1 ? 2e-12 : 1e-2); // curved edges stay behind the finer ones
  }
}

TEST(Interpolation, BetweenEqualMeshesIsTheIdentity)
{
  for (const mesh::Element &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto matrix = fem::interpolation(d, d);
    EXPECT_EQ(matrix->getGlobalNumEntries(), d.mesh->owned_nodes->getGlobalNumElements());
    EXPECT_LT(error_of(d, d, wild), 1e-14);
  }
}

TEST(Interpolation, HasTheMapsOfBothMeshesAndAscendingColumns)
{
  const auto from = bulged_body({2, 2}, world()), to = body(finer_box({2, 1}), world());
  const auto matrix = fem::interpolation(from, to);
  EXPECT_TRUE(matrix->isFillComplete());
  EXPECT_TRUE(matrix->getRowMap()->isSameAs(*to.mesh->owned_nodes));
  EXPECT_TRUE(matrix->getRangeMap()->isSameAs(*to.mesh->owned_nodes));
  EXPECT_TRUE(matrix->getDomainMap()->isSameAs(*from.mesh->owned_nodes));
  const auto local = matrix->getLocalMatrixHost();
  for (LO row = 0; row < local.numRows(); ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k) {
      EXPECT_GT(std::abs(local.values(k)), 1e-12);
      const bool first = k == local.graph.row_map(row);
      EXPECT_LT(first ? -1 : local.graph.entries(k - 1), local.graph.entries(k));
    }
}

TEST(Interpolation, IsTheSameOnAnyNumberOfRanks)
{
  for_each_pair([](const mesh::Element &coarse, const mesh::Element &fine) {
    auto larger = finer_box(fine);
    larger.upper[0] += 0.2;
    const auto serial = interpolated(bulged_body(coarse, alone()), body(larger, alone(), bulge(larger)), wild);
    const auto parallel = interpolated(bulged_body(coarse, world()), body(larger, world(), bulge(larger)), wild);
    EXPECT_LT(difference(parallel, serial), 1e-15);
  });
}

/// A whole mesh on one rank; the others have nothing.
fem::Discretization all_on(const int rank, const mesh::Mesh &whole)
{
  const bool here = world()->getRank() == rank;
  const auto all = std::make_shared<mesh::Mesh>();
  const LO nodes = here ? whole.num_owned_nodes() : 0, cells = here ? whole.num_owned_cells : 0;
  all->element = whole.element;
  all->owned_nodes = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), nodes, 0, world()));
  all->coords = here ? whole.coords : DeviceView<double **>("coords", 0, whole.dim());
  all->cells = here ? whole.cells : DeviceView<LO **>("cells", 0, whole.element.num_nodes());
  all->node_id = here ? whole.node_id : mesh::Ids();
  all->cell_id = here ? whole.cell_id : mesh::Ids();
  all->num_owned_cells = cells;
  fem::Discretization d;
  d.mesh = all;
  return d;
}

TEST(Interpolation, RanksMayHaveNothing)
{
  for_each_pair([](const mesh::Element &coarse, const mesh::Element &fine) {
    auto larger = finer_box(fine);
    larger.lower[1] -= 0.3;
    const auto from = bulged_body(coarse, alone()), to = body(larger, alone(), bulge(larger));
    const auto serial = interpolated(from, to, wild);
    const int last = world()->getSize() - 1;
    EXPECT_LT(difference(interpolated(all_on(last, *from.mesh), all_on(0, *to.mesh), wild), serial), 1e-15);
    EXPECT_LT(difference(interpolated(bulged_body(coarse, world()), all_on(0, *to.mesh), wild), serial), 1e-15);
    EXPECT_LT(difference(interpolated(all_on(last, *from.mesh), body(larger, world(), bulge(larger)), wild), serial),
              1e-15);
  });
}

TEST(Interpolation, FarFromAllCellsTakesTheNearestOfAllRanks)
{
  for (const mesh::Element &element : elements()) {
    SCOPED_TRACE(text_of(element));
    auto away = finer_box(element);
    for (int d = 0; d < element.dim; ++d) away.upper[d] += 50, away.lower[d] += 50;
    const auto serial = interpolated(bulged_body(element, alone()), body(away, alone()), wild);
    const auto parallel = interpolated(bulged_body(element, world()), body(away, world()), wild);
    EXPECT_LT(difference(parallel, serial), 1e-15);
  }
}

TEST(Interpolation, ItsTransposeKeepsSums)
{
  const auto from = bulged_body({2, 1}, world()), to = body(finer_box({2, 2}), world());
  const auto fine = at_nodes(to, wild);
  MultiVector coarse(from.mesh->owned_nodes, 2);
  fem::interpolation(from, to)->apply(fine, coarse, Teuchos::TRANS);
  const auto sum = [](const std::vector<double> &values) {
    double total = 0;
    for (const double value : values) total += value;
    return total;
  };
  const auto values = by_node_id(to, fine);
  EXPECT_NEAR(sum(by_node_id(from, coarse)), sum(values), 1e-13 * values.size());
}

TEST(Interpolation, BetweenDifferentDimensionsIsRefused)
{
  const auto plane = body(small_box({2, 1}), world()), solid = body(small_box({3, 1}), world());
  expect_error(ExitCode::bad_input, {"2D", "3D"}, [&] { fem::interpolation(plane, solid); });
}

} // namespace
} // namespace interpolation_test
