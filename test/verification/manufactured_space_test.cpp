// SPDX-License-Identifier: BSD-3-Clause
#include "energy_of_difference.hpp"
#include "run_scene.hpp"
#include "solved.hpp"

#include "rpc/adapt/estimators/recovered.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "rpc/fem/surface.hpp"
#include "rpc/mesh/make_mesh.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

// A contact problem in space with a known solution (doc/theory.md, (7.3)), on straight and on curved, distorted cells.

namespace manufactured_space_test
{
namespace
{

using namespace rpc;

double above(const double x)
{
  return x > 0 ? x : 0;
}
double exact_pressure(const Point &at)
{
  return 0.05 * std::pow(above(at[0] + 0.4 * at[1] - 1), 3);
}
/// grad[i][j] = du_i / dx_j
void exact_gradient(const Point &at, double (&grad)[3][3])
{
  const double s = at[0] + 0.4 * at[1], z = at[2], along[2] = {1, 0.4};
  const double slope = 0.1 * std::cos(s), bend = -0.1 * std::sin(s); // of 0.1 sin s
  const double q = 0.05 * std::pow(above(s - 1), 3) / 3.5, dq = 0.15 * std::pow(above(s - 1), 2) / 3.5;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) grad[i][j] = -z * bend * along[i] * along[j];
    grad[i][2] = -slope * along[i];
    grad[2][i] = (slope - z * dq) * along[i];
  }
  grad[2][2] = -q;
}

/// Moves nodes along the planes that bound the box, and within it: no cell is a parallelepiped, and with order 2 all are curved.
Point distorted(const Point &x)
{
  const double pi = std::acos(-1.), sx = std::sin(pi * x[0] / 3), sy = std::sin(pi * x[1]), sz = std::sin(pi * x[2]);
  return {x[0] + 0.12 * sx * std::cos(2 * x[1] + 3 * x[2]), x[1] + 0.08 * sy * std::cos(2 * x[0] - x[2]),
          x[2] + 0.07 * sz * std::cos(3 * x[0] + 2 * x[1])};
}

struct Errors {
  double energy;       // norm of the displacement error, relative
  double displacement; // L2 of the normal displacement over the contact side, relative
  double pressure;     // L2 over the contact side, relative
  double effectivity;  // of the estimate
};

const std::string deck = std::string(RPC_TEST_DECKS) + "/manufactured_space.xml";

mesh::Mesh box_mesh(const Scene &scene, const bool distorts)
{
  mesh::Mesh mesh = mesh::make_mesh(scene.mesh, Tpetra::getDefaultComm());
  if (!distorts) return mesh;
  const auto coords = Kokkos::create_mirror_view(mesh.coords);
  Kokkos::deep_copy(coords, mesh.coords);
  for (std::size_t n = 0; n < coords.extent(0); ++n) {
    const Point moved = distorted({coords(n, 0), coords(n, 1), coords(n, 2)});
    for (int c = 0; c < 3; ++c) coords(n, c) = moved[c];
  }
  Kokkos::deep_copy(mesh.coords, coords);
  mesh.box = nullptr;
  return mesh;
}

/// Values at points as a host view over all local nodes; 0 where there is no point.
template <class Values>
HostView<const double *> at_local_nodes(const mesh::Mesh &mesh, const contact::ContactNodes &c, const Values &values)
{
  Vector owned(mesh.owned_nodes), overlap(mesh.overlap_nodes());
  {
    const auto node = to_host(c.node);
    const auto from = to_host(values);
    const auto to = owned.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < node.extent(0); ++i) to(node(i), 0) = from(i);
  }
  overlap.doImport(owned, Import(mesh.owned_nodes, mesh.overlap_nodes()), Tpetra::INSERT);
  return to_host(device_read(overlap));
}

Errors errors(const std::string &element, const int n, const bool distorts)
{
  const std::string cells = std::to_string(3 * n) + "," + std::to_string(n) + "," + std::to_string(n);
  const Scene scene = read_scene(deck, {"Mesh->Element=" + element, "Mesh->Cells={" + cells + "}"});
  const auto mesh = std::make_shared<mesh::Mesh>(box_mesh(scene, distorts));
  const analysis::Problem problem(mesh, scene.model);
  const analysis::Step step = problem.step(1);
  const auto s = test::solved(problem, step, scene.step, scene.linear_solver);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;

  const fem::Discretization &d = problem.discretization();
  constexpr fem::Material material{2.6, 0.3}; // lambda = 1.5, mu = 1
  const mesh::Side &side = mesh->side("back", "test");
  const auto p = at_local_nodes(*mesh, step.contact, s.contact.pressure);
  const auto u_nu = at_local_nodes(*mesh, step.contact, s.contact.normal_displacement);
  const auto coords = to_host(mesh->coords);
  const auto facets = to_host(side.facets);
  const auto cell = to_host(side.cell);
  const auto value = to_host(d.reference.facet.value);
  const auto measure = to_host(fem::facet_measure(d, side));
  std::array<double, 6> mine{test::energy_of_difference(d, material, *s.u, exact_gradient),
                             test::energy_of_difference(d, material, Vector(d.owned_dofs), exact_gradient)};
  const std::size_t points = value.extent(0);
  for (std::size_t f = 0; f < facets.extent(0); ++f) {
    if (cell(f) >= mesh->num_owned_cells) continue;
    for (std::size_t q = 0; q < points; ++q) {
      Point x{};
      double pressure = 0, normal_displacement = 0;
      for (std::size_t a = 0; a < facets.extent(1); ++a) {
        for (int c = 0; c < 3; ++c) x[c] += value(q, a) * coords(facets(f, a), c);
        pressure += value(q, a) * p(facets(f, a));
        normal_displacement += value(q, a) * u_nu(facets(f, a));
      }
      const double share = measure(f * points + q), exact = -0.1 * std::sin(x[0] + 0.4 * x[1]);
      mine[2] += share * std::pow(pressure - exact_pressure(x), 2);
      mine[3] += share * std::pow(exact_pressure(x), 2);
      mine[4] += share * std::pow(normal_displacement - exact, 2);
      mine[5] += share * std::pow(exact, 2);
    }
  }
  std::array<double, 6> all;
  Teuchos::reduceAll(mesh->comm(), Teuchos::REDUCE_SUM, 6, mine.data(), all.data());
  const auto estimate = adapt::recovered_estimate(
      {d, scene.model.materials, problem.contact_sides(), scene.model.tractions, step.contact, s.contact, *s.u});
  return {std::sqrt(all[0] / all[1]), std::sqrt(all[4] / all[5]), std::sqrt(all[2] / all[3]),
          std::sqrt(estimate.total() / all[0])};
}

