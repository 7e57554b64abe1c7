// SPDX-License-Identifier: BSD-3-Clause
#include "facet_polynomials.hpp"
#include "rpc/mesh/box.hpp"
#include "space_cells.hpp"
#include "space_descent.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <random>
#include <vector>

// Tractions on tetrahedra of random shapes: what is made of them is in balance, by integrals over facets that the code under test does not use.

namespace space_balance_test
{
namespace
{

using namespace rpc;
using namespace rpc::bound;

class Body : public ::testing::TestWithParam<int>
{
protected:
  fem::Discretization d;
  SpaceInput in;
  BoundaryTractions boundary;
  std::mt19937 random{7};
  int order = 1, functions = 3;

  double draw() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Tractions drawn()
  {
    const Tractions t("t", static_cast<std::size_t>(in.facets.size()) * functions * 3);
    for (std::size_t i = 0; i < t.extent(0); ++i) t(i) = draw();
    return t;
  }
  void SetUp() override
  {
    order = GetParam();
    functions = FacetPolynomials::count(3, order);
    take({3, 2, 2}, 1);
  }
  /// @param distorted  by how much inner vertices move: 0 or 1, and only with elements of order 1
  void take(const std::vector<int> &cells, const double distorted)
  {
    mesh::Element element;
    element.dim = 3;
    element.order = order;
    element.shape = mesh::Shape::simplex;
    mesh::BoxOptions box;
    box.lower = {0, 0, 0};
    box.upper = {2, 1, 1};
    box.cells = cells;
    box.element = element;
    const auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
    const auto x = mesh->coords;
    for (LO n = 0; n < mesh->num_local_nodes(); ++n) { // the sides stay in their planes
      const double move = 0.1 * x(n, 0) * (2 - x(n, 0)) * x(n, 1) * (1 - x(n, 1)) * x(n, 2) * (1 - x(n, 2));
      if (order == 1)
        for (int i = 0; i < 3; ++i) x(n, i) += 10 * distorted * move * draw();
    }
    mesh->box = nullptr;
    d = fem::discretize(mesh);
    in.coords = mesh->coords;
    in.block = mesh->block;
    in.lame = DeviceView<double **>("lame", 1, 2);
    in.lame(0, 0) = 3;
    in.lame(0, 1) = 2;
    in.facets = space_facets_of(d);
    in.cells = in.facets.nodes_of_cell;
    in.reference = reference_stress(element);
    in.tables = facet_tables(order);
    in.stress = d.reference.cell;
    in.load = d.reference.cell_load;
    find_kinds(in, mesh->comm());
    in.num_owned_cells = mesh->num_owned_cells;
    boundary.known = DeviceView<char **>("known", in.facets.size(), 3);
    boundary.load = DeviceView<double ***>("load", in.facets.size(), FacetPolynomials::count(3, 3), 3);
    for (LO f = 0; f < in.facets.size(); ++f) { // clamped at x = 0, rollers at y = 0, held along z = 0
      const auto all_at_0 = [&](const int i) {
        return in.coords(in.facets.node(f, 0), i) + in.coords(in.facets.node(f, 1), i) +
                   in.coords(in.facets.node(f, 2), i) ==
               0;
      };
      for (int i = 0; i < 3; ++i)
        boundary.known(f, i) =
            in.facets.on_boundary(f) && !all_at_0(0) && !(all_at_0(1) && i == 1) && !(all_at_0(2) && i != 2);
    }
  }

