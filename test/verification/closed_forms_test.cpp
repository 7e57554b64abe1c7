// SPDX-License-Identifier: BSD-3-Clause
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Thin and nearly incompressible bodies against closed forms.

namespace closed_forms_test
{
namespace
{

using namespace rpc;

const std::string decks = std::string(RPC_TEST_DECKS) + "/";

/// Component c of u at the node nearest to x, over all ranks.
double displacement_at(const Solution &s, const Point &x, const int c)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const int dim = mesh.dim();
  const auto coords = to_host(mesh.coords);
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO node = 0; node < mesh.num_owned_nodes(); ++node) {
    double square = 0;
    for (int k = 0; k < dim; ++k) square += std::pow(coords(node, k) - x[k], 2);
    if (square < 1e-20) return u(dim * node + c, 0);
  }
  ADD_FAILURE() << "no node there";
  return 0;
}

Solution solved(const std::string &deck, const std::vector<std::string> &assignments)
{
  Solution s = run_scene(decks + deck, assignments);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  return s;
}

/// Deflection of the middle of plate.xml over Kirchhoff's, p / (4 pi^4 D).
double over_kirchhoff(const double thickness)
{
  const Solution s = solved("plate.xml", {"Mesh->Upper={1,1," + std::to_string(thickness) + "}"});
  const double E = 1e6, nu = 0.3, pi = std::acos(-1.);
  const double D = E * std::pow(thickness, 3) / (12 * (1 - nu * nu));
  return -displacement_at(s, {0.5, 0.5, thickness / 2}, 2) * 4 * std::pow(pi, 4) * D;
}

TEST(Plate, BendsAsThePlateTheoriesSay)
{
  struct Case {
    double thickness, error; // of the mesh
  };
  for (const auto &[thickness, error] : {Case{0.1, 1e-3}, Case{0.02, 1e-3}, Case{0.002, 2.5e-3}}) {
    SCOPED_TRACE(thickness);
    const double nu = 0.3, square = 2 * std::pow(std::acos(-1.) * thickness, 2); // of wave number times thickness
    const double mindlin = 1 + square / (5 * (1 - nu));                          // factor of shear 5/6
    const double in_space = 1 + square * (8 - 3 * nu) / (40 * (1 - nu));         // of the middle surface, to this order
    const double found = over_kirchhoff(thickness);
    std::printf("thickness %g: %.5f times Kirchhoff's deflection; Mindlin %.5f, in space %.5f\n", thickness, found,
                mindlin, in_space);
    EXPECT_NEAR(found, in_space, error);
    EXPECT_NEAR(found, mindlin, error + (mindlin - in_space));
  }
}

TEST(Beam, OfQ1IsTooStiffByTheFactorOfItsNote)
{
  const double E = 1000 / (1 - 0.3 * 0.3), moment = 4 * std::pow(0.5, 3) / 12,
               curvature = moment / (E * std::pow(0.5, 3) / 12);
  const double exact = curvature * 8 * 8 / 2;
  EXPECT_NEAR(displacement_at(solved("bent.xml", {"Mesh->Element=Q2"}), {8, 0}, 1), exact, 1e-7 * exact);
  const double q1 = displacement_at(solved("bent.xml", {}), {8, 0}, 1);
  // (1 - nu)/2 (h/t)^2 + nu^2/(1 - 2 nu)/layers^2, (2.6a)
  EXPECT_NEAR(exact / q1, 1 + 0.35 * 2 * 2 + 0.09 / 0.4 / 4, 1e-5);
}

TEST(Rubber, OfUniformStressIsExactForAllElements)
{
  const double E = 3, nu = 0.49999, p = 0.03;
  for (const char *element : {"Q1", "P1", "Q2", "P2"})
    for (const int dim : {2, 3}) {
      SCOPED_TRACE(std::string(element) + (dim == 2 ? " in the plane" : " in space"));
      const Solution s =
          solved(dim == 2 ? "rubber_plane.xml" : "rubber.xml", {std::string("Mesh->Element=") + element});
      const double sideways = dim == 2 ? p * nu * (1 + nu) / E : p * nu / E;
      const double down = dim == 2 ? p * (1 - nu * nu) / E : p / E;
      EXPECT_NEAR(displacement_at(s, {2, 1, 1}, 0), 2 * sideways, 1e-6 * sideways);
      EXPECT_NEAR(displacement_at(s, {2, 1, 1}, 1), -down, 1e-6 * down);
      EXPECT_NEAR(s.contact.total.max_pressure, p, 1e-6 * p);
    }
}

} // namespace
} // namespace closed_forms_test
