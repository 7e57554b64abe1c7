// SPDX-License-Identifier: BSD-3-Clause
#include "hexahedra.hpp"

#include "facet_polynomials.hpp"
#include "rpc/mesh/quadrature.hpp"

namespace rpc::bound
{
namespace
{

/// Forces of the vertices on the tetrahedra of a cell. Stresses are constant on each, as near as can be to the mean of the cell's there, and come to
/// the cell's own forces: they differ from these means by those of a displacement of the vertices, which is what the forces that lack make of a
/// cell by itself.
struct ForcesOfHexahedra {
  HexahedraInput in;
  FieldOfHexahedra field;
  DeviceView<double ***> Q;
  static constexpr int size = 24;

  /// A tetrahedron: derivatives of its barycentric coordinates, its volume and its vertices in the hexahedron.
  struct Part {
    double slope[4][3], volume;
    int vertex[4];
  };

  KOKKOS_FUNCTION void operator()(const LO h) const
  {
    const LO first = 6 * h;
    const double lambda = in.lame(in.block(first), 0), mu = in.lame(in.block(first), 1);
    double force[size] = {}, K[size][size], sigma[6][3][3];
    own_forces(h, lambda, mu, force);
    for (int i = 0; i < size; ++i) force[i] += in.shift(h, i);
    for (auto &row : K)
      for (double &k : row) k = 0;
    Part part[6];
    for (int t = 0; t < 6; ++t) {
      const LO c = first + t;
      const AffineTetrahedron cell(in, c);
      Part &p = part[t];
      p.volume = cell.determinant / 6;
      for (int j = 0; j < 3; ++j) {
        p.slope[0][j] = 0;
        for (int l = 0; l < 3; ++l) {
          p.slope[l + 1][j] = cell.inverse[l][j];
          p.slope[0][j] -= cell.inverse[l][j];
        }
      }
      for (int v = 0; v < 4; ++v) p.vertex[v] = in.corner(c, v);
      mean_stress(cell, c, lambda, mu, sigma[t]);
      for (int a = 0; a < 4; ++a)
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) force[3 * p.vertex[a] + i] -= p.volume * sigma[t][i][j] * p.slope[a][j];
          for (int b = 0; b < 4; ++b)
            for (int j = 0; j < 3; ++j) {
              double k = lambda * p.slope[a][i] * p.slope[b][j] + mu * p.slope[a][j] * p.slope[b][i];
              for (int d = 0; i == j && d < 3; ++d) k += mu * p.slope[a][d] * p.slope[b][d];
              K[3 * p.vertex[a] + i][3 * p.vertex[b] + j] += p.volume * k;
            }
        }
    }
    hold(h, K);
    solve(K, force);
    for (int t = 0; t < 6; ++t) {
      const Part &p = part[t];
      double D[3][3] = {}, more[3][3];
      for (int a = 0; a < 4; ++a)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) D[i][j] += force[3 * p.vertex[a] + i] * p.slope[a][j];
      stress_of_gradient(lambda, mu, D, more);
      for (int a = 0; a < 4; ++a)
        for (int i = 0; i < 3; ++i) {
          double sum = -in.force[i] / 4;
          for (int j = 0; j < 3; ++j) sum += (sigma[t][i][j] + more[i][j]) * p.slope[a][j];
          Q(first + t, a, i) = p.volume * sum;
        }
    }
  }
  /// Those of the run's stiffness.
  KOKKOS_FUNCTION void own_forces(const LO h, const double lambda, const double mu, double (&force)[size]) const
  {
    for (int q = 0; q < in.stiffness.num_points(); ++q) {
      double J[3][3] = {}, H[3][3] = {}, inverse[3][3], D[3][3], s[3][3];
      for (int a = 0; a < 8; ++a)
        for (int i = 0; i < 3; ++i)
          for (int l = 0; l < 3; ++l) {
            const double g = in.stiffness.gradient(q, a, l);
            J[i][l] += in.coords(in.hexahedra(h, a), i) * g;
            H[i][l] += field.u(dof(3, in.hexahedra(h, a), i)) * g;
          }
      double determinant = 0;
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < 3; ++l) {
          const int a = (i + 1) % 3, b = (i + 2) % 3, c = (l + 1) % 3, d = (l + 2) % 3;
          inverse[l][i] = J[a][c] * J[b][d] - J[a][d] * J[b][c];
          if (i == 0) determinant += J[0][l] * inverse[l][0];
        }
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          inverse[i][j] /= determinant;
        }
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          D[i][j] = H[i][0] * inverse[0][j] + H[i][1] * inverse[1][j] + H[i][2] * inverse[2][j];
      stress_of_gradient(lambda, mu, D, s);
      for (int a = 0; a < 8; ++a)
        for (int j = 0; j < 3; ++j) {
          double slope = 0;
          for (int l = 0; l < 3; ++l) slope += in.stiffness.gradient(q, a, l) * inverse[l][j];
          for (int i = 0; i < 3; ++i) force[3 * a + i] += in.stiffness.weight(q) * determinant * s[i][j] * slope;
        }
    }
  }
  /// Four points are exact: derivatives are of degree 2.
  KOKKOS_FUNCTION void mean_stress(const AffineTetrahedron &cell, const LO c, const double lambda, const double mu,
                                   double (&sigma)[3][3]) const
  {
    const double near = (5 + 3 * math::sqrt(5.)) / 20, far = (5 - math::sqrt(5.)) / 20;
    const FieldOfHexahedra::Here here(field, cell, c);
    double mean[3][3] = {}, D[3][3];
    for (int q = 0; q < 4; ++q) {
      double at[4] = {far, far, far, far};
      at[q] = near;
      here.gradient(at, D);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) mean[i][j] += D[i][j] / 4;
    }
    stress_of_gradient(lambda, mu, mean, sigma);
  }
  /// Rigid motions cost as much as others: forces in balance make none.
  KOKKOS_FUNCTION void hold(const LO h, double (&K)[size][size]) const
  {
    double centre[3] = {}, spread = 0, mean = 0;
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) centre[i] += in.coords(in.hexahedra(h, a), i) / 8;
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) {
        const double off = in.coords(in.hexahedra(h, a), i) - centre[i];
        spread += off * off / 8;
      }
    for (int i = 0; i < size; ++i) mean += K[i][i] / size;
    for (int mode = 0; mode < 6; ++mode) {
      double r[size];
      for (int a = 0; a < 8; ++a)
        for (int i = 0; i < 3; ++i) {
          const int axis = mode % 3;
          const double turn =
              i == (axis + 1) % 3   ? in.coords(in.hexahedra(h, a), (axis + 2) % 3) - centre[(axis + 2) % 3]
              : i == (axis + 2) % 3 ? centre[(axis + 1) % 3] - in.coords(in.hexahedra(h, a), (axis + 1) % 3)
                                    : 0;
          r[3 * a + i] = mode < 3 ? (i == axis ? 1 : 0) : turn / math::sqrt(spread);
        }
      for (int i = 0; i < size; ++i)
        for (int j = 0; j < size; ++j) K[i][j] += mean * r[i] * r[j] / 8;
    }
  }
  /// x <- K^-1 x by Cholesky's factor.
  KOKKOS_FUNCTION static void solve(double (&K)[size][size], double (&x)[size])
  {
    for (int j = 0; j < size; ++j) {
      for (int i = j; i < size; ++i)
        for (int k = 0; k < j; ++k) K[i][j] -= K[i][k] * K[j][k];
      const double pivot = math::sqrt(K[j][j]);
      for (int i = j; i < size; ++i) K[i][j] /= pivot;
    }
    for (int i = 0; i < size; ++i) {
      for (int k = 0; k < i; ++k) x[i] -= K[i][k] * x[k];
      x[i] /= K[i][i];
    }
    for (int i = size - 1; i >= 0; --i) {
      for (int k = i + 1; k < size; ++k) x[i] -= K[k][i] * x[k];
      x[i] /= K[i][i];
    }
  }
};

