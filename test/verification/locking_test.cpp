// SPDX-License-Identifier: BSD-3-Clause
#include "larger.hpp"
#include "rpc/fem/stress.hpp"
#include "run_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <map>
#include <vector>

// Nearly incompressible materials: errors against an exact solution whose stresses stay bounded as nu nears 0.5.
// It prints the table of doc/robustness.md.

namespace locking_test
{
namespace
{

using namespace rpc;

constexpr double pi = 3.14159265358979323846, mu = 1;

/// A displacement without divergence plus one that is scaled with 1/(1 + lambda), on the unit square (in 3D a slab of it,
/// in plane strain) held at three sides, with the tractions that belong to it on the fourth, y = 1.
struct Exact {
  explicit Exact(const double nu) : lambda(2 * mu * nu / (1 - 2 * nu)), scale(1 / (1 + lambda)) {}
  double lambda, scale;

  std::array<double, 2> u(const double x, const double y) const
  {
    const double bubble = scale * std::sin(pi * x) * std::sin(pi * y);
    return {std::pow(std::sin(pi * x), 2) * std::sin(2 * pi * y) + bubble,
            -std::sin(2 * pi * x) * std::pow(std::sin(pi * y), 2) + bubble};
  }
  /// du_i / dx_j
  std::array<std::array<double, 2>, 2> gradient(const double x, const double y) const
  {
    const double bx = scale * pi * std::cos(pi * x) * std::sin(pi * y);
    const double by = scale * pi * std::sin(pi * x) * std::cos(pi * y);
    const double xx = pi * std::sin(2 * pi * x) * std::sin(2 * pi * y);
    return {{{xx + bx, 2 * pi * std::pow(std::sin(pi * x), 2) * std::cos(2 * pi * y) + by},
             {-2 * pi * std::cos(2 * pi * x) * std::pow(std::sin(pi * y), 2) + bx, -xx + by}}};
  }
  /// xx, yy, xy
  std::array<double, 3> stress(const double x, const double y) const
  {
    const auto g = gradient(x, y);
    const double p = lambda * (g[0][0] + g[1][1]);
    return {p + 2 * mu * g[0][0], p + 2 * mu * g[1][1], mu * (g[0][1] + g[1][0])};
  }
  /// -mu laplace u - (lambda + mu) grad div u
  std::array<double, 2> force(const double x, const double y) const
  {
    const double sx = std::sin(pi * x), sy = std::sin(pi * y), s2x = std::sin(2 * pi * x), s2y = std::sin(2 * pi * y);
    const double c2x = std::cos(2 * pi * x), c2y = std::cos(2 * pi * y), square = pi * pi;
    const double bubble = -2 * scale * square * sx * sy;
    const double a = 2 * square * c2x * s2y - 4 * square * sx * sx * s2y + bubble;
    const double b = 4 * square * s2x * sy * sy - 2 * square * s2x * c2y + bubble;
    const double slope = scale * square * (std::cos(pi * x) * std::cos(pi * y) - sx * sy); // of div u, in x and y alike
    return {-mu * a - (lambda + mu) * slope, -mu * b - (lambda + mu) * slope};
  }
};

struct Body {
  mesh::Element element;
  fem::Dilatation dilatation;
  std::string name;
};
const Body q1_full{{2, 1}, fem::Dilatation::full, "Q1 full"}, q1{{2, 1}, fem::Dilatation::projected, "Q1"},
    p1{{2, 1, mesh::Shape::simplex}, fem::Dilatation::automatic, "P1"},
    q2_full{{2, 2}, fem::Dilatation::full, "Q2 full"}, q2{{2, 2}, fem::Dilatation::projected, "Q2"},
    p2_full{{2, 2, mesh::Shape::simplex}, fem::Dilatation::full, "P2 full"},
    p2{{2, 2, mesh::Shape::simplex}, fem::Dilatation::projected, "P2"},
    hex_full{{3, 1}, fem::Dilatation::full, "Q1 full in 3D"}, hex{{3, 1}, fem::Dilatation::projected, "Q1 in 3D"},
    tet_full{{3, 2, mesh::Shape::simplex}, fem::Dilatation::full, "P2 full in 3D"},
    tet{{3, 2, mesh::Shape::simplex}, fem::Dilatation::projected, "P2 in 3D"};

ScalarField field(const std::function<double(const Point &)> &function)
{
  return ScalarField("exact", function);
}

Scene scene_of(const Body &body, const double nu, const int n)
{
  const Exact exact(nu);
  const int dim = body.element.dim;
  Scene scene;
  scene.name = "locking";
  const double thickness = 2. / n;
  mesh::BoxOptions box{{0, 0}, {1, 1}, {n, n}, body.element};
  if (dim == 3) box = {{0, 0, 0}, {1, 1, thickness}, {n, n, 2}, body.element};
  scene.mesh = box;
  scene.model.materials = fem::Materials({2 * mu * (1 + nu), nu, body.dilatation});
  for (const std::string side : {"left", "right", "bottom"}) {
    fem::DirichletCondition held{side, side, {}};
    for (int c = 0; c < dim; ++c) held.displacement[c] = ScalarField(0.);
    scene.model.dirichlet.push_back(held);
  }
  for (const std::string side : {"back", "front"}) {
    fem::DirichletCondition in_plane{side, side, {}};
    in_plane.displacement[2] = ScalarField(0.);
    if (dim == 3) scene.model.dirichlet.push_back(in_plane);
  }
  scene.model.tractions = {{"top",
                            "top",
                            {field([=](const Point &x) { return exact.stress(x[0], x[1])[2]; }),
                             field([=](const Point &x) { return exact.stress(x[0], x[1])[1]; }), ScalarField(0.)}}};
  scene.model.body_force = {field([=](const Point &x) { return exact.force(x[0], x[1])[0]; }),
                            field([=](const Point &x) { return exact.force(x[0], x[1])[1]; }), ScalarField(0.)};
  scene.linear_solver.max_iterations = 2000;
  return scene;
}

/// Relative errors.
struct Errors {
  double strain;       ///< L2: the part of the energy norm that stays bounded
  double displacement; ///< at the nodes, root mean square
  double stress;       ///< the same of the recovered xx, yy, xy
  double pressure;     ///< the same of the recovered (xx + yy) / 2
};

/// (|eps(u_h - u)|^2, |eps(u)|^2) in L2 over this rank's cells.
std::array<double, 2> strain_errors(const Solution &s, const Exact &exact)
{
  const fem::Discretization &d = s.discretization;
  const mesh::Mesh &mesh = *d.mesh;
  const fem::BasisTable &table = d.reference.cell_load;
  const auto u = to_host(device_read(*fem::on_overlap(d, *s.u)));
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  const auto value = to_host(table.value);
  const auto slope = to_host(table.gradient);
  const auto weight = to_host(table.weight);
  const int dim = mesh.dim(), nodes = mesh.element.num_nodes(), points = table.num_points();
  std::array<double, 2> sums{};
  for (LO cell = 0; cell < mesh.num_owned_cells; ++cell) {
    for (int q = 0; q < points; ++q) {
      double x[3] = {}, J[3][3] = {}, reference[3][3] = {}; // J = dx_i / dX_j, reference = du_i / dX_j
      if (dim == 2) J[2][2] = 1;
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < dim; ++i) {
          x[i] += value(q, a) * coords(cells(cell, a), i);
          for (int j = 0; j < dim; ++j) {
            J[i][j] += slope(q, a, j) * coords(cells(cell, a), i);
            reference[i][j] += slope(q, a, j) * u(dim * cells(cell, a) + i);
          }
        }
      const auto cofactor = [&](const int r, const int c) {
        return J[(r + 1) % 3][(c + 1) % 3] * J[(r + 2) % 3][(c + 2) % 3] -
               J[(r + 1) % 3][(c + 2) % 3] * J[(r + 2) % 3][(c + 1) % 3];
      };
      const double det = J[0][0] * cofactor(0, 0) + J[0][1] * cofactor(0, 1) + J[0][2] * cofactor(0, 2);
      const auto found = [&](const int r, const int c) {
        double sum = 0;
        for (int k = 0; k < dim; ++k) sum += reference[r][k] * cofactor(c, k) / det;
        return sum;
      };
      const auto in_plane = exact.gradient(x[0], x[1]);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
          const double strain = i < 2 && j < 2 ? 0.5 * (in_plane[i][j] + in_plane[j][i]) : 0;
          sums[0] += weight(q) * det * std::pow(0.5 * (found(i, j) + found(j, i)) - strain, 2);
          sums[1] += weight(q) * det * strain * strain;
        }
    }
  }
  return sums;
}

