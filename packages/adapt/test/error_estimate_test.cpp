#include "rpc/adapt/error_estimate.hpp"

#include "bodies.hpp"

#include <limits>

namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr fem::Material steel{2000, 0.3};

/// int (s(u) - s(u_h)) : eps(u - u_h) over this rank's cells, with gradient[i][j] = du_i / dx_j of u at a point.
double energy_of_difference(const fem::Discretization &d, const Vector &u_h,
                            const std::function<void(const Point &, double (&)[3][3])> &gradient)
{
  const mesh::Mesh &mesh = *d.mesh;
  const int dim = d.dim();
  Vector overlap(d.overlap_dofs);
  overlap.doImport(u_h, *d.dof_import, Tpetra::INSERT);
  const auto u = to_host(device_read(overlap));
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  const auto value = to_host(d.reference.cell_load.value);
  const auto slope_of = to_host(d.reference.cell_load.gradient);
  const auto weight = to_host(d.reference.cell_load.weight);
  double sum = 0;
  for (LO cell = 0; cell < mesh.num_owned_cells; ++cell)
    for (std::size_t q = 0; q < weight.extent(0); ++q) {
      // grad_x u = grad_X u (grad_X x)^-1, by Cramer's rule
      double J[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, U[3][3] = {}, e[3][3] = {};
      Point x{};
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) J[i][j] = 0;
      for (std::size_t a = 0; a < cells.extent(1); ++a)
        for (int i = 0; i < dim; ++i) {
          x[i] += value(q, a) * coords(cells(cell, a), i);
          for (int j = 0; j < dim; ++j) {
            J[i][j] += coords(cells(cell, a), i) * slope_of(q, a, j);
            U[i][j] += u(dim * cells(cell, a) + i) * slope_of(q, a, j);
          }
        }
      double cofactor[3][3], det = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          cofactor[i][j] = J[(i + 1) % 3][(j + 1) % 3] * J[(i + 2) % 3][(j + 2) % 3] -
                           J[(i + 1) % 3][(j + 2) % 3] * J[(i + 2) % 3][(j + 1) % 3];
      for (int i = 0; i < 3; ++i) det += J[0][i] * cofactor[0][i];
      gradient(x, e);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          for (int k = 0; k < dim; ++k) e[i][j] -= U[i][k] * cofactor[j][k] / det;
      double trace = 0, density = 0;
      for (int i = 0; i < 3; ++i) {
        trace += e[i][i];
        for (int j = 0; j < 3; ++j) density += steel.mu() / 2 * std::pow(e[i][j] + e[j][i], 2);
      }
      sum += weight(q) * det * (density + steel.lambda() * trace * trace);
    }
  return sum;
}

TEST(ErrorEstimate, IsTheErrorOfAnInterpolantWhereRecoveryIsExact)
{
  // u_i = (a_i . x)^(p+1), which the element does not hold and its recovery does.
  constexpr double a[3][3] = {{0.3, -0.5, 0.2}, {-0.4, 0.1, 0.6}, {0.2, 0.7, -0.3}};
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const int n = element.order + 1;
    const auto dot = [&](const int i, const Point &x) { return a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2]; };
    const auto u = interpolate(d, [&](const Point &x) {
      return Point{std::pow(dot(0, x), n), std::pow(dot(1, x), n), std::pow(dot(2, x), n)};
    });
    const auto estimate = adapt::estimate_error(d, steel, {}, {}, {}, {}, *u);
    const double exact = sum_all(d.mesh->comm(), energy_of_difference(d, *u, [&](const Point &x, double(&g)[3][3]) {
                                   for (int i = 0; i < element.dim; ++i)
                                     for (int j = 0; j < element.dim; ++j)
                                       g[i][j] = n * std::pow(dot(i, x), n - 1) * a[i][j];
                                 }));
    EXPECT_GT(exact, 0.01);
    EXPECT_NEAR(estimate.recovery / exact, 1, 1e-9);
    EXPECT_EQ(estimate.total(), estimate.recovery);
    double of_cells = 0;
    const auto squared = to_host(estimate.squared);
    for (LO cell = 0; cell < d.mesh->num_owned_cells; ++cell) of_cells += squared(cell);
    EXPECT_NEAR(sum_all(d.mesh->comm(), of_cells) / estimate.total(), 1, 1e-12);
  }
}

