// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/fem/dirichlet.hpp"
#include "rpc/fem/stress.hpp"

#include <Teuchos_LAPACK.hpp>

// The projected dilatation, doc/theory.md (2.6).

namespace dilatation_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using fem::Dilatation;

constexpr fem::Material rubber{50, 0.4999, Dilatation::projected}, full_rubber{50, 0.4999, Dilatation::full};

std::vector<double> eigenvalues(const CrsMatrix &matrix)
{
  const auto rows = dense(matrix);
  const int n = static_cast<int>(rows.size());
  std::vector<double> a, values(n), work(10 * n);
  for (const auto &row : rows) a.insert(a.end(), row.begin(), row.end());
  int info = 0;
  Teuchos::LAPACK<int, double>().SYEV('N', 'U', n, a.data(), n, values.data(), work.data(),
                                      static_cast<int>(work.size()), &info);
  EXPECT_EQ(info, 0);
  return values; // ascending
}

TEST(ProjectedDilatation, StiffnessOfAUnitQ1CellIsTheOneByHand)
{
  // The mean of dN_a/dx_i over the unit square or cube is s_ai / 2^(dim - 1), with s_ai = +-1 the side on which a lies, so
  // that the difference of both stiffnesses is lambda (s_ai s_bj / 4^(dim - 1) - int dN_ai dN_bj).
  for (const mesh::Element element : {mesh::Element{2, 1}, mesh::Element{3, 1}}) {
    SCOPED_TRACE(text_of(element));
    const int dim = element.dim, nodes = element.num_nodes();
    const std::vector<double> lower(dim, 3.), upper(dim, 4.);
    const auto d = body({lower, upper, std::vector<int>(dim, 1), element}, alone());
    const auto K = dense(*fem::assemble_stiffness(d, rubber)), K_full = dense(*fem::assemble_stiffness(d, full_rubber));
    const auto cells = to_host(d.mesh->cells);
    const auto side = [&](const int a, const int i) { return 2 * element.lattice()[a][i] - 1; };
    const auto product = [&](const int a, const int i, const int b, const int j) { // int dN_ai dN_bj
      double result = 1;
      for (int k = 0; k < dim; ++k) {
        const int sa = side(a, k), sb = side(b, k);
        if (k == i && k == j)
          result *= sa * sb;
        else if (k == i)
          result *= sa / 2.;
        else if (k == j)
          result *= sb / 2.;
        else
          result *= sa == sb ? 1. / 3 : 1. / 6;
      }
      return result;
    };
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i)
        for (int b = 0; b < nodes; ++b)
          for (int j = 0; j < dim; ++j) {
            const int row = dim * cells(0, a) + i, col = dim * cells(0, b) + j;
            const double by_mean = side(a, i) * side(b, j) / std::pow(4., dim - 1);
            EXPECT_NEAR(K[row][col] - K_full[row][col], rubber.lambda() * (by_mean - product(a, i, b, j)),
                        1e-14 * rubber.lambda());
          }
  }
}

TEST(ProjectedDilatation, StiffnessIsSymmetricAndOnlyRigidMotionCostsNothing)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto K = fem::assemble_stiffness(one_cell(element), rubber);
    EXPECT_LT(asymmetry(dense(*K)), rounding_of(element));
    const auto values = eigenvalues(*K);
    const int rigid = element.dim == 2 ? 3 : 6;
    EXPECT_LT(std::abs(values[rigid - 1]), 1e-12 * values.back());
    EXPECT_GT(values[rigid], 0.01 * rubber.mu()); // the next: no hourglass
  }
}

TEST(ProjectedDilatation, OneCellResistsAChangeOfVolumeInAsManyWaysAsThereArePolynomials)
{
  const std::pair<mesh::Element, int> polynomials[] = {
      {{2, 1}, 1}, {{3, 1}, 1}, {{2, 2}, 3}, {{2, 2, mesh::Shape::simplex}, 2}}; // P2: two triangles
  for (const auto &[element, number] : polynomials) {
    const auto values = eigenvalues(*fem::assemble_stiffness(one_cell(element), rubber));
    int stiff = 0;
    for (const double value : values)
      if (value > 0.05 * rubber.lambda()) ++stiff; // the others are of the size of mu = 2e-4 lambda
    EXPECT_EQ(stiff, number) << text_of(element);
  }
}