  /// Force and moment about 0 of the traction on a facet.
  std::array<double, 6> wrench(const Tractions &t, const LO f) const
  {
    const FacetRule rule = facet_rule(3, order + 2);
    const FacetPolynomials polynomials(3, order);
    std::array<double, 6> sum{};
    for (int q = 0; q < rule.size(); ++q) {
      double x[3] = {}, at[3] = {};
      for (int v = 0; v < 3; ++v)
        for (int i = 0; i < 3; ++i) x[i] += rule.point[q][v] * in.coords(in.facets.node(f, v), i);
      for (int j = 0; j < functions; ++j)
        for (int i = 0; i < 3; ++i) at[i] += polynomials(j, rule.point[q]) * t((f * functions + j) * 3 + i);
      for (int i = 0; i < 3; ++i) {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        sum[i] += rule.weight[q] * at[i];
        sum[3 + i] += rule.weight[q] * (x[a] * at[b] - x[b] * at[a]);
      }
    }
    return sum;
  }
  /// The moment of a facet with the function of its node a.
  double moment(const Tractions &t, const LO f, const int a, const int i) const
  {
    double sum = 0;
    for (int j = 0; j < functions; ++j) sum += in.tables.moment(j, a) * t((f * functions + j) * 3 + i);
    return sum;
  }
};

INSTANTIATE_TEST_SUITE_P(Orders, Body, ::testing::Values(1, 2));

TEST_P(Body, RingsAnswerWithTractionsInBalanceThatLeaveWhatIsKnown)
{
  const Vector u(d.owned_dofs);
  const SpaceForms forms = cell_forms(in, u);
  const SpaceExchanges exchanges(*d.mesh, in.facets.node);
  const RingSolves rings(in, boundary, forms, exchanges);
  const Tractions g = drawn(), z("z", g.extent(0));
  rings.apply(g, z);
  double size = 0, along = 0;
  for (std::size_t k = 0; k < z.extent(0); ++k) {
    size = std::max(size, std::abs(z(k)));
    along += g(k) * z(k);
  }
  EXPECT_GT(size, 1e-3);
  EXPECT_GT(along, 0);
  for (LO c = 0; c < in.num_cells(); ++c) {
    std::array<double, 6> sum{};
    for (int s = 0; s < 4; ++s) {
      const auto of_facet = wrench(z, in.facets.of_cell(c, s));
      for (int i = 0; i < 6; ++i) sum[i] += in.facets.sign(c, s) * of_facet[i];
    }
    for (const double x : sum) EXPECT_NEAR(x, 0, 1e-12 * size) << "cell " << c;
  }
  double free[4] = {}; // largest on the clamped side, the rollers, the side held along, inside
  for (LO f = 0; f < in.facets.size(); ++f)
    for (int j = 0; j < functions; ++j)
      for (int i = 0; i < 3; ++i) {
        const double value = z((f * functions + j) * 3 + i);
        if (in.facets.on_boundary(f) && boundary.known(f, i))
          EXPECT_EQ(value, 0);
        else if (!in.facets.on_boundary(f))
          free[3] = std::max(free[3], std::abs(value));
        else if (!boundary.known(f, 0) && !boundary.known(f, 1) && !boundary.known(f, 2))
          free[0] = std::max(free[0], std::abs(value));
        else
          free[i == 1 ? 1 : 2] = std::max(free[i == 1 ? 1 : 2], std::abs(value));
      }
  for (const double largest : free) EXPECT_GT(largest, 1e-3 * size);
}

TEST_P(Body, RingsAreSymmetricAndAnswerWithTheInverseOfTheirEnergies)
{
  const Vector u(d.owned_dofs);
  const SpaceForms forms = cell_forms(in, u);
  const SpaceExchanges exchanges(*d.mesh, in.facets.node);
  const RingSolves rings(in, boundary, forms, exchanges);
  const Tractions g = drawn(), h = drawn(), z("z", g.extent(0)), y("y", g.extent(0));
  const DeviceView<float *> Az("Az", g.extent(0));
  rings.apply(g, z);
  rings.apply(h, y);
  double gy = 0, hz = 0, gz = 0;
  const double zAz = derivative(in, forms, z, false, Az);
  for (std::size_t k = 0; k < z.extent(0); ++k) {
    gy += g(k) * y(k);
    hz += h(k) * z(k);
    gz += g(k) * z(k);
  }
  EXPECT_NEAR(gy, hz, 1e-6 * (std::abs(gy) + gz)); // the preconditioner is symmetric, but for single precision
  EXPECT_GT(zAz, 0);
  EXPECT_LT(zAz, 6.001 * gz); // each ring's own energy is its work with g, and a cell lies in six rings
  EXPECT_GT(zAz, 0.1 * gz);
}

TEST_P(Body, EquilibratedTractionsHaveTheMomentsThatCellsAskFor)
{
  // Cells ask for the moments of random tractions; only those that are known, and the sums, are told.
  const Tractions hidden = drawn();
  DeviceView<double ***> Q("Q", in.num_cells(), in.cells.extent(1), 3),
      used("used", in.num_cells(), in.cells.extent(1), 3);
  const Tractions mean("mean", hidden.extent(0));
  for (LO f = 0; f < in.facets.size(); ++f)
    for (int j = 0; j < functions; ++j)
      for (int i = 0; i < 3; ++i) {
        mean((f * functions + j) * 3 + i) = draw();
        if (in.facets.on_boundary(f) && boundary.known(f, i))
          boundary.load(f, j, i) = hidden((f * functions + j) * 3 + i);
      }
  const auto each_moment = [&](const auto &visit) {
    for (LO c = 0; c < in.num_cells(); ++c)
      for (int s = 0; s < 4; ++s)
        for (int a = 0; a < functions; ++a)
          for (int n = 0; n < static_cast<int>(in.cells.extent(1)); ++n)
            if (in.cells(c, n) == in.facets.node(in.facets.of_cell(c, s), a)) visit(c, s, a, n);
  };
  each_moment([&](const LO c, const int s, const int a, const int n) {
    for (int i = 0; i < 3; ++i) Q(c, n, i) += in.facets.sign(c, s) * moment(hidden, in.facets.of_cell(c, s), a, i);
  });
  Kokkos::deep_copy(used, Q);
  const Tractions t = equilibrated(in, boundary, used, mean, d.node_to_cells, SpaceExchanges(*d.mesh, in.facets.node));
  each_moment([&](const LO c, const int s, const int a, const int n) {
    for (int i = 0; i < 3; ++i) Q(c, n, i) -= in.facets.sign(c, s) * moment(t, in.facets.of_cell(c, s), a, i);
  });
  double off = 0, changed = 0;
  for (LO c = 0; c < in.num_cells(); ++c)
    for (std::size_t n = 0; n < in.cells.extent(1); ++n)
      for (int i = 0; i < 3; ++i) off = std::max(off, std::abs(Q(c, n, i)));
  EXPECT_LT(off, 1e-12);
  for (LO f = 0; f < in.facets.size(); ++f)
    for (int j = 0; j < functions; ++j)
      for (int i = 0; i < 3; ++i) {
        const double here = t((f * functions + j) * 3 + i), there = hidden((f * functions + j) * 3 + i);
        if (in.facets.on_boundary(f) && boundary.known(f, i))
          EXPECT_EQ(here, there);
        else
          changed = std::max(changed, std::abs(here - there));
      }
  EXPECT_GT(changed, 0.1);
}

TEST_P(Body, TheEnergyOfTractionsIsThatOfTheirStress)
{
  // Along a line of tractions in balance the energy that is integrated is the quadratic function of A and b.
  Vector u(d.owned_dofs);
  u.randomize();
  in.force[0] = 0.3;
  in.force[2] = -0.7;
  const SpaceForms forms = cell_forms(in, u);
  const SpaceExchanges exchanges(*d.mesh, in.facets.node);
  const RingSolves rings(in, boundary, forms, exchanges);
  const DeviceView<double *> of_cell("of_cell", in.num_cells());
  const Tractions g = drawn(), z("z", g.extent(0)), at("at", g.extent(0));
  const DeviceView<float *> slope("slope", g.extent(0));
  rings.apply(g, z);
  // In balance with the body force: tractions of diag(-f_i x_i), whose moments about the centre vanish on each cell, are continuous.
  for (LO f = 0; f < in.facets.size(); ++f) {
    double n[3];
    const auto x = [&](const int v, const int i) { return in.coords(in.facets.node(f, v), i); };
    double outward = 0;
    const LO c = in.facets.cell(f, 0);
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      n[i] = ((x(1, a) - x(0, a)) * (x(2, b) - x(0, b)) - (x(1, b) - x(0, b)) * (x(2, a) - x(0, a))) / 2;
      outward += n[i] * (x(0, i) - in.coords(in.cells(c, in.facets.ordinal(f, 0)), i));
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int v = 0; v < 3; ++v)
          at((f * functions + j) * 3 + i) -=
              in.tables.linear(j, v) * in.force[i] * x(v, i) * (outward > 0 ? n[i] : -n[i]);
  }
  double energy[3];
  for (int k = 0; k < 3; ++k) {
    const StressDifference left = stress_difference(in, d.mesh->comm(), forms, at, u, of_cell);
    energy[k] = left.energy;
    EXPECT_LT(left.imbalance, 1e-12 * left.force);
    if (k == 1) derivative(in, forms, at, true, slope);
    for (std::size_t i = 0; i < at.extent(0); ++i) at(i) += z(i);
  }
  double along = 0;
  for (std::size_t i = 0; i < at.extent(0); ++i) along += slope(i) * z(i);
  EXPECT_NEAR((energy[2] - energy[0]) / 2, along, 1e-6 * (std::abs(along) + energy[1])); // A is in single precision

