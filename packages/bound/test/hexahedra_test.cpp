// SPDX-License-Identifier: BSD-3-Clause
#include "hexahedra.hpp"

#include "facet_polynomials.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <random>

// Hexahedra that are split into tetrahedra, whose displacement is trilinear: against the functions themselves and integrals that the code under test
// does not use.

namespace hexahedra_test
{
namespace
{

using namespace rpc;
using namespace rpc::bound;

/// A block of 3 x 2 x 2 hexahedra, whose inner vertices lie anywhere if it is distorted; x = 0 is flat.
struct Block {
  fem::Discretization run, d;
  SplitHexahedra split;
  HexahedraInput in;
  RCP<Vector> u;

  explicit Block(const bool distorted)
  {
    mesh::BoxOptions box;
    box.lower = {0, 0, 0};
    box.upper = {2, 1, 1};
    box.cells = {3, 2, 2};
    box.element = mesh::Element{3, 1, mesh::Shape::tensor};
    const auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
    std::mt19937 random{11};
    std::uniform_real_distribution<double> draw(-1, 1);
    const auto x = mesh->coords;
    for (LO n = 0; n < mesh->num_local_nodes(); ++n) {
      const double move = x(n, 0) * (2 - x(n, 0)) * x(n, 1) * (1 - x(n, 1)) * x(n, 2) * (1 - x(n, 2));
      for (int i = 0; i < 3 && distorted; ++i) x(n, i) += move * draw(random);
    }
    mesh->box = nullptr;
    run = fem::discretize(mesh);
    split = split_hexahedra(run);
    d = fem::discretize(split.mesh);
    SpaceInput space;
    space.coords = mesh->coords;
    space.block = split.mesh->block;
    space.lame = DeviceView<double **>("lame", 1, 2);
    space.lame(0, 0) = 3;
    space.lame(0, 1) = 2;
    space.force[0] = 0.3;
    space.force[2] = -0.7;
    space.facets = space_facets_of(d);
    space.cells = space.facets.nodes_of_cell;
    space.reference = reference_stress(split.mesh->element);
    space.tables = facet_tables(1);
    space.num_owned_cells = split.mesh->num_owned_cells;
    in = hexahedra_input(run, d, split, space, {"left"});
    u = rcp(new Vector(run.owned_dofs));
    const auto to = device_write(*u);
    for (std::size_t i = 0; i < to.extent(0); ++i) to(i) = draw(random);
  }
  double volume(const LO c) const { return AffineTetrahedron(in, c).determinant / 6; }
  /// Where a vertex of a tetrahedron lies in its hexahedron.
  double reference(const LO c, const int v, const int m) const
  {
    double x[3];
    FieldOfHexahedra::place_of(in.corner(c, v), x);
    return x[m];
  }
};

TEST(Hexahedra, AreTheirTetrahedraWhichMeetInWholeFacets)
{
  for (const bool distorted : {false, true}) {
    const Block b(distorted);
    double volume = 0, area = 0;
    for (LO c = 0; c < b.in.num_cells(); ++c) {
      EXPECT_GT(b.volume(c), 0);
      volume += b.volume(c);
    }
    EXPECT_NEAR(volume, 2, 1e-13);
    EXPECT_GT(b.split.smallest, distorted ? 0.1 : 1 - 1e-12);
    for (LO f = 0; f < b.in.facets.size(); ++f) { // else facets within the body would have one cell
      if (!b.in.facets.on_boundary(f)) continue;
      const FacetFrame frame(b.in, f);
      const double unit =
          b.in.tables.linear(1, 1) * b.in.tables.linear(2, 2) - b.in.tables.linear(1, 2) * b.in.tables.linear(2, 1);
      area += std::sqrt(frame.normal[0] * frame.normal[0] + frame.normal[1] * frame.normal[1] +
                        frame.normal[2] * frame.normal[2]) /
              std::abs(2 * unit);
    }
    EXPECT_NEAR(area, 2 * (2 + 2 + 1), 1e-12);
    std::size_t of_sides = 0;
    for (const mesh::Side &side : b.split.mesh->sides) of_sides += side.cell.extent(0);
    EXPECT_EQ(of_sides, 2u * 2 * (3 * 2 + 3 * 2 + 2 * 2));
  }
}

TEST(Hexahedra, HaveTheTrilinearDisplacementOnTheirTetrahedra)
{
  // Of a box: u = (x y z, x y, z) and its derivatives, where nothing is flat.
  const Block b(false);
  const auto to = device_write(*b.u);
  const auto x = b.in.coords;
  for (LO n = 0; n < static_cast<LO>(x.extent(0)); ++n) {
    to(3 * n) = x(n, 0) * x(n, 1) * x(n, 2);
    to(3 * n + 1) = x(n, 0) * x(n, 1);
    to(3 * n + 2) = x(n, 2);
  }
  FieldOfHexahedra field = field_of_hexahedra(b.in, *b.u);
  field.flattened = false;
  const double lambda[4] = {0.1, 0.2, 0.3, 0.4};
  for (LO c = 0; c < b.in.num_cells(); ++c) {
    double place[3] = {}, value[3], D[3][3];
    for (int v = 0; v < 4; ++v)
      for (int i = 0; i < 3; ++i) place[i] += lambda[v] * x(b.in.cells(c, v), i);
    const FieldOfHexahedra::Here here(field, AffineTetrahedron(b.in, c), c);
    here.value(lambda, value);
    here.gradient(lambda, D);
    EXPECT_NEAR(value[0], place[0] * place[1] * place[2], 1e-13);
    EXPECT_NEAR(value[1], place[0] * place[1], 1e-13);
    EXPECT_NEAR(value[2], place[2], 1e-13);
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(D[0][j], place[(j + 1) % 3] * place[(j + 2) % 3], 1e-12);
      EXPECT_NEAR(D[2][j], j == 2 ? 1 : 0, 1e-12);
    }
  }
}

TEST(Hexahedra, HaveOneDisplacementOnBothSidesOfAFacetAndAFlatOneOnContactSides)
{
  const Block b(true);
  const FieldOfHexahedra field = field_of_hexahedra(b.in, *b.u);
  const auto u = device_read(*b.u);
  const double lambda[3] = {0.2, 0.5, 0.3};
  int flat = 0;
  for (LO f = 0; f < b.in.facets.size(); ++f) {
    double value[2][3];
    for (int side = 0; side < (b.in.facets.on_boundary(f) ? 1 : 2); ++side) {
      const LO c = b.in.facets.cell(f, side);
      double at[4] = {};
      for (int v = 0, k = 0; v < 4; ++v)
        if (v != b.in.facets.ordinal(f, side)) at[v] = lambda[k++];
      FieldOfHexahedra::Here(field, AffineTetrahedron(b.in, c), c).value(at, value[side]);
    }
    bool on_flat = b.in.facets.on_boundary(f);
    for (int v = 0; v < 3; ++v) on_flat = on_flat && b.in.coords(b.in.facets.node(f, v), 0) == 0;
    flat += on_flat;
    for (int i = 0; i < 3; ++i) {
      if (!b.in.facets.on_boundary(f)) {
        EXPECT_NEAR(value[0][i], value[1][i], 1e-13);
      }
      double linear = 0;
      for (int v = 0; v < 3; ++v) linear += lambda[v] * u(3 * b.in.facets.node(f, v) + i);
      if (on_flat) {
        EXPECT_NEAR(value[0][i], linear, 1e-13);
      }
    }
  }
  EXPECT_EQ(flat, 8);
}

TEST(Hexahedra, HaveDerivativesThatAreThoseOfTheirDisplacement)
{
  const Block b(true);
  const FieldOfHexahedra field = field_of_hexahedra(b.in, *b.u);
  constexpr double step = 1e-3; // of cubic polynomials central differences are off by its square
  int flat = 0;
  for (LO c = 0; c < b.in.num_cells(); ++c) {
    for (int e = 0; e < 6; ++e) flat += b.in.flat(c, e, 0) >= 0;
    const AffineTetrahedron cell(b.in, c);
    const FieldOfHexahedra::Here here(field, cell, c);
    double D[3][3];
    here.gradient({0.1, 0.2, 0.3, 0.4}, D);
    for (int l = 0; l < 3; ++l) {
      double at[2][4] = {{0.1, 0.2, 0.3, 0.4}, {0.1, 0.2, 0.3, 0.4}}, moved[2][3];
      for (int k = 0; k < 2; ++k) {
        at[k][l + 1] += k == 0 ? step : -step;
        at[k][0] -= k == 0 ? step : -step;
        here.value(at[k], moved[k]);
      }
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(D[i][0] * cell.F[0][l] + D[i][1] * cell.F[1][l] + D[i][2] * cell.F[2][l],
                    (moved[0][i] - moved[1][i]) / (2 * step), 1e-4)
            << "cell " << c;
    }
  }
  EXPECT_GT(flat, 0);
}

TEST(Hexahedra, CountTheWorkOfLoadsWithTheDisplacementOnFaces)
{
  // Against integrals of the displacement itself; the derivatives of the energy likewise.
  const Block b(true);
  BoundaryTractions boundary;
  const int count = FacetPolynomials::count(3, 3);
  boundary.known = DeviceView<char **>("known", b.in.facets.size(), 3);
  boundary.load = DeviceView<double ***>("load", b.in.facets.size(), count, 3);
  Kokkos::deep_copy(boundary.known, char(1));
  std::mt19937 random{5};
  std::uniform_real_distribution<double> draw(-1, 1);
  const FieldOfHexahedra field = field_of_hexahedra(b.in, *b.u);
  const FacetPolynomials polynomials(3, 3);
  const FacetRule rule = facet_rule(3, 5);
  SpaceForms forms;
  forms.boundary = DeviceView<double *>("boundary", static_cast<std::size_t>(b.in.facets.num_outer) * 9);
  add_bends_of_faces(b.in, *b.u, forms);
  const auto u = device_read(*b.u);
  double work = 0;
  for (LO f = 0; f < b.in.facets.size(); ++f) {
    if (!b.in.facets.on_boundary(f)) continue;
    double moment[10][3] = {};
    for (int q = 0; q < rule.size(); ++q) {
      double at[4] = {}, value[3];
      for (int v = 0, k = 0; v < 4; ++v)
        if (v != b.in.facets.ordinal(f, 0)) at[v] = rule.point[q][k++];
      const LO c = b.in.facets.cell(f, 0);
      FieldOfHexahedra::Here(field, AffineTetrahedron(b.in, c), c).value(at, value);
      for (int j = 0; j < count; ++j)
        for (int i = 0; i < 3; ++i) moment[j][i] += rule.weight[q] * polynomials(j, rule.point[q]) * value[i];
    }
    for (int j = 0; j < count; ++j)
      for (int i = 0; i < 3; ++i) {
        boundary.load(f, j, i) = draw(random);
        work += boundary.load(f, j, i) * moment[j][i];
        if (j >= 3) continue;
        double linear = 0;
        for (int a = 0; a < 3; ++a) linear += b.in.tables.moment(j, a) * u(3 * b.in.facets.node(f, a) + i);
        EXPECT_NEAR(forms.boundary(9 * static_cast<std::size_t>(f) + 3 * j + i), linear - moment[j][i], 1e-13);
      }
  }
  EXPECT_NEAR(work_of_loads(b.in, b.run.mesh->comm(), boundary, *b.u), work, 1e-11 * std::abs(work) + 1e-11);
}

TEST(Hexahedra, HandTheirForcesToTetrahedraInBalance)
{
  for (const bool distorted : {false, true}) {
    Block b(distorted);
    const auto without = nodal_forces(b.in, b.d, *b.u);
    BoundaryTractions none;
    none.load = DeviceView<double ***>("load", b.in.facets.num_outer, FacetPolynomials::count(3, 3), 3);
    b.in.shift = shift_of_loads(b.in, none); // of the body force
    const auto Q = nodal_forces(b.in, b.d, *b.u);
    double shifted = 0;
    for (LO c = 0; c < b.in.num_cells(); ++c) shifted = std::max(shifted, std::abs(Q(c, 0, 0) - without(c, 0, 0)));
    if (!distorted) {
      EXPECT_GT(shifted, 1e-4);
    }
    std::vector<double> sum(b.u->getLocalLength(), 0.), shift(sum);
    double largest = 0;
    for (LO c = 0; c < b.in.num_cells(); ++c) {
      double force[3] = {}, moment[3] = {}, centre[3] = {};
      for (int a = 0; a < 4; ++a)
        for (int i = 0; i < 3; ++i) {
          const int j = (i + 1) % 3, k = (i + 2) % 3;
          const LO n = b.in.cells(c, a);
          force[i] += Q(c, a, i);
          moment[i] += b.in.coords(n, j) * Q(c, a, k) - b.in.coords(n, k) * Q(c, a, j);
          centre[i] += b.in.coords(n, i) / 4;
          sum[3 * n + i] += without(c, a, i) + b.volume(c) * b.in.force[i] / 4;
          shift[3 * n + i] += Q(c, a, i) - without(c, a, i);
          largest = std::max(largest, std::abs(Q(c, a, i)));
        }
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        EXPECT_NEAR(force[i], -b.volume(c) * b.in.force[i], 1e-13);
        EXPECT_NEAR(moment[i], -b.volume(c) * (centre[j] * b.in.force[k] - centre[k] * b.in.force[j]), 1e-12);
      }
    }
    const fem::Materials materials(fem::Material{2. * (3 * 3 + 2 * 2) / (3 + 2), 3. / (2 * (3 + 2))});
    const auto forces = device_read(*fem::internal_work(b.run, materials, *b.u).forces);
    for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], forces(i), 1e-12 * largest);
    EXPECT_GT(largest, 0.1);
    // All in all the functions of hexahedra share the body force among the vertices.
    const auto of_hexahedra = rcp(new Vector(b.run.owned_dofs));
    fem::add_body_force(b.run, {ScalarField(b.in.force[0]), ScalarField(0.), ScalarField(b.in.force[2])}, "Body Force",
                        *of_hexahedra);
    const auto body = device_read(*of_hexahedra);
    std::vector<double> of_tetrahedra(sum.size(), 0.);
    for (LO c = 0; c < b.in.num_cells(); ++c)
      for (int a = 0; a < 4; ++a)
        for (int i = 0; i < 3; ++i) of_tetrahedra[3 * b.in.cells(c, a) + i] += b.volume(c) * b.in.force[i] / 4;
    for (std::size_t i = 0; i < sum.size() && !distorted; ++i)
      EXPECT_NEAR(of_tetrahedra[i] - shift[i], body(i), 1e-12) << i;
  }
}

