// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/elasticity.hpp"

#include "bodies.hpp"

#include <limits>

namespace elasticity_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr fem::Material steel{2000, 0.3};

/// Stiffness of the unit square or cube, by hand.
///
/// N_a = prod_d X(s_d), X = t for s_d = 1 and 1 - t for s_d = -1, t = 0 .. 1 along d; so dX = s and
///     int dX_a dX_b = s_a s_b,   int dX_a X_b = s_a / 2,   int X_a X_b = 1/3 where s_a = s_b, else 1/6.
/// G_ij(a, b) = int dN_a/dx_i dN_b/dx_j is the product of one of these per direction, and
///     K(ai, bj) = lambda G_ij + mu G_ji + delta_ij mu sum_k G_kk.
/// For the square that makes K(0x, 0x) = (lambda + 3 mu)/3, K(0x, 0y) = (lambda + mu)/4, K(0x, 1x) = -lambda/3 - mu/2.
double unit_stiffness(const mesh::Element &element, const int a, const int i, const int b, const int j)
{
  const auto gradients = [&](const int m, const int n) {
    double product = 1;
    for (int d = 0; d < element.dim; ++d) {
      const int sa = 2 * element.lattice()[a][d] - 1, sb = 2 * element.lattice()[b][d] - 1;
      if (d == m && d == n)
        product *= sa * sb;
      else if (d == m)
        product *= sa / 2.;
      else if (d == n)
        product *= sb / 2.;
      else
        product *= sa == sb ? 1. / 3 : 1. / 6;
    }
    return product;
  };
  double k = steel.lambda() * gradients(i, j) + steel.mu() * gradients(j, i);
  for (int d = 0; i == j && d < element.dim; ++d) k += steel.mu() * gradients(d, d);
  return k;
}

TEST(Stiffness, OfAUnitQ1CellIsTheOneByHand)
{
  for (const mesh::Element element : {mesh::Element{2, 1}, mesh::Element{3, 1}}) {
    SCOPED_TRACE(text_of(element));
    const int dim = element.dim, nodes = element.num_nodes();
    const std::vector<double> lower(dim, 3.), upper(dim, 4.);
    const auto d = body({lower, upper, std::vector<int>(dim, 1), element}, alone());
    const auto K = dense(*fem::assemble_stiffness(d, steel));
    const auto cells = to_host(d.mesh->cells);
    ASSERT_EQ(static_cast<int>(K.size()), dim * nodes);
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i)
        for (int b = 0; b < nodes; ++b)
          for (int j = 0; j < dim; ++j)
            EXPECT_NEAR(K[dim * cells(0, a) + i][dim * cells(0, b) + j], unit_stiffness(element, a, i, b, j),
                        1e-14 * steel.youngs_modulus)
                << a << i << b << j;
  }
}

TEST(Stiffness, OfTheUnitSquareHasTheNumbersOfTheDerivation)
{
  const mesh::Element q1{2, 1};
  const double lambda = steel.lambda(), mu = steel.mu();
  const double first_row[4][2] = {{(lambda + 3 * mu) / 3, (lambda + mu) / 4},
                                  {-lambda / 3 - mu / 2, (lambda - mu) / 4},
                                  {-(lambda + 3 * mu) / 6, -(lambda + mu) / 4},
                                  {lambda / 6, (mu - lambda) / 4}};
  for (int b = 0; b < 4; ++b)
    for (int j = 0; j < 2; ++j) EXPECT_NEAR(unit_stiffness(q1, 0, 0, b, j), first_row[b][j], 1e-14 * lambda);
}

TEST(Stiffness, OfAUnitSquareOfTwoP1TrianglesIsTheOneByHand)
{
  // Right angles at (0, 0) and (1, 1). Gradients are constant: (-1, -1), (1, 0), (0, 1), and the opposite ones in the
  // other triangle; the area of each is 1/2.
  const auto d = body({{0, 0}, {1, 1}, {1, 1}, {2, 1, mesh::Shape::simplex}}, alone());
  const auto K = dense(*fem::assemble_stiffness(d, steel));
  const double lambda = steel.lambda(), mu = steel.mu();
  // Corners by x + 2 y.
  constexpr double gradient[2][4][2] = {{{-1, -1}, {1, 0}, {0, 1}, {0, 0}}, {{0, 0}, {0, -1}, {-1, 0}, {1, 1}}};
  std::array<LO, 4> node{};
  for (LO n = 0; n < 4; ++n) node[static_cast<int>(point_of(d, n)[0] + 2 * point_of(d, n)[1])] = n;
  ASSERT_EQ(K.size(), 8u);
  for (int a = 0; a < 4; ++a)
    for (int i = 0; i < 2; ++i)
      for (int b = 0; b < 4; ++b)
        for (int j = 0; j < 2; ++j) {
          double expected = 0;
          for (const auto &g : gradient) {
            expected += 0.5 * (lambda * g[a][i] * g[b][j] + mu * g[a][j] * g[b][i]);
            if (i == j) expected += 0.5 * mu * (g[a][0] * g[b][0] + g[a][1] * g[b][1]);
          }
          EXPECT_NEAR(K[2 * node[a] + i][2 * node[b] + j], expected, 1e-14 * steel.youngs_modulus) << a << i << b << j;
        }
  EXPECT_NEAR(K[2 * node[0]][2 * node[0]], (lambda + 3 * mu) / 2, 1e-14 * lambda);
  EXPECT_NEAR(K[2 * node[1]][2 * node[1]], (lambda + 3 * mu) / 2,
              1e-14 * lambda);                                     // two triangles, a right angle in none
  EXPECT_NEAR(K[2 * node[0]][2 * node[3] + 1], 0, 1e-14 * lambda); // they share no triangle
}