/// (0, 2) x (0, 1) in 4 x 2 cells over a foundation, squeezed by a strain; all contact nodes at one pressure.
struct Squeezed {
  static constexpr double strain = -0.01, length = 2, h = 0.5;
  fem::Discretization d;
  contact::ContactNodes nodes;
  contact::ContactResult result;
  RCP<Vector> u;

  Squeezed(const mesh::Element &element, const double yield, const double gap, const double pressure)
      : d(body({{0, 0}, {length, 1}, {4, 2}, element}, world()))
  {
    contact::ContactOptions options;
    options.side = "bottom";
    options.yield_stress = ScalarField(yield);
    options.gap = ScalarField(gap);
    nodes = contact::contact_nodes(d, {options}, fem::dirichlet_dofs(d, {}), steel);
    u = interpolate(d, [](const Point &x) { return Point{0, strain * x[1]}; });
    result.pressure = DeviceView<double *>("test::pressure", nodes.size());
    result.penetration = DeviceView<double *>("test::penetration", nodes.size());
    Kokkos::deep_copy(result.pressure, pressure);
    Kokkos::deep_copy(result.penetration, -gap); // nothing moves at the bottom
    result.total.max_pressure = pressure;
    result.sides = {result.total};
  }
  adapt::ErrorEstimate estimate(const std::vector<fem::TractionLoad> &loads = {}) const
  {
    return adapt::estimate_error(d, steel, {&d.mesh->side("bottom", "test")}, loads, nodes, result, *u);
  }
  static double stiffness() { return steel.lambda() + 2 * steel.mu(); }
  static double equilibrium(const double mismatch) { return length * h * mismatch * mismatch / (3 * stiffness()); }
};

std::vector<mesh::Element> plane_elements()
{
  return {{2, 1}, {2, 2}, {2, 1, mesh::Shape::simplex}, {2, 2, mesh::Shape::simplex}};
}

TEST(ErrorEstimate, KnowsPressuresThatDoNotBalanceTheStress)
{
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const double balanced = -Squeezed::strain * Squeezed::stiffness();
    const auto none = Squeezed(element, 100, 0, balanced).estimate();
    EXPECT_LT(none.total(), 1e-24 * balanced * balanced);
    const auto more = Squeezed(element, 100, 0, balanced + 3).estimate();
    EXPECT_NEAR(more.equilibrium / Squeezed::equilibrium(3), 1, 1e-10);
    EXPECT_LT(more.recovery + more.complementarity, 1e-20 * more.equilibrium);
    EXPECT_NEAR(more.total() / more.equilibrium, 1, 1e-10);
    EXPECT_NEAR(more.pressure, 3 * std::sqrt(Squeezed::length), 1e-10);
    EXPECT_NEAR(more.max_pressure, 3, 1e-10);
  }
}

TEST(ErrorEstimate, CountsTractionsOnAContactSide)
{
  const double balanced = -Squeezed::strain * Squeezed::stiffness();
  fem::TractionLoad traction{"lift", "bottom", {ScalarField(0.), ScalarField(4.), ScalarField(0.)}};
  const Squeezed body({2, 1}, 100, 0, balanced - 4);
  EXPECT_LT(body.estimate({traction}).total(), 1e-20);
  traction.side = "top"; // elsewhere
  EXPECT_NEAR(body.estimate({traction}).equilibrium / Squeezed::equilibrium(4), 1, 1e-10);
}

TEST(ErrorEstimate, KnowsWhatContradictsTheContactLaw)
{
  const double p = -Squeezed::strain * Squeezed::stiffness();
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    // Pressure across an open gap, g = 0.02.
    EXPECT_NEAR(Squeezed(element, 100, 0.02, p).estimate().complementarity, 2 * Squeezed::length * p * 0.02, 1e-10);
    // A foundation that has given way by 0.03 at less than its yield stress; at the yield stress.
    EXPECT_NEAR(Squeezed(element, p + 5, -0.03, p).estimate().complementarity, 2 * Squeezed::length * 5 * 0.03, 1e-10);
    EXPECT_NEAR(Squeezed(element, p, -0.03, p).estimate().complementarity, 0, 1e-10);
    // No finite yield stress: twice the largest pressure stands for it.
    const double rigid = std::numeric_limits<double>::infinity();
    EXPECT_NEAR(Squeezed(element, rigid, -0.03, p).estimate().complementarity, 2 * Squeezed::length * p * 0.03, 1e-10);
  }
}

} // namespace