TEST(ProjectedDilatation, ChangesNothingForLinearDisplacements)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto u = interpolate(d, [&](const Point &x) { return linear(x, element.dim); });
    const auto expected = by_node_id(d, *fem::internal_work(d, full_rubber, *u).forces);
    EXPECT_LT(difference(by_node_id(d, *fem::internal_work(d, rubber, *u).forces), expected), 1e-12);
    // And the patch test: none of these forces is inside.
    const auto box = small_box(element);
    const auto inside = interpolate(d, [&](const Point &x) {
      Point v = wild(x);
      for (int c = 0; c < element.dim; ++c)
        for (double &value : v) value *= (x[c] - box.lower[c]) * (box.upper[c] - x[c]);
      return v;
    });
    const auto force = fem::internal_work(d, rubber, *u).forces;
    EXPECT_LT(std::abs(inside->dot(*force)), 1e-12 * inside->normInf() * force->norm1());
  }
}

TEST(ProjectedDilatation, EnergyOfAUniformExpansionIsExact)
{
  for (const auto &element : elements()) {
    const auto d = bulged_body(element, world());
    const auto u = interpolate(d, [&](const Point &x) { return x; });
    const int dim = element.dim;
    const double energy = volume(d) * (rubber.lambda() * dim * dim + 2 * rubber.mu() * dim);
    EXPECT_NEAR(fem::internal_work(d, rubber, *u).energy_norm_squared, energy, 1e-12 * energy) << text_of(element);
  }
}

TEST(ProjectedDilatation, StiffnessForcesAndEnergyAreOfOnePiece)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const auto u = interpolate(d, wild), v = interpolate(d, [](const Point &x) {
                                           return wild({x[1], x[0], x[2] + 1});
                                         });
    Vector Ku(d.owned_dofs);
    fem::assemble_stiffness(d, rubber)->apply(*u, Ku);
    const auto force = fem::internal_work(d, rubber, *u).forces;
    EXPECT_LT(difference(by_node_id(d, *force), by_node_id(d, Ku)), 1e-12);
    const double energy = fem::internal_work(d, rubber, *u).energy_norm_squared;
    EXPECT_NEAR(u->dot(*force), energy, 1e-12 * energy);
    // a(u, u) is quadratic: a central difference is its derivative, 2 f(u) . v.
    const auto at = [&](const double t) {
      Vector moved(*u, Teuchos::Copy);
      moved.update(t, *v, 1.);
      return fem::internal_work(d, rubber, moved).energy_norm_squared;
    };
    EXPECT_NEAR((at(0.5) - at(-0.5)) / 2, v->dot(*force), 1e-12 * energy);
    if (element.num_nodes() > element.dim + 1) // it does something
      EXPECT_LT(energy, fem::internal_work(d, full_rubber, *u).energy_norm_squared);
    else
      EXPECT_EQ(energy, fem::internal_work(d, full_rubber, *u).energy_norm_squared);
  }
}

TEST(ProjectedDilatation, IsTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    const auto results = [&](const RCP<const Comm> &comm) {
      const auto d = bulged_body(element, comm);
      const auto u = interpolate(d, wild);
      Vector Ku(d.owned_dofs);
      fem::assemble_stiffness(d, rubber)->apply(*u, Ku);
      const auto stress = fem::RecoveredStress(d, rubber, *u).at_nodes();
      const auto values = stress->getLocalViewHost(Tpetra::Access::ReadOnly);
      const int columns = static_cast<int>(values.extent(1));
      return std::pair(by_node_id(d, Ku),
                       by_node_id(*d.mesh, columns, [&](const LO n, const int k) { return values(n, k); }));
    };
    const auto all = results(world()), one = results(alone());
    EXPECT_LT(difference(all.first, one.first), 1e-13) << text_of(element);
    EXPECT_LT(difference(all.second, one.second), 1e-11) << text_of(element);
  }
}

