#include "rpc/fem/elasticity.hpp"

#include "bodies.hpp"
#include "rpc/core/parameters.hpp"

#include <limits>

namespace
{

using namespace rpc;
using namespace rpc::test;
using Teuchos::ParameterList;

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

TEST(Stiffness, IsSymmetric)
{
  for (const auto &element : elements()) {
    const auto d = bulged_body(element, alone());
    EXPECT_LT(asymmetry(dense(*fem::assemble_stiffness(d, steel))), 1e-14) << text_of(element);
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
      EXPECT_LT(force.normInf(), 1e-13 * steel.youngs_modulus) << "mode " << mode;
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
        largest = std::max(largest, std::abs(forces[d.dim() * node + c]));
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
    EXPECT_NEAR(u->dot(force), energy, 1e-13 * energy) << text_of(element);
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

TEST(Stiffness, ElementWithoutKernelsIsRefused)
{
  const auto d = body({{0, 0, 0}, {1, 1, 1}, {1, 1, 3}, {3, 2}}, world());
  expect_error(ExitCode::bad_input, {"Q2 in 3D"}, [&] { fem::assemble_stiffness(d, steel); });
}

/// int of x_i^p over the box along direction i.
double moment(const mesh::BoxOptions &box, const int i, const int p)
{
  return (std::pow(box.upper[i], p + 1) - std::pow(box.lower[i], p + 1)) / (p + 1);
}

TEST(BodyForce, ResultantIsTheIntegral)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    Vector load(d.owned_dofs);
    const fem::VectorField force{field([](const Point &x) { return x[0] * x[0] * x[1] * x[1]; }), ScalarField(-9.81),
                                 field([](const Point &x) { return x[2] * x[0]; })};
    fem::add_body_force(d, force, "Body Force", load);
    const double depth = element.dim == 3 ? moment(box, 2, 0) : 1;
    const Point sum = resultant(d, load);
    const Point expected{moment(box, 0, 2) * moment(box, 1, 2) * depth,
                         -9.81 * moment(box, 0, 0) * moment(box, 1, 0) * depth,
                         element.dim == 3 ? moment(box, 0, 1) * moment(box, 1, 0) * moment(box, 2, 1) : 0};
    for (int c = 0; c < d.dim(); ++c) EXPECT_NEAR(sum[c], expected[c], 1e-13 * std::abs(expected[1]));
  }
}

TEST(BodyForce, ResultantOnBulgedCellsIsForceTimesVolume)
{
  for (const auto &element : elements()) {
    const auto box = small_box(element);
    const auto d = bulged_body(element, world());
    Vector load(d.owned_dofs);
    fem::add_body_force(d, {ScalarField(1), ScalarField(2), ScalarField(0)}, "Body Force", load);
    const double depth = element.dim == 3 ? moment(box, 2, 0) : 1;
    const double volume = moment(box, 0, 0) * moment(box, 1, 0) * depth;
    const Point sum = resultant(d, load);
    EXPECT_NEAR(sum[0], volume, 1e-13 * volume) << text_of(element);
    EXPECT_NEAR(sum[1], 2 * volume, 1e-13 * volume) << text_of(element);
  }
}

TEST(Traction, ResultantAndMomentAreTheIntegrals)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    Vector load(d.owned_dofs);
    const fem::VectorField traction{field([](const Point &x) { return x[0] * x[0] * x[0] + x[1]; }), ScalarField(-20),
                                    field([](const Point &x) { return x[0] * x[2] * x[2]; })};
    fem::add_traction(d, d.mesh->side("top", "test"), traction, "Traction->top", load);
    const double depth = element.dim == 3 ? moment(box, 2, 0) : 1, scale = 20 * moment(box, 0, 0);
    const Point sum = resultant(d, load);
    EXPECT_NEAR(sum[0], (moment(box, 0, 3) + box.upper[1] * moment(box, 0, 0)) * depth, 1e-13 * scale);
    EXPECT_NEAR(sum[1], -20 * moment(box, 0, 0) * depth, 1e-13 * scale);
    if (element.dim == 3) {
      EXPECT_NEAR(sum[2], moment(box, 0, 1) * moment(box, 2, 2), 1e-13 * scale);
    }
    const auto lever = interpolate(d, [](const Point &x) { return Point{0, x[0], 0}; });
    EXPECT_NEAR(lever->dot(load), -20 * moment(box, 0, 1) * depth, 1e-13 * scale);
  }
}

TEST(Traction, LoadsOnlyTheNodesOfItsSide)
{
  const mesh::BoxOptions box = small_box({2, 1});
  const auto d = body(box, world());
  Vector load(d.owned_dofs);
  fem::add_traction(d, d.mesh->side("right", "test"), {ScalarField(3), ScalarField(0), ScalarField(0)}, "T", load);
  const auto loads = by_node_id(d, load);
  const double h = (box.upper[1] - box.lower[1]) / box.cells[1];
  for (int y = 0; y <= box.cells[1]; ++y) {
    for (int x = 0; x <= box.cells[0]; ++x) {
      const double share = x < box.cells[0] ? 0 : y == 0 || y == box.cells[1] ? 0.5 : 1;
      EXPECT_NEAR(loads[2 * (x + (box.cells[0] + 1) * y)], 3 * h * share, 1e-14);
      EXPECT_EQ(loads[2 * (x + (box.cells[0] + 1) * y) + 1], 0);
    }
  }
}

