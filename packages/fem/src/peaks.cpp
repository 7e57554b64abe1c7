// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/peaks.hpp"

#include "elastic_cells.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::fem
{
namespace
{

using Strain = double[3][3];

/// The largest eigenvalue in size of a symmetric matrix, by the trigonometric solution of its characteristic equation.
KOKKOS_INLINE_FUNCTION double largest_principal(const Strain &e)
{
  const double mean = (e[0][0] + e[1][1] + e[2][2]) / 3;
  const double x = e[0][0] - mean, y = e[1][1] - mean, z = e[2][2] - mean;
  const double yz = e[1][2], zx = e[0][2], xy = e[0][1];
  const double spread = math::sqrt((x * x + y * y + z * z + 2 * (yz * yz + zx * zx + xy * xy)) / 6);
  if (!(spread > 0)) return math::magnitude(mean);
  const double determinant = x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx);
  const double cosine = math::fmax(-1., math::fmin(1., determinant / (2 * spread * spread * spread)));
  constexpr double third_of_circle = 2.0943951023931953;
  const double angle = math::acos(cosine) / 3; // in [0, 60 degrees]
  const double greatest = mean + 2 * spread * math::cos(angle);
  const double least = mean + 2 * spread * math::cos(angle + third_of_circle);
  return math::fmax(math::magnitude(greatest), math::magnitude(least));
}

/// Largest strain and stress in a cell.                                                            doc/theory.md (2.15)
template <int Dim, int Nodes, bool Axisymmetric>
struct PeaksOfCell {
  using Body = ElasticCells<Dim, Nodes, Axisymmetric>;

  Body body;    //                       in
  ReadVector u; // (overlap dofs)  [m]   in

  /// @param strain     largest principal strain in size, inout
  /// @param von_mises  [Pa] inout
  KOKKOS_FUNCTION void operator()(const LO cell, double &strain, double &von_mises) const
  {
    const double lambda = body.lambda(cell), mu = body.mu(cell);
    double largest_strain = math::fmax(strain, 0.), largest_stress = math::fmax(von_mises, 0.);
    body.at_plain_points(cell, [&](int, double, const typename Body::Gradients &dN) {
      typename Body::Tensor grad;
      body.displacement_gradient(u, cell, dN, grad);
      Strain e = {};
      for (int i = 0; i < Body::columns; ++i)
        for (int j = 0; j < Body::columns; ++j) e[i][j] = 0.5 * (grad[i][j] + grad[j][i]);
      if (Dim == 2 && body.plane_stress) e[2][2] = -lambda / (2 * mu) * (e[0][0] + e[1][1]);
      const double mean = (e[0][0] + e[1][1] + e[2][2]) / 3;
      double deviator = 0; // its square
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const double entry = e[i][j] - (i == j ? mean : 0);
          deviator += entry * entry;
        }
      // The norm bounds the principal strains: few points need their roots. A NaN is larger than all.
      if (!(deviator + 3 * mean * mean <= largest_strain * largest_strain))
        largest_strain = math::larger(largest_strain, largest_principal(e));
      if (!(6 * mu * mu * deviator <= largest_stress * largest_stress))
        largest_stress = math::larger(largest_stress, 2 * mu * math::sqrt(1.5 * deviator));
    });
    strain = largest_strain;
    von_mises = largest_stress;
  }
};

/// Length of the longest displacement among this rank's nodes [m].
double largest_displacement(const Discretization &d, const Vector &u)
{
  const auto values = device_read(u);
  const int dim = d.dim();
  double square = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::largest_displacement", device_range(d.mesh->num_owned_nodes()),
      KOKKOS_LAMBDA(const LO node, double &largest) {
        double sum = 0;
        for (int i = 0; i < dim; ++i) sum += values(dof(dim, node, i)) * values(dof(dim, node, i));
        largest = math::larger(largest, sum);
      },
      Kokkos::Max<double>(square));
  return std::sqrt(std::max(square, 0.)); // a rank without nodes has the least number
}

template <int Dim, int Nodes, bool Axisymmetric>
void find_peaks(const Discretization &d, const ElasticCells<Dim, Nodes, Axisymmetric> &body, const Vector &u_overlap,
                BodyPeaks &peaks)
{
  const PeaksOfCell<Dim, Nodes, Axisymmetric> kernel{body, device_read(u_overlap)};
  Kokkos::parallel_reduce("rpc::fem::body_peaks", device_range(d.mesh->num_owned_cells), kernel,
                          Kokkos::Max<double>(peaks.strain), Kokkos::Max<double>(peaks.von_mises));
  Kokkos::fence();
}

} // namespace

BodyPeaks body_peaks(const Discretization &d, const Materials &materials, const Vector &u)
{
  BodyPeaks peaks{largest_displacement(d, u), 0, 0};
  const auto u_overlap = on_overlap(d, u);
  with_elastic_cells(d, materials, [&](const auto &body) { find_peaks(d, body, *u_overlap, peaks); });
  const Comm &comm = d.mesh->comm();
  for (double *const peak : {&peaks.displacement, &peaks.strain, &peaks.von_mises})
    *peak = max_all(comm, std::max(*peak, 0.));
  return peaks;
}

} // namespace rpc::fem