TEST(Hexahedra, LoadsShiftForcesInBalanceAndNoneOfFacesThatAreNoParallelograms)
{
  for (const bool moved : {false, true}) {
    Block b(false);
    const auto x = b.in.coords;
    for (LO n = 0; n < static_cast<LO>(x.extent(0)); ++n) // an outer vertex, and one at x = 0
      if (moved && x(n, 1) == 1 && x(n, 2) == 1 && x(n, 0) != 1)
        for (int i = 0; i < 3; ++i) x(n, i) += (x(n, 0) == 0 ? -0.05 : 0.07) * (i + 1);
    BoundaryTractions boundary;
    boundary.load = DeviceView<double ***>("load", b.in.facets.num_outer, FacetPolynomials::count(3, 3), 3);
    std::mt19937 random{3};
    for (std::size_t f = 0; f < boundary.load.extent(0); ++f)
      for (std::size_t j = 0; j < boundary.load.extent(1); ++j)
        for (int i = 0; i < 3; ++i) boundary.load(f, j, i) = std::uniform_real_distribution<double>(-1, 1)(random);
    const auto shift = shift_of_loads(b.in, boundary);
    double largest = 0;
    for (LO h = 0; h < b.in.num_hexahedra(); ++h)
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        double force = 0, moment = 0;
        for (int a = 0; a < 8; ++a) {
          const LO n = b.in.hexahedra(h, a);
          force += shift(h, 3 * a + i);
          moment += x(n, j) * shift(h, 3 * a + k) - x(n, k) * shift(h, 3 * a + j);
          largest = std::max(largest, std::abs(shift(h, 3 * a + i)));
        }
        EXPECT_NEAR(force, 0, 1e-13);
        EXPECT_NEAR(moment, 0, 1e-12) << "cell " << h << ", moved: " << moved;
      }
    EXPECT_GT(largest, 1e-2);
  }
}