  // A descent lowers it by what it says, and cells stay in balance.
  SpaceDescent descent(in, forms, rings, d.mesh->comm(), at);
  double before = stress_difference(in, d.mesh->comm(), forms, at, u, of_cell).energy;
  for (int step = 0; step < 4; ++step) {
    const double fall = descent.step();
    const StressDifference left = stress_difference(in, d.mesh->comm(), forms, at, u, of_cell);
    EXPECT_GT(fall, 0);
    EXPECT_NEAR(before - left.energy, fall, 1e-5 * (fall + 1e-2 * before)) << step;
    EXPECT_LT(left.imbalance, 1e-12 * left.force);
    before = left.energy;
  }
}

TEST_P(Body, EnergiesByKindsOfCellsAreThoseOfTheirStresses)
{
  EXPECT_EQ(cell_forms(in, Vector(d.owned_dofs)).exact.extent(0), 0U); // no cell is like another one
  take({6, 4, 4}, 0);
  Vector u(d.owned_dofs);
  u.randomize();
  SpaceForms forms = cell_forms(in, u);
  if (order == 2) {
    EXPECT_EQ(forms.exact.extent(0), 0U);
    return;
  }
  ASSERT_GT(forms.exact.extent(0), 0U);
  const Tractions t = drawn();
  const DeviceView<double *> by_kinds("by_kinds", in.num_cells()), integrated("integrated", in.num_cells());
  const StressDifference a = stress_difference(in, d.mesh->comm(), forms, t, u, by_kinds);
  forms.exact = {};
  const StressDifference b = stress_difference(in, d.mesh->comm(), forms, t, u, integrated);
  EXPECT_NEAR(a.energy, b.energy, 1e-13 * b.energy);
  EXPECT_NEAR(a.force, b.force, 1e-13 * b.force);
  EXPECT_NEAR(a.imbalance, b.imbalance, 1e-12 * b.imbalance);
  const double mean = b.energy / in.num_cells();
  for (LO c = 0; c < in.num_cells(); ++c) EXPECT_NEAR(by_kinds(c), integrated(c), 1e-12 * mean) << "cell " << c;
  // Neither with a body force, which is no stress of the kind, nor in parts of hexahedra, whose C eps(u) is not constant.
  in.of_hexahedra = true;
  EXPECT_EQ(cell_forms(in, u).exact.extent(0), 0U);
  in.of_hexahedra = false;
  in.force[1] = 1;
  EXPECT_EQ(cell_forms(in, u).exact.extent(0), 0U);
}

} // namespace
} // namespace space_balance_test
