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
template <int Dim, int Nodes>
struct RoundingEnergy {
  ElasticCells<Dim, Nodes> body; //                        in
  ReadVector u;                  // (overlap dofs)   [m]   in

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
    body.at_plain_points(cell, [&](int, const double volume, const double(&dN)[Nodes][Dim]) {
      double gradient[Dim][Dim] = {}, turn = 0, stiffness = 0;
      for (int a = 0; a < Nodes; ++a)
        for (int j = 0; j < Dim; ++j) {
          stiffness += dN[a][j] * dN[a][j];
          for (int i = 0; i < Dim; ++i)
            gradient[i][j] += (u(dof(Dim, body.cells(cell, a), i)) - u(dof(Dim, body.cells(cell, 0), i))) * dN[a][j];
        }
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) turn += gradient[i][j] * gradient[i][j];
      const double error = of_displacements * math::sqrt(largest[0]) + of_coordinates * math::sqrt(turn * largest[1]);
      energy += volume * modulus * stiffness * error * error;
    });
  }
};

} // namespace

double rounding_energy(const Discretization &d, const Materials &materials, const Vector &u)
{
  const mesh::Mesh &mesh = *d.mesh;
  const auto u_overlap = on_overlap(d, u);
  double energy = 0;
  with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    const RoundingEnergy<dim, nodes> kernel{elastic_cells<dim, nodes>(d, materials), device_read(*u_overlap)};
    Kokkos::parallel_reduce("rpc::fem::rounding_energy", device_range(mesh.num_owned_cells), kernel, energy);
  });
  return sum_all(mesh.comm(), energy);
}

} // namespace rpc::fem