TEST(ProjectedDilatation, NodalStressesOfALinearDisplacementAreExact)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    auto row = small_box(element); // a row of cells has no vertex inside
    row.cells.assign(element.dim, 1);
    row.cells[0] = 3;
    for (const auto &d : {bulged_body(element, alone()), body(row, alone())}) {
      const auto u = interpolate(d, [&](const Point &x) { return linear(x, element.dim); });
      const auto stress = fem::RecoveredStress(d, rubber, *u).at_nodes();
      const auto values = stress->getLocalViewHost(Tpetra::Access::ReadOnly);
      double trace = 0;
      for (int i = 0; i < element.dim; ++i) trace += slope[i][i];
      for (std::size_t n = 0; n < values.extent(0); ++n)
        for (int i = 0; i < element.dim; ++i)
          EXPECT_NEAR(values(n, i), rubber.lambda() * trace + 2 * rubber.mu() * slope[i][i], 1e-11 * rubber.lambda());
    }
  }
}

/// Whether the dilatation is projected in a body of one block.
bool projects(const mesh::Element &element, const fem::Material &material)
{
  return to_host(fem::projected_dilatation_table(body(small_box(element), world()), material))(0) != 0;
}

TEST(AutomaticDilatation, IsProjectedInNearlyIncompressibleMaterials)
{
  const mesh::Element q1{2, 1}, q2{2, 2}, hexahedra{3, 1}, p2{2, 2, mesh::Shape::simplex};
  for (const auto &element : {q1, q2, hexahedra}) {
    EXPECT_FALSE(projects(element, {1, 0.4})) << text_of(element);
    EXPECT_TRUE(projects(element, {1, 0.401})) << text_of(element);
  }
  EXPECT_FALSE(projects(p2, {1, 0.48}));
  EXPECT_TRUE(projects(p2, {1, 0.481}));
  EXPECT_FALSE(projects(q1, {1, 0.49, Dilatation::full}));
  EXPECT_TRUE(projects(q1, {1, 0.2, Dilatation::projected}));
}

TEST(AutomaticDilatation, IsFullInPlaneStressWhereProjectedIsRefused)
{
  const auto d = body(small_box({2, 1}), world(), {}, fem::Kinematics::plane_stress);
  EXPECT_EQ(to_host(fem::projected_dilatation_table(d, fem::Material{1, 0.4999}))(0), 0);
  expect_error(ExitCode::bad_input, {"\"Material->Dilatation\" = projected", "plane stress", "Take auto or full"}, [&] {
    fem::projected_dilatation_table(d, fem::Material{1, 0.4999, Dilatation::projected});
  });
}

TEST(AutomaticDilatation, IsChosenBlockByBlock)
{
  auto d = body(small_box({2, 1}), world());
  auto mesh = std::make_shared<mesh::Mesh>(*d.mesh);
  mesh->blocks = {"steel", "rubber", "other rubber"};
  d.mesh = mesh;
  fem::Materials materials(fem::Material{1, 0.3});
  materials.block["rubber"] = {1, 0.49};
  materials.block["other rubber"] = {1, 0.49, Dilatation::full};
  const auto table = to_host(fem::projected_dilatation_table(d, materials));
  EXPECT_EQ(table(0), 0);
  EXPECT_EQ(table(1), 1);
  EXPECT_EQ(table(2), 0);
}

TEST(DilatationOption, IsReadForEachMaterialAndMisspellingsAreRefused)
{
  const auto read = [](Teuchos::ParameterList list) {
    validate(list, fem::valid_material_parameters(), "Material");
    return fem::material_options(list);
  };
  Teuchos::ParameterList list;
  list.set("Young's Modulus", 1.).set("Poisson's Ratio", 0.3);
  EXPECT_EQ(read(list).common.dilatation, Dilatation::automatic);
  const Teuchos::ParameterList rubber = list;
  list.sublist("Blocks").sublist("rubber") = rubber;
  list.set("Dilatation", "full");
  list.sublist("Blocks").sublist("rubber").set("Dilatation", "projected");
  EXPECT_EQ(read(list).common.dilatation, Dilatation::full);
  EXPECT_EQ(read(list).block.at("rubber").dilatation, Dilatation::projected);
  list.sublist("Blocks").sublist("rubber").set("Dilatation", "mean");
  expect_error(ExitCode::bad_input, {"\"Material->Blocks->rubber->Dilatation\"", "\"mean\""}, [&] { read(list); });
}