class ManufacturedInSpace : public testing::TestWithParam<std::tuple<std::string, bool>>
{
};

TEST_P(ManufacturedInSpace, ErrorsFallAtTheElementsRates)
{
  const auto &[element, distorts] = GetParam();
  const bool quadratic = element[1] == '2';
  std::vector<Errors> found;
  for (const int n : quadratic ? std::vector<int>{2, 4, 8} : std::vector<int>{4, 8, 16})
    found.push_back(errors(element, n, distorts));
  for (std::size_t k = 1; k < found.size(); ++k) {
    const auto rate = [&](double Errors::*error) { return std::log2(found[k - 1].*error / found[k].*error); };
    RecordProperty("energy_rate_" + std::to_string(k), std::to_string(rate(&Errors::energy)));
    RecordProperty("displacement_rate_" + std::to_string(k), std::to_string(rate(&Errors::displacement)));
    RecordProperty("pressure_rate_" + std::to_string(k), std::to_string(rate(&Errors::pressure)));
    RecordProperty("effectivity_" + std::to_string(k), std::to_string(found[k].effectivity));
    EXPECT_NEAR(rate(&Errors::energy), quadratic ? 2 : 1, 0.15) << found[k].energy;
    EXPECT_GE(rate(&Errors::displacement), quadratic ? 2.75 : 1.75) << found[k].displacement;
    EXPECT_GE(rate(&Errors::pressure), quadratic ? 1.2 : 1.4) << found[k].pressure;
    // On uniform Q2 meshes the pressures, whose error falls by h^1.5 at most, count for more than the strains.
    EXPECT_GE(found[k].effectivity, 0.9);
    EXPECT_LE(found[k].effectivity, element == "Q2" ? 5.5 : 2);
  }
}

TEST(AdaptiveInSpace, EstimateIsTrueAndErrorsFallAtTheRateOfTheOrder)
{
  constexpr fem::Material material{2.6, 0.3};
  for (const auto &[element, targets] :
       std::map<std::string, std::vector<double>>{{"P2", {0.012, 0.006, 0.003}}, {"P1", {0.2, 0.1}}}) {
    SCOPED_TRACE(element);
    std::vector<double> dofs, error;
    for (const double target : targets) {
      std::size_t cycle = 0;
      double relative = 0;
      const auto judge = [&](const Scene &, Solution &s) {
        const fem::Discretization &d = s.discretization;
        const double squared = test::energy_of_difference(d, material, *s.u, exact_gradient),
                     norm = test::energy_of_difference(d, material, Vector(d.owned_dofs), exact_gradient);
        relative = std::sqrt(squared / norm);
        if (++cycle < 3 && !s.adaptation) return;
        EXPECT_GT(relative_estimate(s) / relative, 0.8) << "mesh " << cycle;
        EXPECT_LT(relative_estimate(s) / relative, 1.5) << "mesh " << cycle;
      };
      std::ostream nowhere(nullptr);
      const Scene scene = read_scene(deck, {"Mesh->Element=" + element, "Mesh->Cells={6,2,2}",
                                            "Adapt->Target Relative Error=" + std::to_string(target)});
      const Solution last = solve(scene, Tpetra::getDefaultComm(), nowhere, judge);
      ASSERT_TRUE(last.adaptation->reached) << last.adaptation->reason;
      EXPECT_LT(relative, target);
      dofs.push_back(static_cast<double>(last.adaptation->cycles.back().dofs));
      error.push_back(relative);
    }
    const double order = std::log(error.front() / error.back()) / std::log(dofs.back() / dofs.front());
    RecordProperty("order_" + element, std::to_string(order));
    EXPECT_GT(order, 0.95 * (element == "P2" ? 2. : 1.) / 3);
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, ManufacturedInSpace,
                         testing::Combine(testing::Values("P1", "Q1", "P2", "Q2"), testing::Bool()),
                         [](const auto &info) {
                           return std::get<0>(info.param) + (std::get<1>(info.param) ? "Distorted" : "Straight");
                         });

} // namespace
} // namespace manufactured_space_test
