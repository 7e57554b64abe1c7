// SPDX-License-Identifier: BSD-3-Clause
// The stiffness of all elements, of single cells and of patches of them.

#include "block_mesh.hpp"
#include "bodies.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/distribute.hpp"
#include "stiffness_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace stiffness_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using mesh::all_elements;
using mesh::Element;

using Matrix = std::vector<std::vector<double>>;
using Nodes = std::vector<Point>;

/// Moves the vertices; other nodes stay in the middle of theirs, so that edges are straight.
mesh::MeshData with_vertices_moved(mesh::MeshData data, const Deformation &move)
{
  const int dim = data.element.dim, width = data.element.num_nodes();
  const std::vector<double> before = data.coords;
  const auto moved = [&](const int node) {
    Point x{};
    std::copy_n(&before[dim * node], dim, x.begin());
    return move(x);
  };
  fem::with_static_extents(data.element, [&](const auto dimension, const auto nodes) {
    constexpr int vertices = mesh::StaticElement<dimension, nodes>::vertices;
    const mesh::ShapeFunctions<dimension, nodes> functions;
    const mesh::ShapeFunctions<dimension, vertices> of_vertices;
    for (int c = 0; c < data.num_cells(); ++c)
      for (int a = 0; a < nodes; ++a) {
        double X[dimension], N[vertices], dN[vertices][dimension];
        functions.node(a, X);
        of_vertices.evaluate(X, N, dN);
        double *const x = &data.coords[dim * data.cells[width * c + a]];
        std::fill_n(x, dim, 0.);
        for (int v = 0; v < vertices; ++v) {
          const Point at = moved(data.cells[width * c + v]);
          for (int d = 0; d < dim; ++d) x[d] += N[v] * at[d];
        }
      }
  });
  return data;
}

fem::Discretization body_of(const mesh::MeshData &data, const RCP<const Comm> &comm,
                            const fem::Kinematics kinematics = fem::Kinematics::plane_strain)
{
  return fem::discretize(std::make_shared<mesh::Mesh>(mesh::distribute(data, comm)), kinematics);
}

/// The block of 3 x 2 x 2 lattice cells with its inside out of shape; its boundary stays.
mesh::MeshData patch(const Element &element)
{
  return with_vertices_moved(block(element, {3, 2, 2}), [&](const Point &x) {
    double bubble = 0.15;
    const double length[3] = {3, 2, 2};
    for (int d = 0; d < element.dim; ++d) bubble *= x[d] == 0 || x[d] == length[d] ? 0 : 1;
    return Point{x[0] + bubble, x[1] - 1.3 * bubble * (1 + 0.2 * x[0]), x[2] + 0.7 * bubble};
  });
}

/// An affine map without any symmetry, and its determinant.
Point sheared(const Point &x, const int dim)
{
  const double A[3][3] = {{1.2, 0.3, -0.2}, {-0.1, 0.8, 0.4}, {0.25, -0.15, 1.1}};
  Point y{0.7, -0.4, dim == 3 ? 0.9 : 0.};
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) y[i] += A[i][j] * x[j];
  return y;
}
double determinant(const int dim)
{
  if (dim == 2) return 1.2 * 0.8 + 0.1 * 0.3;
  return 1.2 * (0.8 * 1.1 + 0.15 * 0.4) - 0.3 * (-0.1 * 1.1 - 0.25 * 0.4) - 0.2 * (0.1 * 0.15 - 0.25 * 0.8);
}

const fem::Material steel{200, 0.3, fem::Dilatation::full}, rubber{30, 0.49, fem::Dilatation::projected};

/// The stress that linear() causes: lambda tr(eps) delta_ij + 2 mu eps_ij.
double stress(const fem::Material &material, const int dim, const int i, const int j)
{
  double trace = 0;
  for (int k = 0; k < dim; ++k) trace += slope[k][k];
  return material.mu() * (slope[i][j] + slope[j][i]) + (i == j ? material.lambda() * trace : 0);
}

struct Cell {
  Nodes x;
  Matrix k;
};

template <int Dim, int Count>
std::vector<Cell> cells_of(const fem::Discretization &d, const fem::Material &material)
{
  constexpr int dofs = Dim * Count;
  const LO num_cells = d.mesh->num_cells();
  const fem::CellStiffness<Dim, Count> stiffness{fem::elastic_cells<Dim, Count>(d, material)};
  const DeviceView<double *[dofs][dofs]> device("matrix", num_cells);
  EXPECT_EQ(fem::tabulate_stiffness(stiffness, fem::CellsFrom{0, d.mesh->block}, num_cells, device), 0);
  const auto matrix = to_host(device);
  const auto conn = to_host(d.mesh->cells);
  std::vector<Cell> cells;
  for (LO c = 0; c < num_cells; ++c) {
    Cell cell;
    for (int a = 0; a < Count; ++a) cell.x.push_back(point_of(d, conn(c, a)));
    cell.k.assign(dofs, std::vector<double>(dofs));
    for (int r = 0; r < dofs; ++r)
      for (int s = 0; s < dofs; ++s) cell.k[r][s] = matrix(c, r, s);
    cells.push_back(cell);
  }
  return cells;
}