TEST(LockingNote, WarnsOfP1InNearlyIncompressibleMaterialsOnly)
{
  const auto note = [](const mesh::Element &element, const double nu) {
    return fem::locking_note(body(small_box(element), world()), fem::Material{1, nu});
  };
  const mesh::Element p1{2, 1, mesh::Shape::simplex}, p2{2, 2, mesh::Shape::simplex}, q1{2, 1};
  EXPECT_EQ(note(p1, 0.4), "");
  EXPECT_NE(note(p1, 0.45).find("nu = 0.45"), std::string::npos);
  EXPECT_NE(note(p1, 0.45).find("take Q2, P2 or Q1"), std::string::npos);
  EXPECT_EQ(note(p2, 0.4999), "");
  EXPECT_EQ(note(q1, 0.4999), "");
}

/// K = K_0 + Z^T diag(s) Z on the unknowns that are not prescribed.                                                   (4.13)
TEST(IncompressibilityNote, AdvisesQ2WherePressuresOfQ1Alternate)
{
  const auto note = [](const mesh::Element &element, const double nu) {
    return fem::incompressibility_note(body(small_box(element), world()), fem::Material{1, nu});
  };
  const mesh::Element p1{2, 1, mesh::Shape::simplex}, p2{2, 2, mesh::Shape::simplex}, q1{2, 1}, q2{2, 2};
  EXPECT_NE(note(q1, 0.4999).find("Q1 cells with nu = 0.4999"), std::string::npos);
  EXPECT_NE(note(q1, 0.4999).find("take Q2"), std::string::npos);
  EXPECT_EQ(note(p2, 0.4999), "") << "it has a mixed form";
  EXPECT_EQ(note(q1, 0.498), "");
  EXPECT_EQ(note(q2, 0.4999), "");
  EXPECT_EQ(note(p1, 0.4999), "") << "these lock, which another note says";
}

TEST(BendingNote, TellsByWhatFactorLongCellsOfOrderOneAreTooStiff)
{
  const auto note = [](const mesh::Element &element, const double thickness, const double nu) {
    const mesh::BoxOptions box{{0, 0}, {8, thickness}, {4, 2}, element};
    return fem::bending_note(body(box, world()), fem::Material{1, nu});
  };
  const mesh::Element q1{2, 1}, p1{2, 1, mesh::Shape::simplex};
  EXPECT_EQ(note(q1, 4, 0), "");
  // (1 - nu)/2 (h/t)^2 = 0.5 * 16: cells of length 2 in a body of thickness 0.5
  EXPECT_NE(note(q1, 0.5, 0).find("Q1 cells 4 times as long"), std::string::npos);
  EXPECT_NE(note(q1, 0.5, 0).find("make it up to 9 times too stiff"), std::string::npos);
  EXPECT_NE(note(q1, 0.5, 0).find("at most 0.32 times"), std::string::npos);
  EXPECT_NE(note(p1, 0.5, 0).find("more than 9 times"), std::string::npos);
  EXPECT_EQ(note({2, 2}, 0.5, 0), "");
}

TEST(OrderNote, TellsOfP2WhereItsDilatationIsProjected)
{
  const auto note = [](const mesh::Element &element, const double nu,
                       const fem::Dilatation dilatation = fem::Dilatation::automatic) {
    fem::Material material{1, nu};
    material.dilatation = dilatation;
    return fem::order_note(body(small_box(element), world()), material);
  };
  const mesh::Element p1{2, 1, mesh::Shape::simplex}, p2{2, 2, mesh::Shape::simplex}, q2{2, 2};
  EXPECT_EQ(note(p2, 0.48), "");
  EXPECT_NE(note(p2, 0.49).find("\"body\" with nu = 0.49"), std::string::npos);
  EXPECT_NE(note(p2, 0.49).find("take Q2"), std::string::npos);
  EXPECT_NE(note(p2, 0.3, fem::Dilatation::projected), "");
  EXPECT_EQ(note(p2, 0.49, fem::Dilatation::full), "");
  EXPECT_EQ(note(p1, 0.49), "");
  EXPECT_EQ(note(q2, 0.49), "");
}

} // namespace
} // namespace dilatation_test