TEST(Loads, AddUpAndAreTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    const fem::VectorField f{field([](const Point &x) { return wild(x)[0]; }),
                             field([](const Point &x) { return wild(x)[1]; }),
                             field([](const Point &x) { return wild(x)[2]; })};
    const auto loads = [&](const RCP<const Comm> &comm) {
      const auto d = bulged_body(element, comm);
      Vector load(d.owned_dofs), traction(d.owned_dofs), volume(d.owned_dofs);
      fem::add_body_force(d, f, "B", load);
      fem::add_traction(d, d.mesh->side("top", "test"), f, "T", load);
      fem::add_body_force(d, f, "B", volume);
      fem::add_traction(d, d.mesh->side("top", "test"), f, "T", traction);
      const double scale = load.normInf();
      load.update(-1., volume, -1., traction, 1.);
      EXPECT_LT(load.normInf(), 1e-14 * scale) << text_of(element);
      volume.update(1., traction, 1.);
      return by_node_id(d, volume);
    };
    EXPECT_LT(difference(loads(world()), loads(alone())), 1e-13) << text_of(element);
  }
}

TEST(Loads, NanNamesTheParameterOnEveryRank)
{
  const auto d = body(small_box({2, 1}), world());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Vector load(d.owned_dofs);
  const fem::VectorField bad{ScalarField(0), field([&](const Point &x) { return x[0] > 1 ? nan : 1; }, "1/0"),
                             ScalarField(0)};
  expect_error(ExitCode::bad_input, {"\"Body Force->Y\"", "\"1/0\"", "nan at"},
               [&] { fem::add_body_force(d, bad, "Body Force", load); });
  expect_error(ExitCode::bad_input, {"\"Traction->a->Y\"", "nan at"},
               [&] { fem::add_traction(d, d.mesh->side("right", "test"), bad, "Traction->a", load); });
}

TEST(MaterialOptions, LameConstantsFollowFromYoungAndPoisson)
{
  ParameterList list = fem::valid_material_parameters();
  list.set("Young's Modulus", 5.).set("Poisson's Ratio", 0.25);
  const auto material = fem::material_options(list);
  EXPECT_NEAR(material.lambda(), 2, 1e-15 * 4);
  EXPECT_NEAR(material.mu(), 2, 1e-15 * 4);
}

TEST(MaterialOptions, ValuesOutOfRangeAreRefused)
{
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const char *name, const double value) {
    ParameterList list = fem::valid_material_parameters();
    list.set(name, value);
    expect_error(ExitCode::bad_input, {name}, [&] { fem::material_options(list); });
  };
  for (const double e : {0., -1., inf, nan}) refused("Young's Modulus", e);
  for (const double nu : {-1., 0.5, 0.7, nan, -inf}) refused("Poisson's Ratio", nu);
}

/// A deck's sublist with its defaults.
ParameterList completed(ParameterList list, const ParameterList &valid)
{
  validate(list, valid);
  return list;
}

TEST(TractionOptions, SideIsTheNameUnlessGiven)
{
  ParameterList list;
  list.sublist("top").set("Y", -2.5);
  list.sublist("push").set("Side", "left").set("X", "4");
  const auto loads = fem::traction_options(completed(list, fem::valid_traction_parameters()), 2, parse_constant);
  ASSERT_EQ(loads.size(), 2u);
  EXPECT_EQ(loads[0].side, "top");
  EXPECT_EQ(loads[0].traction[1].constant, -2.5);
  EXPECT_TRUE(loads[0].traction[0].is_zero());
  EXPECT_EQ(loads[1].name, "push");
  EXPECT_EQ(loads[1].side, "left");
  EXPECT_EQ(loads[1].traction[0].constant, 4);
}

TEST(LoadOptions, ThirdComponentIn2dIsRefusedByName)
{
  ParameterList traction, volume;
  traction.sublist("top").set("Z", 1);
  volume.set("Z", 1);
  const auto tractions = completed(traction, fem::valid_traction_parameters());
  const auto volumes = completed(volume, fem::valid_body_force_parameters());
  expect_error(ExitCode::bad_input, {"\"Traction->top->Z\"", "2D"},
               [&] { fem::traction_options(tractions, 2, parse_constant); });
  expect_error(ExitCode::bad_input, {"\"Body Force->Z\"", "2D"},
               [&] { fem::body_force_options(volumes, 2, parse_constant); });
  EXPECT_EQ(fem::traction_options(tractions, 3, parse_constant)[0].traction[2].constant, 1);
  EXPECT_EQ(fem::body_force_options(volumes, 3, parse_constant)[2].constant, 1);
}

} // namespace