/// Moments of C eps with the functions of a facet's vertices, their mean over both sides.
struct MeanMomentsOfHexahedra {
  HexahedraInput in;
  FieldOfHexahedra field;
  Tractions mean; // (facets * 9)

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    if (!in.facets.is_whole(f)) return;
    const int both = in.facets.on_boundary(f) ? 1 : 2;
    double e[2][3], n[3], toward = 0;
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < 3; ++i) e[k][i] = in.coords(in.facets.node(f, k + 1), i) - in.coords(in.facets.node(f, 0), i);
    const LO first = in.facets.cell(f, 0);
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      n[i] = (e[0][a] * e[1][b] - e[0][b] * e[1][a]) / 2;
      toward += n[i] * (in.coords(in.facets.node(f, 0), i) - in.coords(in.cells(first, in.facets.ordinal(f, 0)), i));
    }
    for (int side = 0; side < both; ++side) {
      const LO c = in.facets.cell(f, side);
      const int s = in.facets.ordinal(f, side);
      const AffineTetrahedron cell(in, c);
      const FieldOfHexahedra::Here here(field, cell, c);
      for (int q = 0; q < static_cast<int>(in.facet_weight.extent(0)); ++q) {
        double at[4] = {}, D[3][3], sigma[3][3];
        for (int v = 0, k = 0; v < 4; ++v)
          if (v != s) at[v] = in.on_facet(q, k++);
        here.gradient(at, D);
        stress_of_gradient(in.lame(in.block(c), 0), in.lame(in.block(c), 1), D, sigma);
        const double w = in.facet_weight(q) / both * (toward > 0 ? 1 : -1);
        for (int a = 0; a < 3; ++a)
          for (int i = 0; i < 3; ++i)
            mean((static_cast<std::size_t>(f) * 3 + a) * 3 + i) +=
                w * in.on_facet(q, a) * (sigma[i][0] * n[0] + sigma[i][1] * n[1] + sigma[i][2] * n[2]);
      }
    }
  }
};

} // namespace