/// Places and stiffness of each cell of a body that one rank has whole.
std::vector<Cell> cells_of(const fem::Discretization &d, const fem::Material &material)
{
  std::vector<Cell> cells;
  fem::with_static_extents(d.mesh->element,
                           [&](const auto dim, const auto nodes) { cells = cells_of<dim, nodes>(d, material); });
  return cells;
}

/// k u for a displacement of the nodes of a cell.
template <class Displacement>
Nodes forces(const Cell &cell, const int dim, const Displacement &u)
{
  Nodes f(cell.x.size());
  for (std::size_t a = 0; a < f.size(); ++a)
    for (std::size_t b = 0; b < f.size(); ++b) {
      const Point at = u(cell.x[b]);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) f[a][i] += cell.k[rpc::dof(dim, a, i)][rpc::dof(dim, b, j)] * at[j];
    }
  return f;
}

double largest(const Matrix &k)
{
  double most = 0;
  for (const auto &row : k)
    for (const double entry : row) most = std::max(most, std::abs(entry));
  return most;
}

/// A parameter that is printed by name.
class AllElements : public testing::TestWithParam<Element>
{
protected:
  int dim = GetParam().dim;

  void expect_small(const Nodes &f, const double scale) const
  {
    for (const Point &at : f)
      for (int i = 0; i < dim; ++i) EXPECT_NEAR(at[i], 0, 1e-12 * scale);
  }
};

TEST_P(AllElements, HaveSymmetricCellStiffness)
{
  for (const fem::Material &material : {steel, rubber})
    for (const Cell &cell : cells_of(body_of(patch(GetParam()), alone()), material)) {
      const double scale = largest(cell.k);
      double asymmetry = 0;
      for (std::size_t r = 0; r < cell.k.size(); ++r)
        for (std::size_t s = 0; s < r; ++s) asymmetry = std::max(asymmetry, std::abs(cell.k[r][s] - cell.k[s][r]));
      EXPECT_GT(scale, 0);
      EXPECT_LT(asymmetry, 1e-13 * scale);
    }
}

TEST_P(AllElements, FeelNoRigidMotionOfACellAndResistAllOthers)
{
  for (const fem::Material &material : {steel, rubber})
    for (const Cell &cell : cells_of(body_of(patch(GetParam()), alone()), material)) {
      const double scale = largest(cell.k);
      for (int i = 0; i < dim; ++i) {
        expect_small(forces(cell, dim,
                            [&](const Point &) {
                              Point u{};
                              u[i] = 1;
                              return u;
                            }),
                     scale);
        for (int j = 0; j < i; ++j)
          expect_small(forces(cell, dim,
                              [&](const Point &x) {
                                Point u{};
                                u[i] = x[j];
                                u[j] = -x[i];
                                return u;
                              }),
                       4 * scale);
      }
      const Nodes f = forces(cell, dim, wild);
      double work = 0;
      for (std::size_t a = 0; a < f.size(); ++a)
        for (int i = 0; i < dim; ++i) work += f[a][i] * wild(cell.x[a])[i];
      EXPECT_GT(work, 1e-6 * scale);
    }
}

TEST_P(AllElements, BalanceAConstantStressOverACell)
{
  // By hand: sum_a x_aj f_ai = int sigma_ik d(sum_a x_aj N_a)/dx_k = V sigma_ij, and the forces sum to 0.
  const auto data = with_vertices_moved(block(GetParam(), {1, 1, 1}), [&](const Point &x) { return sheared(x, dim); });
  for (const fem::Material &material : {steel, rubber}) {
    const auto cells = cells_of(body_of(data, alone()), material);
    for (const Cell &cell : cells) {
      const Nodes f = forces(cell, dim, [&](const Point &x) { return linear(x, dim); });
      const double volume = determinant(dim) / cells.size();
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
          double moment = 0, sum = 0;
          for (std::size_t a = 0; a < f.size(); ++a) {
            moment += f[a][i] * cell.x[a][j];
            sum += f[a][i];
          }
          EXPECT_NEAR(moment, volume * stress(material, dim, i, j), 1e-12 * largest(cell.k));
          EXPECT_NEAR(sum, 0, 1e-12 * largest(cell.k));
        }
    }
  }
}

