// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bodies.hpp"
#include "rpc/adapt/estimators/recovered.hpp"
#include "rpc/fem/surface.hpp"

/// Bodies with given contact pressures, whose error is estimated.
namespace rpc::test
{

inline constexpr fem::Material steel{2000, 0.3};

/// (0, 2) x (0, 1) in 4 x 2 cells, in space times (0, 1.5) in 2, over a foundation, squeezed by a strain; all contact nodes at one pressure.
struct Squeezed {
  static constexpr double strain = -0.01, length = 2, h = 0.5, depth = 1.5, h_z = 0.75;
  fem::Discretization d;
  contact::ContactNodes nodes;
  contact::ContactResult result;
  RCP<Vector> u;

  Squeezed(const mesh::Element &element, const double yield, const double gap, const double pressure,
           const contact::Obstacle &obstacle = {})
      : d(element.dim == 2 ? body({{0, 0}, {length, 1}, {4, 2}, element}, world())
                           : body({{0, 0, 0}, {length, 1, depth}, {4, 2, 2}, element}, world()))
  {
    contact::ContactOptions options;
    options.side = "bottom";
    options.yield_stress = ScalarField(yield);
    options.gap = ScalarField(gap);
    options.obstacle = obstacle;
    nodes = contact::contact_nodes(d, {options}, fem::dirichlet_dofs(d, {}), steel);
    u = interpolate(d, [](const Point &x) { return Point{0, strain * x[1]}; });
    result.pressure = DeviceView<double *>("test::pressure", nodes.size());
    result.penetration = DeviceView<double *>("test::penetration", nodes.size());
    result.dent = DeviceView<double *>("test::dent", nodes.size());
    Kokkos::deep_copy(result.pressure, pressure);
    Kokkos::deep_copy(result.penetration, -gap); // nothing moves at the bottom
    result.total.max_pressure = pressure;
    result.total.contact_length = element.dim == 2 ? length : length * depth;
    result.sides = {result.total};
  }
  adapt::ErrorEstimate estimate(const std::vector<fem::TractionLoad> &loads = {}) const
  {
    return adapt::recovered_estimate({d, steel, {&d.mesh->side("bottom", "test")}, loads, nodes, result, *u});
  }
  static double stiffness() { return steel.lambda() + 2 * steel.mu(); }
  static double equilibrium(const double mismatch) { return length * h * mismatch * mismatch / (3 * stiffness()); }
};

inline std::vector<mesh::Element> plane_elements()
{
  return {{2, 1}, {2, 2}, {2, 1, mesh::Shape::simplex}, {2, 2, mesh::Shape::simplex}};
}

/// The squeezed body with pressures p(x), penetrations v(x) and yield stresses xi(x) at its contact nodes.
template <class Pressure, class Penetration>
adapt::ErrorEstimate estimate_with(const mesh::Element &element, const ScalarField &yield, const double highest,
                                   const Pressure &p, const Penetration &v, const ScalarField &gap = ScalarField(0.),
                                   const double softness = 0, const ScalarField &dents = ScalarField(0.))
{
  Squeezed body(element, 1, 0, highest);
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = yield;
  options.gap = gap;
  if (softness > 0) options.stiffness = ScalarField(1 / softness);
  body.nodes = contact::contact_nodes(body.d, {options}, fem::dirichlet_dofs(body.d, {}), steel);
  const auto x = fem::node_positions(*body.d.mesh, body.nodes.node);
  const auto pressure = Kokkos::create_mirror_view(body.result.pressure);
  const auto penetration = Kokkos::create_mirror_view(body.result.penetration);
  const auto dent = Kokkos::create_mirror_view(body.nodes.dent);
  for (LO i = 0; i < body.nodes.size(); ++i) {
    dent(i) = dents({x(i, 0), 0, 0});
    pressure(i) = p(x(i, 0));
    penetration(i) = v(x(i, 0));
  }
  Kokkos::deep_copy(body.result.pressure, pressure);
  Kokkos::deep_copy(body.result.penetration, penetration);
  Kokkos::deep_copy(body.nodes.dent, dent);
  return body.estimate();
}

inline ScalarField step(const double at, const double left, const double right)
{
  return ScalarField("test", [=](const Point &x) { return x[0] < at ? left : right; });
}

} // namespace rpc::test
