// SPDX-License-Identifier: BSD-3-Clause
#include "squeezed.hpp"

#include <cmath>

// What ends of contact and the highest order of facets leave open. doc/theory.md (10.7g), (10.8c)

namespace contact_ends_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

TEST(ContactEnds, LeaveOpenOfForcesWhatTheEndsOfASmoothContactDo)
{
  const auto nothing = [](double) { return 0.; };
  const auto part = [](const double x) { return x > 0.4 && x < 1.1 ? 10. : 0.; }; // 0.5 to 1 at the nodes
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const double h = Squeezed::h, pressed = element.order == 1 ? 2 * h : h + 2 * h / 6,
                 mean = 10 * pressed / Squeezed::length;
    // In the plane two facets of length h are partly open, in space two strips of them, whose errors are independent of each other.
    const int facets = element.dim == 2 ? 2 : element.shape == mesh::Shape::simplex ? 8 : 4;
    const double area = element.dim == 2 ? h : 2 * h * Squeezed::depth / facets;
    const double each = M_PI / (32 * element.order * element.order) * area * 10 * 10 / mean;
    const double of_all = element.dim == 2 ? facets * each : std::sqrt(2. * facets) * each;
    EXPECT_NEAR(estimate_with(element, ScalarField(99.), 10, part, nothing).ends_force / of_all, 1, 1e-12);
    const auto opens = [](const double x) { return x > 0.4 && x < 1.1 ? 0. : -1.; }; // the gap jumps: the end is known
    EXPECT_EQ(estimate_with(element, ScalarField(99.), 10, part, opens).ends_force, 0);
    EXPECT_EQ(estimate_with(
                  element, ScalarField(99.), 10, [](double) { return 10.; }, nothing)
                  .ends_force,
              0);
  }
}

TEST(HighestOrder, LeavesOpenOfDepthAndPressureWhatItAddsAtTheDeepestNode)
{
  constexpr double yield = 10, hardening = 40, of_x = 0.01, of_z = 0.04;
  const auto depth = [](const double x, const double z) { return 0.1 + of_x * x * x + of_z * z * z; };
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const bool space = element.dim == 3, simplex = element.shape == mesh::Shape::simplex;
    const double h = Squeezed::h, l = Squeezed::length, z = space ? Squeezed::depth : 0,
                 h_z = space ? Squeezed::h_z : 0;
    // The deepest node that is a point of contact: the corner, in space with quadratic triangles the middle of an edge along x.
    const bool middle = space && simplex && element.order == 2;
    const double deepest = depth(middle ? l - h / 2 : l, z), highest = yield + hardening * deepest;
    // Along x, along z, or along both: the diagonal of linear triangles ends at the corner.
    const double along_x = depth(l, z) - depth(l - h, z), along_z = depth(l, z) - depth(l, z - h_z);
    const double first = simplex ? along_x + along_z : std::max(along_x, along_z);
    const double second = of_x * h * h / 2, second_z = of_z * h_z * h_z / 2;
    const double added = element.order == 1 ? first : middle ? second : std::max(second, second_z);
    Squeezed body(element, yield, 0, highest);
    contact::ContactOptions options;
    options.side = "bottom";
    options.yield_stress = ScalarField(yield);
    options.hardening = ScalarField(hardening);
    body.nodes = contact::contact_nodes(body.d, {options}, fem::dirichlet_dofs(body.d, {}), steel);
    const auto x = fem::node_positions(*body.d.mesh, body.nodes.node);
    const auto pressure = Kokkos::create_mirror_view(body.result.pressure);
    const auto dent = Kokkos::create_mirror_view(body.result.dent);
    for (LO i = 0; i < body.nodes.size(); ++i) {
      dent(i) = depth(x(i, 0), space ? x(i, 2) : 0);
      pressure(i) = yield + hardening * dent(i);
    }
    Kokkos::deep_copy(body.result.pressure, pressure);
    Kokkos::deep_copy(body.result.dent, dent);
    Kokkos::deep_copy(body.result.penetration, body.result.dent);
    const auto estimate = body.estimate();
    EXPECT_NEAR(estimate.misread_penetration, deepest + added, 1e-12);
    EXPECT_NEAR(estimate.peak.rounded, hardening * added, 1e-9);
  }
}

} // namespace
} // namespace contact_ends_test