Errors errors_of(const Body &body, const double nu, const int n)
{
  const Exact exact(nu);
  const Scene scene = scene_of(body, nu, n);
  std::ostream nowhere(nullptr);
  const Solution s = solve(scene, Tpetra::getDefaultComm(), nowhere);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const int dim = mesh.dim();
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto stress = fem::RecoveredStress(s.discretization, scene.model.materials, *s.u).at_nodes();
  const auto sigma = stress->getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto coords = to_host(mesh.coords);
  const int column[3] = {0, 1, dim == 2 ? 2 : 3};
  const auto strain = strain_errors(s, exact);
  double mine[8] = {strain[0], strain[1]}, all[8];
  for (LO node = 0; node < mesh.num_owned_nodes(); ++node) {
    const double x = coords(node, 0), y = coords(node, 1);
    for (int c = 0; c < 2; ++c) {
      mine[2] += std::pow(u(dim * node + c, 0) - exact.u(x, y)[c], 2);
      mine[3] += std::pow(exact.u(x, y)[c], 2);
    }
    const auto expected = exact.stress(x, y);
    for (int k = 0; k < 3; ++k) {
      mine[4] += std::pow(sigma(node, column[k]) - expected[k], 2);
      mine[5] += std::pow(expected[k], 2);
    }
    mine[6] += std::pow(sigma(node, 0) + sigma(node, 1) - expected[0] - expected[1], 2);
    mine[7] += std::pow(expected[0] + expected[1], 2);
  }
  Teuchos::reduceAll(mesh.comm(), Teuchos::REDUCE_SUM, 8, mine, all);
  const auto ratio = [&](const int k) { return std::sqrt(all[2 * k] / all[2 * k + 1]); };
  return {ratio(0), ratio(1), ratio(2), ratio(3)};
}