TEST(Hexahedra, HaveMeanMomentsOfBothSidesAlongTheNormalOfTheFirst)
{
  const Block b(true);
  const auto mean = mean_moments(b.in, *b.u);
  FieldOfHexahedra field = field_of_hexahedra(b.in, *b.u);
  field.flattened = false;
  const FacetRule rule = facet_rule(3, 5);
  double jump = 0; // of both sides
  for (LO f = 0; f < b.in.facets.size(); ++f) {
    const int both = b.in.facets.on_boundary(f) ? 1 : 2;
    double moment[2][3][3] = {};
    for (int side = 0; side < both; ++side) {
      const LO c = b.in.facets.cell(f, side);
      const int s = b.in.facets.ordinal(f, side);
      const AffineTetrahedron cell(b.in, c);
      const FieldOfHexahedra::Here here(field, cell, c);
      for (int q = 0; q < rule.size(); ++q) {
        double at[4] = {}, D[3][3], sigma[3][3];
        for (int v = 0, k = 0; v < 4; ++v)
          if (v != s) at[v] = rule.point[q][k++];
        here.gradient(at, D);
        stress_of_gradient(3, 2, D, sigma);
        for (int a = 0; a < 3; ++a)
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) { // the normal times the area is the slope of the vertex across, inwards
              const double slope =
                  s == 0 ? -cell.inverse[0][j] - cell.inverse[1][j] - cell.inverse[2][j] : cell.inverse[s - 1][j];
              moment[side][a][i] -=
                  (side == 0 ? 1 : -1) * rule.weight[q] * rule.point[q][a] * sigma[i][j] * slope * cell.determinant / 2;
            }
      }
    }
    for (int a = 0; a < 3; ++a)
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(mean((f * 3 + a) * 3 + i), (moment[0][a][i] + moment[1][a][i]) / both, 1e-12);
        if (both == 2) jump = std::max(jump, std::abs(moment[0][a][i] - moment[1][a][i]));
      }
  }
  EXPECT_GT(jump, 1e-2);
}

} // namespace
} // namespace hexahedra_test