void tabulate_points(HexahedraInput &in)
{
  const mesh::QuadratureRule rule = mesh::quadrature(3, mesh::Shape::simplex, 4), // squares of derivatives
      on_facets = mesh::quadrature(2, mesh::Shape::simplex, 3); // derivatives and a function of a vertex
  const int points = rule.num_points();
  in.at = DeviceView<double ***>("rpc::bound::at", 4, points, 4);
  in.reference.value = DeviceView<double ***>("rpc::bound::value", 4, points, 4);
  in.reference.weight = DeviceView<double **>("rpc::bound::weight", 4, points);
  in.in_whole = DeviceView<double **>("rpc::bound::in_whole", points, 4);
  in.whole_weight = DeviceView<double *>("rpc::bound::whole_weight", points);
  const auto at = Kokkos::create_mirror_view(in.at);
  const auto value = Kokkos::create_mirror_view(in.reference.value);
  const auto weight = Kokkos::create_mirror_view(in.reference.weight);
  const auto in_whole = Kokkos::create_mirror_view(in.in_whole);
  const auto whole = Kokkos::create_mirror_view(in.whole_weight);
  for (int q = 0; q < points; ++q) {
    const auto &x = rule.point[q];
    const double last = 1 - x[0] - x[1] - x[2];
    for (int v = 0; v < 3; ++v) in_whole(q, v) = x[v];
    in_whole(q, 3) = last;
    whole(q) = rule.weight[q];
    for (int s = 0; s < 4; ++s) { // the part's last corner is the centre
      for (int v = 0, k = 0; v < 4; ++v) at(s, q, v) = last / 4 + (v == s ? 0 : x[k++]);
      weight(s, q) = rule.weight[q] / 4;
      value(s, q, 0) = 1;
      for (int l = 0; l < 3; ++l) value(s, q, 1 + l) = at(s, q, l + 1) - 0.25;
    }
  }
  Kokkos::deep_copy(in.in_whole, in_whole);
  Kokkos::deep_copy(in.whole_weight, whole);
  Kokkos::deep_copy(in.at, at);
  Kokkos::deep_copy(in.reference.value, value);
  Kokkos::deep_copy(in.reference.weight, weight);
  in.on_facet = DeviceView<double **>("rpc::bound::on_facet", on_facets.num_points(), 3);
  in.facet_weight = DeviceView<double *>("rpc::bound::facet_weight", on_facets.num_points());
  const auto on_facet = Kokkos::create_mirror_view(in.on_facet);
  const auto weights = Kokkos::create_mirror_view(in.facet_weight);
  for (int q = 0; q < on_facets.num_points(); ++q) {
    for (int v = 0; v < 2; ++v) on_facet(q, v) = on_facets.point[q][v];
    on_facet(q, 2) = 1 - on_facet(q, 0) - on_facet(q, 1);
    weights(q) = 2 * on_facets.weight[q];
  }
  Kokkos::deep_copy(in.on_facet, on_facet);
  Kokkos::deep_copy(in.facet_weight, weights);
  const FacetPolynomials polynomials(3, ReferenceStress::degree_of_loads_in_space);
  const FacetRule products = facet_rule(3, 4);
  in.of_edge = DeviceView<double **>("rpc::bound::of_edge", polynomials.size(), 3);
  const auto of_edge = Kokkos::create_mirror_view(in.of_edge);
  for (int j = 0; j < polynomials.size(); ++j)
    for (int e = 0; e < 3; ++e)
      for (int q = 0; q < products.size(); ++q) {
        const Barycentric &x = products.point[q];
        of_edge(j, e) += products.weight[q] * polynomials(j, x) * x[e == 1 ? 1 : 0] * x[e == 0 ? 1 : 2];
      }
  Kokkos::deep_copy(in.of_edge, of_edge);
}

