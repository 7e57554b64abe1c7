// SPDX-License-Identifier: BSD-3-Clause
#include "beside_inverse.hpp"
#include "revolution_cells.hpp"
#include "revolution_energy.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

// What bounds of bodies of revolution are made of, doc/bounds.md (13.10a) - (13.10d).

namespace revolution_test
{
namespace
{

using namespace rpc;
using namespace rpc::bound;

TEST(BesideInverse, StaysOnItsSideOfOneOverRAndIsAPolynomial)
{
  for (const double b : {1.1, 2., 10.}) {
    const double a = 1;
    double above_worst = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double x = a + (b - a) * i / 1000;
      EXPECT_GE(beside_inverse(x, a, b, true), (1 - 1e-15) / x);
      EXPECT_LE(beside_inverse(x, a, b, false), (1 + 1e-15) / x);
      above_worst = std::max(above_worst, x * beside_inverse(x, a, b, true) - 1);
    }
    EXPECT_LT(above_worst, b > 3 ? 0.2 : 1e-5);
    // Degree 7: the differences of order 8 vanish.
    for (const bool above : {true, false}) {
      double difference = 0, binomial = 1;
      for (int i = 0; i <= 8; ++i) {
        difference += (i % 2 == 0 ? 1 : -1) * binomial * beside_inverse(a + (b - a) * i / 8, a, b, above);
        binomial *= (8. - i) / (i + 1);
      }
      EXPECT_NEAR(difference, 0, 1e-12);
    }
  }
}

TEST(RevolutionTables, HaveTheStressesOfAnyDivergenceAndIntegratePolynomials)
{
  const struct {
    int order;
    mesh::Shape shape;
    int columns, inner;
  } elements[] = {{1, mesh::Shape::simplex, 15, 3},
                  {2, mesh::Shape::simplex, 36, 18},
                  {1, mesh::Shape::tensor, 21, 5},
                  {2, mesh::Shape::tensor, 49, 25}};
  for (const auto &of : elements) {
    mesh::Element element;
    element.dim = 2;
    element.order = of.order;
    element.shape = of.shape;
    SCOPED_TRACE(element.name());
    const RevolutionTables t = revolution_tables(element);
    EXPECT_EQ(t.columns, of.columns);
    EXPECT_EQ(t.inner, of.inner);
    const auto weight = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), t.weight);
    const auto place = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), t.place);
    const bool simplex = of.shape == mesh::Shape::simplex;
    const double area = simplex ? 0.5 : 4, square = simplex ? 1. / 36 : 4. / 3; // int 1, int x^2
    for (int e = 0; e < RevolutionTables::arrangements; ++e) {
      double sum = 0, of_square = 0;
      for (std::size_t s = 0; s < weight.extent(1); ++s)
        for (int q = 0; q < t.points; ++q) {
          sum += weight(e, s, q);
          of_square += weight(e, s, q) * std::pow(place(e, s, q, 0), 2);
        }
      EXPECT_NEAR(sum, area, 1e-14);
      EXPECT_NEAR(of_square, square, 1e-13);
    }
  }
}

/// Few cells of the section between two radii and z = 0, 1, which differ much from 1/r's polynomials.
struct Section {
  fem::Discretization d;
  CellInput in;
  RCP<Vector> u;

  template <class Displacement>
  Section(const mesh::Element &element, const double inner, const double outer, const Displacement &displacement)
  {
    mesh::BoxOptions box;
    box.lower = {inner, 0};
    box.upper = {outer, 1};
    box.cells = {1, 2};
    box.element = element;
    const auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
    d = fem::discretize(mesh);
    in.coords = mesh->coords;
    in.cells = mesh->cells;
    in.block = mesh->block;
    in.lame = DeviceView<double **>("lame", 1, 2);
    in.lame(0, 0) = 3;
    in.lame(0, 1) = 2;
    in.num_owned_cells = mesh->num_owned_cells;
    in.facets = facets_of(d);
    in.reference = reference_stress(element);
    in.revolution = revolution_tables(element);
    in.on_axis = 1e-12;
    u = rcp(new Vector(d.owned_dofs));
    const auto to = device_write(*u);
    for (LO n = 0; n < mesh->num_local_nodes(); ++n)
      for (int i = 0; i < 2; ++i) to(dof(2, n, i)) = displacement(in.coords(n, 0), in.coords(n, 1))[i];
  }
};

template <class Check>
void for_all_elements(const Check &check)
{
  for (const mesh::Shape shape : {mesh::Shape::simplex, mesh::Shape::tensor})
    for (const int order : {1, 2}) {
      mesh::Element element;
      element.dim = 2;
      element.order = order;
      element.shape = shape;
      SCOPED_TRACE(element.name());
      check(element);
    }
}