std::vector<Errors> refined(const Body &body, const double nu)
{
  std::vector<Errors> found;
  for (const int n : {8, 16, 32}) {
    found.push_back(errors_of(body, nu, n));
    const Errors &e = found.back();
    if (Tpetra::getDefaultComm()->getRank() == 0)
      std::printf("| %s | %g | %d | %.1e | %.1e | %.1e | %.1e |\n", body.name.c_str(), nu, n, e.displacement, e.strain,
                  e.stress, e.pressure);
  }
  return found;
}

/// Errors at nu = 0.3, and at others compared with them.
class Locking : public testing::TestWithParam<double>
{
};
INSTANTIATE_TEST_SUITE_P(Table, Locking, testing::Values(0.3, 0.49, 0.499, 0.4999, 0.49999), [](const auto &info) {
  return "nu" + std::to_string(static_cast<int>(std::lround(1e5 * info.param)));
});

double rate(const std::vector<Errors> &found, double Errors::*error)
{
  return std::log2(found[1].*error / found[2].*error);
}

TEST_P(Locking, ProjectedQ1AndQ2KeepTheErrorsAndRatesTheyHaveAtModerateNu)
{
  for (const auto &[body, order] : {std::pair(q1, 1), std::pair(q2, 2)}) {
    SCOPED_TRACE(body.name);
    const auto found = refined(body, GetParam());
    EXPECT_NEAR(rate(found, &Errors::strain), order, 0.1);
    EXPECT_GT(rate(found, &Errors::displacement), order + 0.8);
    EXPECT_GT(rate(found, &Errors::stress), order + 0.8);
    EXPECT_GT(rate(found, &Errors::pressure), order + 0.8);
    const Errors moderate = errors_of(body, 0.3, 32);
    for (const auto error : {&Errors::strain, &Errors::displacement, &Errors::stress, &Errors::pressure})
      EXPECT_LT(found[2].*error, 2 * (moderate.*error));
  }
}

TEST_P(Locking, ProjectedP2LosesAccuracyButDoesNotLock)
{
  const auto found = refined(p2, GetParam());
  EXPECT_GT(rate(found, &Errors::strain), 1.2); // towards 1: a constant pressure per cell
  EXPECT_GT(rate(found, &Errors::displacement), 1.9);
  EXPECT_GT(rate(found, &Errors::stress), 1.8);
  const Errors moderate = errors_of(p2, 0.3, 32);
  for (const auto error : {&Errors::strain, &Errors::displacement, &Errors::stress, &Errors::pressure})
    EXPECT_LT(found[2].*error, 2 * (moderate.*error));
}

TEST_P(Locking, ShowsWithTheFullDilatation)
{
  // Least errors on the finest mesh. At nu = 0.4999 displacements of Q2 and P2 still converge, but stresses are of no use.
  struct Least {
    double q1_displacement, p1_displacement, q2_stress, p2_stress;
  };
  const std::map<double, Least> least = {{0.3, {}},
                                         {0.49, {0.03, 0.1, 2e-3, 0.03}},
                                         {0.499, {0.25, 0.4, 0.02, 0.7}},
                                         {0.4999, {0.5, 0.5, 0.5, 0.5}},
                                         {0.49999, {0.5, 0.5, 0.5, 0.5}}};
  const auto q1_found = refined(q1_full, GetParam()), p1_found = refined(p1, GetParam());
  const auto q2_found = refined(q2_full, GetParam()), p2_found = refined(p2_full, GetParam());
  const auto &[q1_displacement, p1_displacement, q2_stress, p2_stress] = least.at(GetParam());
  EXPECT_GT(q1_found[2].displacement, q1_displacement);
  EXPECT_GT(p1_found[2].displacement, p1_displacement);
  EXPECT_GT(q2_found[2].stress, q2_stress);
  EXPECT_GT(p2_found[2].stress, p2_stress);
  if (GetParam() == 0.3) {
    EXPECT_LT(q1_found[2].displacement, 1e-3);
    EXPECT_LT(p1_found[2].displacement, 0.02);
    EXPECT_LT(q2_found[2].stress, 1e-3);
    EXPECT_LT(p2_found[2].stress, 1e-3);
  }
}

