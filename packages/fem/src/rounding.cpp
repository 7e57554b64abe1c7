// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/rounding.hpp"

#include "elastic_cells.hpp"

#include <limits>

namespace rpc::fem
{
namespace
{

// Relative accuracy of displacements: three times the default of "Linear Solver->Tolerance".
constexpr double of_displacements = 3e-11;
// That of the cells' edges over the coordinates: edges are differences, and several of them make a gradient.
constexpr double of_coordinates = 32 * std::numeric_limits<double>::epsilon();

/// A cell's part of the energy (10.9).
template <int Dim, int Nodes, bool Axisymmetric>
struct RoundingEnergy {
  using Body = ElasticCells<Dim, Nodes, Axisymmetric>;

  Body body;    //                        in
  ReadVector u; // (overlap dofs)   [m]   in

  KOKKOS_FUNCTION void operator()(const LO cell, double &energy) const
  {
    double largest[2] = {}; // squares of displacements and of coordinates
    for (int a = 0; a < Nodes; ++a) {
      const LO node = body.cells(cell, a);
      double square[2] = {};
      for (int i = 0; i < Dim; ++i) {
        square[0] += u(dof(Dim, node, i)) * u(dof(Dim, node, i));
        square[1] += body.coords(node, i) * body.coords(node, i);
      }
      for (int k = 0; k < 2; ++k) largest[k] = math::fmax(largest[k], square[k]);
    }
    const double modulus = body.lambda(cell) + 2 * body.mu(cell);
    body.at_plain_points(cell, [&](int, const double volume, const typename Body::Gradients &dN) {
      typename Body::Tensor gradient;
      double turn = 0, stiffness = 0;
      body.displacement_gradient(u, cell, dN, gradient);
      for (const auto &of_node : dN)
        for (const double slope : of_node) stiffness += slope * slope;
      for (const auto &of_component : gradient)
        for (const double slope : of_component) turn += slope * slope;
      const double error = of_displacements * math::sqrt(largest[0]) + of_coordinates * math::sqrt(turn * largest[1]);
      energy += volume * modulus * stiffness * error * error;
    });
  }
};

template <int Dim, int Nodes, bool Axisymmetric>
double rounding_energy(const mesh::Mesh &mesh, const ElasticCells<Dim, Nodes, Axisymmetric> &body,
                       const Vector &u_overlap)
{
  double energy = 0;
  Kokkos::parallel_reduce("rpc::fem::rounding_energy", device_range(mesh.num_owned_cells),
                          RoundingEnergy<Dim, Nodes, Axisymmetric>{body, device_read(u_overlap)}, energy);
  return energy;
}

} // namespace

double rounding_energy(const Discretization &d, const Materials &materials, const Vector &u)
{
  const mesh::Mesh &mesh = *d.mesh;
  const auto u_overlap = on_overlap(d, u);
  double energy = 0;
  with_elastic_cells(d, materials, [&](const auto &body) { energy = rounding_energy(mesh, body, *u_overlap); });
  return sum_all(mesh.comm(), energy);
}

} // namespace rpc::fem