TEST(RevolutionEnergy, OfADisplacementLiesBetweenItsBounds)
{
  // u_r = 0.3 r + z/5 + 0.1, u_z = r/2 - 0.4 z; at the axis u_r = 0.3 r.
  for_all_elements([](const mesh::Element &element) {
    for (const bool hole : {true, false}) {
      SCOPED_TRACE(hole);
      const double inner = hole ? 0.2 : 0, b = hole ? 0.2 : 0, constant = hole ? 0.1 : 0;
      const Section s(element, inner, 1, [&](const double r, const double z) {
        return std::array<double, 2>{0.3 * r + b * z + constant, 0.5 * r - 0.4 * z};
      });
      double exact = 0;
      constexpr int n = 1000;
      for (int i = 0; i < n; ++i)
        for (const double z : {0.5 - std::sqrt(1. / 12), 0.5 + std::sqrt(1. / 12)}) {
          const double r = inner + (1 - inner) * (i + 0.5) / n, hoop = (0.3 * r + b * z + constant) / r,
                       shear = (b + 0.5) / 2, trace = 0.3 - 0.4 + hoop;
          exact += (3 * trace * trace + 2 * 2 * (0.3 * 0.3 + 0.4 * 0.4 + hoop * hoop + 2 * shear * shear)) * 2 *
                   Circle::pi * r * (1 - inner) / n / 2;
        }
      const Squared found = squared_of_revolution(s.in, s.d.mesh->comm(), *s.u);
      EXPECT_LT(found.lower, exact * (1 + 1e-6));
      EXPECT_GT(found.upper, exact * (1 - 1e-6));
      if (hole) {
        EXPECT_GT(found.upper - found.lower, 1e-5 * exact);
        EXPECT_LT(found.upper - found.lower, 0.1 * exact);
      }
    }
  });
}

TEST(RevolutionEnergy, OfADifferenceIsNoSmallerAndItsStressVanishesOnTheAxis)
{
  for_all_elements([](const mesh::Element &element) {
    const Section s(element, 0, 1, [](const double r, const double z) {
      return std::array<double, 2>{r * (0.3 + z + r), 0.5 * r * z - 0.4 * z * z};
    });
    const Tractions none("none", static_cast<std::size_t>(s.in.facets.size()) * 2 * (element.order + 1));
    const DeviceView<double *> of_cell("of_cell", s.in.num_owned_cells);
    const StressDifference found = difference_of_revolution(s.in, s.d.mesh->comm(), none, *s.u, of_cell);
    EXPECT_LT(found.imbalance, 1e-10);
    const auto x = device_read(*s.u);
    double above = 0, below = 0;
    for (LO c = 0; c < s.in.num_owned_cells; ++c) {
      RevolutionEnergy e(s.in, x, c);
      double all[RevolutionTables::most_columns] = {}, mu[RevolutionTables::most_conditions];
      e.factor();
      e.solve(all, true, all + s.in.reference.tractions, mu);
      const double nothing[RevolutionTables::most_columns] = {};
      EXPECT_NEAR(e.energy_of(x, nothing, true), e.energy_of(x, nullptr, true), 1e-12 * e.energy_of(x, nullptr, true));
      above += e.energy_of(x, all, true) / 2;
      below += e.energy_of(x, all, false) / 2;
      for (int side = 0; side < s.in.reference.sides; ++side) {
        const LO a = s.in.cells(c, side), b = s.in.cells(c, (side + 1) % s.in.reference.sides);
        if (s.in.coords(a, 0) > 0 || s.in.coords(b, 0) > 0) continue;
        for (int i = 0; i < 3; ++i) {
          double in_middle = 0;
          for (int k = 0; k < 3; ++k)
            for (int j = 0; j < e.columns; ++j) in_middle += e.T[i][k] * s.in.revolution.at_middle(side, k, j) * all[j];
          EXPECT_NEAR(in_middle, 0, 1e-10);
        }
      }
    }
    EXPECT_NEAR(found.energy, above, 1e-12 * above);
    EXPECT_GT(found.energy, below * (1 + 1e-9));
  });
}

TEST(RevolutionEnergy, OfALiftIsThatOnTheSmallestCircleOfTheCell)
{
  for_all_elements([](const mesh::Element &element) {
    const auto rest = [](const double, const double) { return std::array<double, 2>{}; };
    double times_circle = 0;
    for (const double inner : {0.5, 3.}) {
      const Section s(element, inner, inner + 1, rest);
      const DeviceView<double ***> load("load", s.in.facets.size(), ReferenceStress::degree_of_loads + 1, 2);
      for (LO f = 0; f < s.in.facets.size(); ++f) // on one facet at the largest radius
        if (s.in.coords(s.in.facets.node(f, 0), 0) == inner + 1 &&
            s.in.coords(s.in.facets.node(f, 1), 0) == inner + 1 &&
            s.in.coords(s.in.facets.node(f, 0), 1) * s.in.coords(s.in.facets.node(f, 1), 1) == 0)
          load(f, element.order + 1, 0) = load(f, element.order + 1, 1) = 1;
      const double norm = norm_of_lifted_loads(s.in, s.d.mesh->comm(), lifted_loads(element), load);
      LO cell = 0;
      double least = inner + 1;
      for (LO f = 0; f < s.in.facets.size(); ++f)
        if (load(f, element.order + 1, 0) != 0) cell = s.in.facets.cell(f, 0);
      for (int v = 0; v < s.in.reference.sides; ++v) least = std::min(least, s.in.coords(s.in.cells(cell, v), 0));
      EXPECT_EQ(least, inner);
      EXPECT_GT(norm, 0);
      if (times_circle > 0) EXPECT_NEAR(norm * norm * least, times_circle, 1e-10 * times_circle);
      times_circle = norm * norm * least;
    }
  });
}

} // namespace
} // namespace revolution_test