TEST_P(AllElements, PassThePatchTest)
{
  const Element element = GetParam();
  const auto d = body_of(patch(element), world());
  for (const fem::Material &material : {steel, rubber}) {
    const auto K = fem::assemble_stiffness(d, material);
    const auto u = interpolate(d, [&](const Point &x) { return linear(x, dim); });
    Vector f(d.owned_dofs);
    K->apply(*u, f);
    const auto values = f.getLocalViewHost(Tpetra::Access::ReadOnly);
    const double scale = stress(material, dim, 0, 0), length[3] = {3, 2, 2};
    std::array<double, 9> mine{}, moment{};
    int inside = 0;
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      const Point x = point_of(d, n);
      bool boundary = false;
      for (int c = 0; c < dim; ++c) boundary = boundary || x[c] == 0 || x[c] == length[c];
      for (int i = 0; i < dim; ++i) {
        const double force = values(rpc::dof(dim, n, i), 0);
        if (!boundary) {
          EXPECT_NEAR(force, 0, 1e-12 * std::abs(scale));
        }
        for (int j = 0; j < dim; ++j) mine[3 * i + j] += force * x[j];
      }
      inside += boundary ? 0 : 1;
    }
    EXPECT_GT(sum_all(*world(), GO(inside)), 0);
    Teuchos::reduceAll(*world(), Teuchos::REDUCE_SUM, 9, mine.data(), moment.data());
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        EXPECT_NEAR(moment[3 * i + j], (dim == 3 ? 12 : 6) * stress(material, dim, i, j), 1e-11 * std::abs(scale));
  }
}

TEST_P(AllElements, HaveInternalForcesThatAreTheMatrixTimesTheDisplacement)
{
  const auto d = body_of(patch(GetParam()), world());
  for (const fem::Material &material : {steel, rubber}) {
    const auto u = interpolate(d, wild);
    Vector f(d.owned_dofs);
    fem::assemble_stiffness(d, material)->apply(*u, f);
    const auto work = fem::internal_work(d, material, *u);
    EXPECT_LT(difference(by_node_id(d, *work.forces), by_node_id(d, f)), 1e-12);
    EXPECT_NEAR(work.energy_norm_squared, u->dot(f), 1e-12 * u->dot(f));
  }
}

template <int Dim, int Nodes, bool Axisymmetric>
void expect_same_matrix_tabulated(const fem::Discretization &d, const fem::Material &material)
{
  const auto expected = to_host(fem::assemble_stiffness(d, material)->getLocalMatrixDevice().values);
  const fem::CellStiffness<Dim, Nodes, Axisymmetric> stiffness{
      fem::elastic_cells<Dim, Nodes, Axisymmetric>(d, material)};
  for (const LO at_a_time : {1, 5, 1000}) {
    const DeviceView<double *> values("values", expected.extent(0));
    EXPECT_EQ(fem::add_tabulated_stiffness(d, stiffness, at_a_time, values), 0);
    const auto host = to_host(values);
    double off = 0, scale = 0;
    for (std::size_t k = 0; k < expected.extent(0); ++k) {
      off = std::max(off, std::abs(host(k) - expected(k)));
      scale = std::max(scale, std::abs(expected(k)));
    }
    EXPECT_LT(off, 1e-14 * scale) << at_a_time << " at a time";
  }
}

TEST_P(AllElements, AddUpToTheSameMatrixHoweverManyCellsAreTabulatedAtATime)
{
  auto d = body_of(patch(GetParam()), world());
  d.congruent = {}; // each cell is integrated by itself
  fem::with_static_extents(d.mesh->element, [&](const auto dimension, const auto nodes) {
    expect_same_matrix_tabulated<dimension, nodes, false>(d, rubber);
    if constexpr (dimension == 2)
      expect_same_matrix_tabulated<dimension, nodes, true>(
          body_of(patch(GetParam()), world(), fem::Kinematics::axisymmetric), rubber);
  });
}

TEST_P(AllElements, CountCellsThatAreInsideOut)
{
  const auto mirrored = with_vertices_moved(block(GetParam(), {2, 1, 1}), [](const Point &x) {
    return Point{-x[0], x[1], x[2]};
  });
  const auto d = body_of(mirrored, alone());
  fem::with_static_extents(d.mesh->element, [&](const auto dimension, const auto nodes) {
    const fem::CellStiffness<dimension, nodes> stiffness{fem::elastic_cells<dimension, nodes>(d, steel)};
    const DeviceView<double *> values("values", fem::dof_graph(d)->getLocalGraphDevice().entries.extent(0));
    EXPECT_EQ(fem::add_tabulated_stiffness(d, stiffness, 2, values), d.mesh->num_cells());
  });
  expect_error(ExitCode::bad_mesh, "inverted", [&] { fem::assemble_stiffness(d, steel); });
}

INSTANTIATE_TEST_SUITE_P(Stiffness, AllElements, testing::ValuesIn(all_elements()), [](const auto &info) {
  return info.param.name() + "in" + std::to_string(info.param.dim) + "D";
});

TEST(CellStiffness, TakesAFewKilobytesOfAThreadsStack)
{
  for (const Element &element : all_elements())
    fem::with_static_extents(element, [&](const auto dim, const auto nodes) {
      using Stiffness = fem::CellStiffness<dim, nodes>;
      EXPECT_EQ(Stiffness::passes * Stiffness::at_once, int(nodes));
      EXPECT_LE(sizeof(typename Stiffness::Rows), 8192U);
      EXPECT_EQ(Stiffness::passes, dim == 3 && nodes == 27 ? 9 : 1);
    });
}

} // namespace
} // namespace stiffness_test
