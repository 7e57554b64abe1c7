// SPDX-License-Identifier: BSD-3-Clause
#include "energy_of_difference.hpp"
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

// input/manufactured.xml against its exact solution (doc/theory.md, section 7): open, closed and yielded parts.

namespace manufactured_test
{
namespace
{

using namespace rpc;

double cube(const double x)
{
  return x > 0 ? x * x * x : 0;
}
double square(const double x)
{
  return x > 0 ? x * x : 0;
}
double exact_pressure(const double x)
{
  return 0.05 * cube(x - 1);
}
/// grad[i][j] = du_i / dx_j
void exact_gradient(const Point &at, double (&grad)[3][3])
{
  const double x = at[0], y = at[1];
  grad[0][0] = 0.1 * y * std::sin(x);
  grad[0][1] = -0.1 * std::cos(x);
  grad[1][0] = 0.1 * std::cos(x) - y * 0.15 * square(x - 1) / 3.5;
  grad[1][1] = -0.05 * cube(x - 1) / 3.5;
}

struct Errors {
  double energy;   // norm of the displacement error, relative
  double pressure; // L2 over the contact side, relative
};

/// (|p_h - p|^2, |p|^2) over the contact side, of the nodal pressures interpolated by the facets' shape functions; Gauss
/// points of this rank's facets.
std::array<double, 2> pressure_errors(const Solution &s)
{
  const fem::Discretization &d = s.discretization;
  const mesh::Mesh &mesh = *d.mesh;
  Vector owned(mesh.owned_nodes), overlap(mesh.overlap_nodes());
  {
    const auto node = to_host(s.step.contact.node);
    const auto p = to_host(s.contact.pressure);
    const auto to = owned.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < node.extent(0); ++i) to(node(i), 0) = p(i);
  }
  overlap.doImport(owned, Import(mesh.owned_nodes, mesh.overlap_nodes()), Tpetra::INSERT);
  const auto p = to_host(device_read(overlap));
  const auto coords = to_host(mesh.coords);
  const mesh::Side &side = mesh.side("bottom", "test");
  const auto facets = to_host(side.facets);
  const auto cell = to_host(side.cell);
  const auto value = to_host(d.reference.facet.value);
  const auto weight = to_host(d.reference.facet.weight);
  std::array<double, 2> sums{};
  for (std::size_t f = 0; f < facets.extent(0); ++f) {
    if (cell(f) >= mesh.num_owned_cells) continue;
    const double half = 0.5 * std::abs(coords(facets(f, 1), 0) - coords(facets(f, 0), 0)); // a straight side
    for (std::size_t q = 0; q < weight.extent(0); ++q) {
      double x = 0, pressure = 0;
      for (std::size_t a = 0; a < facets.extent(1); ++a) {
        x += value(q, a) * coords(facets(f, a), 0);
        pressure += value(q, a) * p(facets(f, a));
      }
      sums[0] += weight(q) * half * std::pow(pressure - exact_pressure(x), 2);
      sums[1] += weight(q) * half * std::pow(exact_pressure(x), 2);
    }
  }
  return sums;
}

/// (energy, its norm, pressure, its norm), squared, over all ranks.
std::array<double, 4> squared_errors(const Solution &s)
{
  constexpr fem::Material material{2.6, 0.3}; // lambda = 1.5, mu = 1
  const Vector zero(s.discretization.owned_dofs);
  const auto pressure = pressure_errors(s);
  const double mine[4] = {test::energy_of_difference(s.discretization, material, *s.u, exact_gradient),
                          test::energy_of_difference(s.discretization, material, zero, exact_gradient), pressure[0],
                          pressure[1]};
  std::array<double, 4> all;
  Teuchos::reduceAll(s.discretization.mesh->comm(), Teuchos::REDUCE_SUM, 4, mine, all.data());
  return all;
}

const std::string deck = std::string(RPC_TEST_DECKS) + "/../../../input/manufactured.xml";

Errors errors(const std::vector<std::string> &assignments)
{
  const Solution s = run_scene(deck, assignments);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  const auto all = squared_errors(s);
  return {std::sqrt(all[0] / all[1]), std::sqrt(all[2] / all[3])};
}

/// Estimated over real error in the energy norm.
double effectivity(const Solution &s)
{
  return std::sqrt(s.estimate->total() / squared_errors(s)[0]);
}

class Manufactured : public testing::TestWithParam<std::string>
{
};

TEST_P(Manufactured, ErrorsFallAtTheElementsRates)
{
  const std::string element = GetParam();
  const bool quadratic = element[1] == '2';
  std::vector<Errors> found;
  for (const int n : {8, 16, 32})
    found.push_back(
        errors({"Mesh->Element=" + element, "Mesh->Cells={" + std::to_string(3 * n) + "," + std::to_string(n) + "}"}));
  for (std::size_t k = 1; k < found.size(); ++k) {
    const double energy = std::log2(found[k - 1].energy / found[k].energy);
    const double pressure = std::log2(found[k - 1].pressure / found[k].pressure);
    EXPECT_NEAR(energy, quadratic ? 2 : 1, 0.15) << element << " error " << found[k].energy;
    EXPECT_GE(pressure, quadratic ? 1.5 : 1) << element << " error " << found[k].pressure;
    RecordProperty("energy_rate_" + std::to_string(k), std::to_string(energy));
    RecordProperty("pressure_rate_" + std::to_string(k), std::to_string(pressure));
  }
  EXPECT_LT(found.back().energy, quadratic ? 2e-3 : 5e-2);
}

TEST_P(Manufactured, EstimateIsAboutTheError)
{
  for (const int n : {8, 16, 32}) {
    const std::string cells = "Mesh->Cells={" + std::to_string(3 * n) + "," + std::to_string(n) + "}";
    const Solution s = run_scene(deck, {"Mesh->Element=" + GetParam(), cells, "Adapt->Estimate Error=true"});
    EXPECT_GT(effectivity(s), 0.7) << cells;
    EXPECT_LT(effectivity(s), 2) << cells;
  }
}

TEST_P(Manufactured, EstimateIsAboutTheErrorOnAdaptedMeshes)
{
  const bool quadratic = GetParam()[1] == '2';
  std::ostream nowhere(nullptr);
  const Scene scene = read_scene(deck, {"Mesh->Element=" + GetParam(), "Mesh->Cells={6,2}",
                                        std::string("Adapt->Target Relative Error=") + (quadratic ? "0.001" : "0.03")});
  int mesh = 0;
  const Solution last = solve(scene, Tpetra::getDefaultComm(), nowhere, [&](const Scene &, Solution &s) {
    const double found = effectivity(s);
    RecordProperty("effectivity_" + std::to_string(++mesh), std::to_string(found));
    if (mesh < 3) return;
    EXPECT_GT(found, 0.7) << "mesh " << mesh;
    EXPECT_LT(found, 2) << "mesh " << mesh;
  });
  EXPECT_GE(mesh, 3);
  EXPECT_TRUE(last.adaptation->reached) << last.adaptation->reason;
}

INSTANTIATE_TEST_SUITE_P(Elements, Manufactured, testing::Values("P1", "Q1", "P2", "Q2"),
                         [](const auto &info) { return info.param; });

TEST(ManufacturedStates, AreWhereTheyShouldBe)
{
  const Solution s = run_scene(deck, {});
  const auto node = to_host(s.step.contact.node);
  const auto coords = to_host(s.discretization.mesh->coords);
  const auto state = to_host(s.contact.state);
  const auto v = to_host(s.contact.penetration);
  for (std::size_t i = 0; i < node.extent(0); ++i) {
    const double x = coords(node(i), 0);
    if (x < 0.9) {
      EXPECT_EQ(state(i), 0) << x;
      EXPECT_NEAR(v(i), -0.1 * square(1 - x), 1e-4) << x;
    } else if (x > 1.1 && x < 1.9) {
      EXPECT_EQ(state(i), 1) << x;
      EXPECT_NEAR(v(i), 0, 1e-9) << x;
    } else if (x > 2.1) {
      EXPECT_EQ(state(i), 2) << x;
      EXPECT_NEAR(v(i), 0.1 * square(x - 2), 1e-4) << x;
    }
  }
}

} // namespace
} // namespace manufactured_test