TEST(Stiffness, IsSymmetric)
{
  for (const auto &element : elements()) {
    const auto d = bulged_body(element, alone());
    EXPECT_LT(asymmetry(dense(*fem::assemble_stiffness(d, steel))), rounding_of(element)) << text_of(element);
  }
}

TEST(Stiffness, IsPositiveOnEverythingThatIsNoRigidMotion)
{
  for (const auto &element : elements()) {
    const auto d = bulged_body(element, world());
    const auto K = fem::assemble_stiffness(d, steel);
    Vector force(d.owned_dofs);
    for (const double phase : {0., 1., 2.}) {
      const auto u = interpolate(d, [&](const Point &x) { return wild({x[0] + phase, x[1], x[2] - phase}); });
      K->apply(*u, force);
      EXPECT_GT(u->dot(force), 0.01 * steel.mu()) << text_of(element);
    }
  }
}

TEST(Stiffness, RigidBodyModesGiveNoForce)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto K = fem::assemble_stiffness(d, steel);
    const auto modes = fem::rigid_body_modes(d);
    for (std::size_t mode = 0; mode < modes->getNumVectors(); ++mode) {
      Vector force(d.owned_dofs);
      K->apply(*modes->getVector(mode), force);
      EXPECT_LT(force.norm2(), 10 * rounding_of(element) * steel.youngs_modulus) << "mode " << mode;
    }
  }
}

TEST(Stiffness, LinearDisplacementLeavesInnerNodesInBalance)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = bulged_body(element, world());
    Vector force(d.owned_dofs);
    const auto u = interpolate(d, [&](const Point &x) { return linear(x, element.dim); });
    fem::assemble_stiffness(d, steel)->apply(*u, force);
    const auto forces = by_node_id(d, force);
    const auto points = by_node_id(*d.mesh, d.dim(), [&](const LO n, const int c) { return point_of(d, n)[c]; });
    double inside = 0, outside = 0;
    for (std::size_t node = 0; node < forces.size() / d.dim(); ++node) {
      bool on_boundary = false;
      for (int c = 0; c < d.dim(); ++c) {
        const double x = points[d.dim() * node + c];
        on_boundary = on_boundary || x == box.lower[c] || x == box.upper[c];
      }
      for (int c = 0; c < d.dim(); ++c) {
        double &largest = on_boundary ? outside : inside;
        largest = larger(largest, std::abs(forces[d.dim() * node + c]));
      }
    }
    EXPECT_LT(inside, 1e-13 * steel.youngs_modulus);
    EXPECT_GT(outside, 1e-3 * steel.youngs_modulus);
  }
}

TEST(Stiffness, EnergyOfALinearDisplacementIsThatOfItsConstantStrain)
{
  for (const auto &element : elements()) {
    const auto box = small_box(element);
    const auto d = bulged_body(element, world());
    Vector force(d.owned_dofs);
    const auto u = interpolate(d, [&](const Point &x) { return linear(x, element.dim); });
    fem::assemble_stiffness(d, steel)->apply(*u, force);
    double trace = 0, square = 0, volume = 1;
    for (int i = 0; i < element.dim; ++i) {
      trace += slope[i][i];
      volume *= box.upper[i] - box.lower[i];
      for (int j = 0; j < element.dim; ++j) square += std::pow(0.5 * (slope[i][j] + slope[j][i]), 2);
    }
    const double energy = volume * (steel.lambda() * trace * trace + 2 * steel.mu() * square);
    EXPECT_NEAR(u->dot(force), energy, 50 * rounding_of(element) * energy) << text_of(element);
  }
}

