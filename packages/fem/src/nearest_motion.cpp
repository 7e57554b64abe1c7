// SPDX-License-Identifier: BSD-3-Clause
/// Displacements less the rigid motion that is nearest to them.
#include "rpc/core/parallel.hpp"
#include "rpc/core/sums.hpp"
#include "rpc/fem/rigid_motion.hpp"
#include "rpc/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rpc::fem
{
namespace
{

/// (6) How far each mode about `centre` moves a node along axis c.
template <class Coordinates>
KOKKOS_INLINE_FUNCTION void modes_at(const int dim, const Coordinates &coords, const LO node,
                                     const Kokkos::Array<double, 3> &centre, const double radius, const int c,
                                     double *out)
{
  double arm[3] = {0, 0, 0}, axis[3] = {0, 0, 0};
  for (int i = 0; i < dim; ++i) arm[i] = (coords(node, i) - centre[i]) / radius;
  axis[c] = 1;
  along_modes(dim, arm, axis, out);
}

/// A rigid motion about a point of a body, q of the modes there.
struct NearestMotion {
  RigidMotion q{};
  Kokkos::Array<double, 3> centre{};
  double radius = 1;
};

/// The rigid motion that is nearest to u in the mean square over some unknowns. An axisymmetric body moves along its axis only.
/// @param counts  (owned dofs) which count; empty: all do. Collective
NearestMotion nearest_motion(const Discretization &d, const DeviceView<char *> &counts, const Vector &u)
{
  NearestMotion result;
  const int dim = d.dim();
  const auto coords = d.mesh->coords;
  Kokkos::Array<double, 3> centre{};
  node_coordinates(d)->meanValue(Teuchos::ArrayView<double>(centre.data(), dim));
  const double radius = d.diameter;
  result.centre = centre;
  result.radius = radius;
  // Products of the six modes with each other and with u.
  const auto x = device_read(u);
  const auto mine = sums_over(
      "rpc::fem::products_of_modes", device_range(d.mesh->num_owned_nodes()), 6 * 7,
      KOKKOS_LAMBDA(const LO n, double sum[]) {
        for (int c = 0; c < dim; ++c) {
          const LO i = dof(dim, n, c);
          if (counts.extent(0) > 0 && !counts(i)) continue;
          double along[6];
          modes_at(dim, coords, n, centre, radius, c, along);
          for (int k = 0; k < 6; ++k) {
            for (int l = 0; l < 6; ++l) sum[7 * k + l] += along[k] * along[l];
            sum[7 * k + 6] += along[k] * x(i);
          }
        }
      });
  const std::vector<double> all = summed(d.mesh->comm(), mine);
  const auto product = [&all](const RigidMotion &a, const RigidMotion &b) {
    double sum = 0;
    for (int k = 0; k < 6; ++k)
      for (int l = 0; l < 6; ++l) sum += a[k] * all[7 * k + l] * b[l];
    return sum;
  };
  // Orthonormal motions over these unknowns; those that move none of them stay out.
  std::vector<RigidMotion> basis;
  for (RigidMotion motion : all_motions(d)) {
    const double before = product(motion, motion);
    for (const RigidMotion &unit : basis) {
      const double part = product(motion, unit);
      for (int k = 0; k < 6; ++k) motion[k] -= part * unit[k];
    }
    const double size = product(motion, motion);
    if (!(size > 1e-12 * before)) continue;
    for (double &entry : motion) entry /= std::sqrt(size);
    basis.push_back(motion);
    double part = 0;
    for (int k = 0; k < 6; ++k) part += motion[k] * all[7 * k + 6];
    for (int k = 0; k < 6; ++k) result.q[k] += part * motion[k];
  }
  return result;
}

/// x + error <- x + error + y, but for the rounding of the error: D. Knuth's two-sum.
KOKKOS_INLINE_FUNCTION void add_exactly(const double y, double &x, double &error)
{
  const double sum = x + y, of_y = sum - x, of_x = sum - of_y;
  error += (x - of_x) + (y - of_y);
  x = sum;
}

/// The same with a product.
KOKKOS_INLINE_FUNCTION void add_product_exactly(const double a, const double b, double &x, double &error)
{
  const double product = a * b;
  error += fma(a, b, -product);
  add_exactly(product, x, error);
}

} // namespace

Vector without_rigid_motion(const Discretization &d, const DirichletDofs &dirichlet, const Vector &u)
{
  const int dim = d.dim();
  const auto coords = d.mesh->coords;
  const NearestMotion nearest = nearest_motion(d, dirichlet.fixed, u);
  const auto centre = nearest.centre;
  const double radius = nearest.radius;
  Kokkos::Array<double, 6> q{};
  std::copy(nearest.q.begin(), nearest.q.end(), q.data());
  Vector rest(u, Teuchos::Copy);
  const auto x = device_write(rest);
  Kokkos::parallel_for(
      "rpc::fem::without_rigid_motion", device_range(d.mesh->num_owned_nodes()), KOKKOS_LAMBDA(const LO n) {
        for (int c = 0; c < dim; ++c) {
          double along[6];
          modes_at(dim, coords, n, centre, radius, c, along);
          for (int k = 0; k < 6; ++k) x(dof(dim, n, c)) -= q[k] * along[k];
        }
      });
  Kokkos::fence();
  return rest;
}

Vector strained_part(const Discretization &d, const Vector &u, const Vector &rest)
{
  const int dim = d.dim();
  const auto coords = d.mesh->coords;
  const NearestMotion nearest = nearest_motion(d, {}, u);
  // t + R x with an antisymmetric R: linear in x to the last digit, so that it strains nothing, whatever the rounding of t and R.
  Kokkos::Array<double, 3> t{};
  Kokkos::Array<double, 9> R{};
  int mode = dim;
  for (int i = 0; i < dim; ++i)
    for (int j = i + 1; j < dim; ++j) {
      const double turn = nearest.q[mode++] / nearest.radius;
      R[3 * j + i] = turn;
      R[3 * i + j] = -turn;
    }
  for (int i = 0; i < dim; ++i) {
    t[i] = nearest.q[i];
    for (int j = 0; j < dim; ++j) t[i] -= R[3 * i + j] * nearest.centre[j];
  }
  Vector strained(rest, Teuchos::Copy);
  const auto x = device_read(u);
  const auto to = device_write(strained);
  Kokkos::parallel_for(
      "rpc::fem::strained_part", device_range(d.mesh->num_owned_nodes()), KOKKOS_LAMBDA(const LO n) {
        for (int c = 0; c < dim; ++c) {
          const LO i = dof(dim, n, c);
          double sum = x(i), error = to(i);
          add_exactly(-t[c], sum, error);
          for (int k = 0; k < dim; ++k) add_product_exactly(-R[3 * c + k], coords(n, k), sum, error);
          to(i) = sum + error;
        }
      });
  Kokkos::fence();
  return strained;
}

} // namespace rpc::fem
