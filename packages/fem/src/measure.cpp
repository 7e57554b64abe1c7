// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/measure.hpp"

#include "rpc/core/parallel.hpp"

namespace rpc::fem
{
namespace
{

/// The sum of nodal forces.
Point force_sum(const Discretization &d, const Vector &force)
{
  const int dim = d.dim();
  const auto values = device_read(force);
  std::vector<double> sums(3, 0.);
  for (int c = 0; c < dim; ++c)
    Kokkos::parallel_reduce(
        "rpc::fem::force_sum", device_range(d.mesh->num_owned_nodes()),
        KOKKOS_LAMBDA(const LO n, double &sum) { sum += values(dof(dim, n, c)); }, sums[c]);
  sums = summed(d.mesh->comm(), sums);
  if (d.axisymmetric()) sums[0] = 0; // around the axis radial forces cancel
  return {sums[0], sums[1], sums[2]};
}

} // namespace

BodyMeasure body_measure(const Discretization &d)
{
  BodyMeasure body;
  Vector unit(d.owned_dofs);
  add_body_force(d, {ScalarField(0.), ScalarField(1.), ScalarField(0.)}, "", unit);
  body.volume = force_sum(d, unit)[1];
  const auto coords = d.mesh->coords;
  std::vector<double> ends;
  for (int c = 0; c < d.dim(); ++c) {
    double low = 0, high = 0;
    Kokkos::parallel_reduce(
        "rpc::fem::box_around", device_range(static_cast<LO>(coords.extent(0))), // images, too
        KOKKOS_LAMBDA(const LO n, double &least, double &most) {
          if (coords(n, c) < least) least = coords(n, c);
          if (coords(n, c) > most) most = coords(n, c);
        },
        Kokkos::Min<double>(low), Kokkos::Max<double>(high));
    ends.push_back(-low);
    ends.push_back(high);
  }
  ends = largest(d.mesh->comm(), ends);
  for (int c = 0; c < d.dim(); ++c) {
    body.lower[c] = 0 - ends[2 * c]; // no -0
    body.upper[c] = ends[2 * c + 1];
  }
  return body;
}

Point resultant(const Discretization &d, const TractionLoad &load)
{
  Vector force(d.owned_dofs);
  const std::string path = "Traction->" + load.name;
  const mesh::Side &side = d.mesh->side(load.side, path + "->Side");
  add_traction(d, side, force_per_area(d, side, load), path, force);
  return force_sum(d, force);
}

Point resultant(const Discretization &d, const VectorField &body_force)
{
  Vector force(d.owned_dofs);
  add_body_force(d, body_force, "Body Force", force);
  return force_sum(d, force);
}

} // namespace rpc::fem