TEST(Stiffness, IsTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    const auto force = [&](const RCP<const Comm> &comm) {
      const auto d = bulged_body(element, comm);
      Vector result(d.owned_dofs);
      fem::assemble_stiffness(d, steel)->apply(*interpolate(d, wild), result);
      return by_node_id(d, result);
    };
    EXPECT_LT(difference(force(world()), force(alone())), 1e-13) << text_of(element);
  }
}

TEST(Stiffness, CellInsideOutOnOneRankIsABadMeshOnAll)
{
  const auto comm = world();
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const bool last = comm->getRank() == comm->getSize() - 1;
    const auto mirrored = body(small_box(element), comm, [&](const Point &x) {
      return Point{last ? -x[0] : x[0], x[1], x[2]};
    });
    expect_error(ExitCode::bad_mesh, {"inverted"}, [&] { fem::assemble_stiffness(mirrored, steel); });
    const auto flat = body(small_box(element), comm, [&](const Point &x) {
      return Point{x[0], last ? 0 : x[1], x[2]};
    });
    expect_error(ExitCode::bad_mesh, {"degenerate"}, [&] { fem::assemble_stiffness(flat, steel); });
  }
}

TEST(Stiffness, BadCellIsNamedByNumberBlockAndVertices)
{
  // The upper right corner of the last rectangle is pulled across its diagonal.
  const auto pulled = [](const mesh::Element &element) {
    const auto d = body({{0, 0}, {4, 3}, {4, 3}, element}, world(), [](const Point &x) {
      return x[0] == 4 && x[1] == 3 ? Point{2.5, 2.5, 0} : x;
    });
    auto mesh = std::make_shared<mesh::Mesh>(*d.mesh);
    mesh->blocks = {"soft", "hard part"};
    mesh->block = DeviceView<int *>("block", mesh->num_cells());
    Kokkos::deep_copy(mesh->block, 1);
    return fem::discretize(mesh);
  };
  using mesh::Shape;
  const std::string block = " of block \"hard part\" ", quad = "(3, 2) (4, 2) (2.5, 2.5) (3, 3)",
                    triangle = "(2.5, 2.5) (3, 3) (4, 2)";
  const auto refused = [&](const mesh::Element &element, const std::string &cell, const std::string &vertices) {
    SCOPED_TRACE(text_of(element));
    const auto d = pulled(element);
    const Error error = error_of([&] { fem::assemble_stiffness(d, steel); });
    EXPECT_EQ(error.code(), ExitCode::bad_mesh);
    const std::string text = error.what(), expected = "cell " + cell + block;
    EXPECT_NE(text.find(expected), std::string::npos) << text;
    ASSERT_GE(text.size(), vertices.size());
    EXPECT_EQ(text.substr(text.size() - vertices.size()), vertices); // no more than these
  };
  refused({2, 1}, "12", quad);
  refused({2, 2}, "12", quad);
  refused({2, 1, Shape::simplex}, "24", triangle);
  refused({2, 2, Shape::simplex}, "24", triangle);
}

TEST(InternalForces, AreTheStiffnessTimesTheDisplacement)
{
  for (const auto &element : elements()) {
    const auto d = bulged_body(element, world());
    const auto u = interpolate(d, wild);
    Vector force(d.owned_dofs);
    fem::assemble_stiffness(d, steel)->apply(*u, force);
    EXPECT_LT(difference(by_node_id(d, *fem::internal_work(d, steel, *u).forces), by_node_id(d, force)), 1e-13)
        << text_of(element);
  }
}

TEST(InternalForces, OfRigidMotionVanishHoweverFarItLeads)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto modes = fem::rigid_body_modes(d);
    for (const double far : {1., 1e6}) {
      Vector u(d.owned_dofs);
      for (std::size_t mode = 0; mode < modes->getNumVectors(); ++mode) u.update(far, *modes->getVector(mode), 1.);
      // The displacement itself is rounded.
      const double rounding = std::numeric_limits<double>::epsilon() * u.normInf();
      EXPECT_LT(fem::internal_work(d, steel, u).forces->norm2(), 100 * rounding * steel.youngs_modulus) << far;
    }
  }
}

TEST(InternalForces, SumToZeroAndHaveNoMoment)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto force = fem::internal_work(d, steel, *interpolate(d, wild)).forces;
    const auto modes = fem::rigid_body_modes(d);
    for (std::size_t mode = 0; mode < modes->getNumVectors(); ++mode)
      EXPECT_LT(std::abs(modes->getVector(mode)->dot(*force)), 1e-13 * force->norm1()) << "mode " << mode;
  }
}

} // namespace
} // namespace elasticity_test