TEST(Locking3d, ProjectedQ1DoesNotLockInHexahedra)
{
  for (const double nu : {0.49, 0.4999}) {
    const Errors moderate = errors_of(hex, 0.3, 16), coarse = errors_of(hex, nu, 8), fine = errors_of(hex, nu, 16);
    EXPECT_NEAR(std::log2(coarse.strain / fine.strain), 1, 0.1);
    for (const auto error : {&Errors::strain, &Errors::displacement, &Errors::stress, &Errors::pressure})
      EXPECT_LT(fine.*error, 2 * (moderate.*error));
  }
  EXPECT_GT(errors_of(hex_full, 0.4999, 16).displacement, 0.5);
}

TEST(Locking3d, ProjectedP2LosesAccuracyButDoesNotLockInTetrahedra)
{
  const Errors moderate = errors_of(tet, 0.3, 16);
  for (const double nu : {0.49, 0.4999}) {
    const Errors coarse = errors_of(tet, nu, 8), fine = errors_of(tet, nu, 16);
    EXPECT_GT(std::log2(coarse.strain / fine.strain), 1.2); // towards 1: a constant pressure per cell
    EXPECT_GT(std::log2(coarse.displacement / fine.displacement), 1.9);
    EXPECT_GT(std::log2(coarse.stress / fine.stress), 1.8);
    for (const auto error : {&Errors::strain, &Errors::displacement, &Errors::stress, &Errors::pressure})
      EXPECT_LT(fine.*error, 2 * (moderate.*error));
  }
  EXPECT_GT(errors_of(tet_full, 0.49, 8).stress, 0.5);
}

/// Largest second difference of the pressure along the contact side, away from its end, over the largest pressure.
double oscillation(const Solution &s)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto node = to_host(s.step.contact.node);
  const auto x = to_host(mesh.coords);
  const auto p = to_host(s.contact.pressure);
  const int intervals = 32 * mesh.element.order;
  std::vector<double> mine(intervals + 1, 0.), along(mine.size());
  for (std::size_t i = 0; i < node.extent(0); ++i)
    mine[static_cast<std::size_t>(std::lround(x(node(i), 0) / 2 * intervals))] = p(i);
  Teuchos::reduceAll(mesh.comm(), Teuchos::REDUCE_SUM, intervals + 1, mine.data(), along.data());
  double largest = 0;
  for (int i = 1; i + 1 <= 3 * intervals / 4; ++i)
    largest = test::larger(largest, std::abs(along[i - 1] - 2 * along[i] + along[i + 1]));
  return largest / s.contact.total.max_pressure;
}

TEST(NearlyIncompressibleContact, PressureOfABondedPadDoesNotOscillate)
{
  const auto pressed = [](const std::string &element, const std::string &dilatation) {
    const Solution s = run_scene(std::string(RPC_TEST_DECKS) + "/pressed.xml",
                                 {"Mesh->Element=" + element, "Material->Dilatation=" + dilatation});
    EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    const std::pair result(s.contact.total.force[1], oscillation(s));
    if (s.discretization.mesh->comm().getRank() == 0)
      std::printf("| %s %s | %.4f | %.4f |\n", element.c_str(), dilatation.c_str(), result.first, result.second);
    return result;
  };
  const double force = 0.1600; // [N/m] Q2 on 128 x 64 cells
  for (const char *element : {"Q1", "Q2", "P2"}) {
    const auto [projected, ripple] = pressed(element, "auto");
    EXPECT_NEAR(projected, force, 0.01 * force) << element;
    EXPECT_LT(ripple, 0.01) << element; // 0.002 is the pressure's own curvature in steps of Q1
  }
  EXPECT_GT(pressed("Q1", "full").first, 1.5 * force); // far too stiff
  for (const char *element : {"Q2", "P2"}) EXPECT_GT(pressed(element, "full").second, 0.1) << element;
}

} // namespace
} // namespace locking_test
