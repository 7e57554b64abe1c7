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
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const double h = Squeezed::h, force = 10 * (element.order == 1 ? 2 * h : h + 2 * h / 6);
    const double each = M_PI / (32 * element.order * element.order) * h * 10 * 10 * Squeezed::length / force;
    EXPECT_NEAR(estimate_with(element, ScalarField(99.), 10, part, nothing).ends_force / (2 * each), 1, 1e-12);
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
  constexpr double yield = 10, hardening = 40;
  const auto depth = [](const double x) { return 0.1 + 0.01 * x * x; };
  for (const auto &element : plane_elements()) {
    SCOPED_TRACE(text_of(element));
    const double deepest = depth(Squeezed::length), highest = yield + hardening * deepest;
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
      dent(i) = depth(x(i, 0));
      pressure(i) = yield + hardening * dent(i);
    }
    Kokkos::deep_copy(body.result.pressure, pressure);
    Kokkos::deep_copy(body.result.dent, dent);
    Kokkos::deep_copy(body.result.penetration, body.result.dent);
    const double h = Squeezed::h, second = 2 * 0.01 * h * h / 4, first = deepest - depth(Squeezed::length - h);
    const double added = element.order == 2 ? second : first;
    const auto estimate = body.estimate();
    EXPECT_NEAR(estimate.misread_penetration, deepest + added, 1e-12);
    EXPECT_NEAR(estimate.peak.rounded, hardening * added, 1e-9);
  }
}

} // namespace
} // namespace contact_ends_test