FieldOfHexahedra field_of_hexahedra(const HexahedraInput &in, const Vector &u)
{
  return {in, device_read(u), device_read(u), true};
}

WorkOfHexahedra work_of_hexahedra(const HexahedraInput &in, const Comm &comm, const FieldOfHexahedra &u)
{
  WorkOfHexahedra work;
  Kokkos::parallel_reduce(
      "rpc::bound::work_of_hexahedra", device_range(in.num_owned_cells),
      KOKKOS_LAMBDA(const LO c, double &energy, double &of_force) {
        const AffineTetrahedron cell(in, c);
        const double lambda = in.lame(in.block(c), 0), mu = in.lame(in.block(c), 1);
        const FieldOfHexahedra::Here here(u, cell, c);
        for (int q = 0; q < static_cast<int>(in.whole_weight.extent(0)); ++q) {
          const double at[4] = {in.in_whole(q, 0), in.in_whole(q, 1), in.in_whole(q, 2), in.in_whole(q, 3)};
          double value[3] = {}, D[3][3], sigma[3][3];
          if (in.loaded()) here.value(at, value);
          here.gradient(at, D);
          stress_of_gradient(lambda, mu, D, sigma);
          const double w = in.whole_weight(q) * cell.determinant;
          for (int i = 0; i < 3; ++i) {
            of_force += w * in.force[i] * value[i];
            for (int j = 0; j < 3; ++j) energy += w * sigma[i][j] * D[i][j] / 2;
          }
        }
      },
      work.energy, work.of_body_force);
  return {sum_all(comm, work.energy), sum_all(comm, work.of_body_force)};
}

DeviceView<double ***> nodal_forces(const HexahedraInput &in, const fem::Discretization &, const Vector &u)
{
  DeviceView<double ***> Q("rpc::bound::nodal_forces", in.num_cells(), 4, 3);
  FieldOfHexahedra field = field_of_hexahedra(in, u);
  field.flattened = false;
  Kokkos::parallel_for("rpc::bound::forces_of_hexahedra", device_range(in.num_hexahedra()),
                       ForcesOfHexahedra{in, field, Q});
  Kokkos::fence();
  return Q;
}

Tractions mean_moments(const HexahedraInput &in, const Vector &u)
{
  const Tractions mean("rpc::bound::mean_moments", static_cast<std::size_t>(in.facets.size()) * 9);
  FieldOfHexahedra field = field_of_hexahedra(in, u);
  field.flattened = false;
  Kokkos::parallel_for("rpc::bound::mean_moments_of_hexahedra", device_range(in.facets.size()),
                       MeanMomentsOfHexahedra{in, field, mean});
  Kokkos::fence();
  return mean;
}

} // namespace rpc::bound
