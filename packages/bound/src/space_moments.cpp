// SPDX-License-Identifier: BSD-3-Clause
#include "space_cells.hpp"

#include "cell_kinds.hpp"
#include "dense.hpp"
#include "facet_polynomials.hpp"
#include "space_contact.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rpc::bound
{
namespace
{

/// Moments at the nodes of a cell.
struct NodalForces {
  SpaceInput in;
  ReadDisplacement u;
  DeviceView<double ***> Q;

  KOKKOS_FUNCTION void operator()(const LO c) const
  {
    const int nodes = static_cast<int>(in.cells.extent(1));
    const AffineTetrahedron cell(in, c);
    for (int q = 0; q < in.stress.num_points(); ++q) {
      double D[3][3], s[3][3];
      gradient_in_space(
          in, cell, c, u, [&](const int a, const int l) { return in.stress.gradient(q, a, l); }, D);
      stress_of_gradient(in.lame(in.block(c), 0), in.lame(in.block(c), 1), D, s);
      for (int a = 0; a < nodes; ++a)
        for (int j = 0; j < 3; ++j) {
          double dN = 0;
          for (int l = 0; l < 3; ++l) dN += in.stress.gradient(q, a, l) * cell.inverse[l][j];
          for (int i = 0; i < 3; ++i) Q(c, a, i) += in.stress.weight(q) * cell.determinant * s[i][j] * dN;
        }
    }
    for (int q = 0; in.loaded() && q < in.load.num_points(); ++q)
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < 3; ++i)
          Q(c, a, i) -= in.load.weight(q) * cell.determinant * in.load.value(q, a) * in.force[i];
  }
};

/// Moments of C eps(u) with the functions of a facet's nodes, their mean over both cells.
struct MeanMoments {
  SpaceInput in;
  ReadDisplacement u;
  Tractions mean;

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    if (!in.facets.is_whole(f)) return;
    const int both = in.facets.on_boundary(f) ? 1 : 2, nodes = static_cast<int>(in.facets.node.extent(1));
    double *const own = mean.data() + static_cast<std::size_t>(f) * nodes * 3;
    double e[2][3], n[3];
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < 3; ++i) e[k][i] = in.coords(in.facets.node(f, k + 1), i) - in.coords(in.facets.node(f, 0), i);
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      n[i] = (e[0][a] * e[1][b] - e[0][b] * e[1][a]) / 2;
    }
    const LO first = in.facets.cell(f, 0);
    double toward = 0; // the normal of the first cell
    for (int i = 0; i < 3; ++i)
      toward += n[i] * (in.coords(in.facets.node(f, 0), i) - in.coords(in.cells(first, in.facets.ordinal(f, 0)), i));
    for (int side = 0; side < both; ++side) {
      const LO c = in.facets.cell(f, side);
      const int s = in.facets.ordinal(f, side);
      const AffineTetrahedron cell(in, c);
      double D[3][3], sigma[3][3];
      if (in.reference.degree == 1) { // C eps is constant
        gradient_in_space(
            in, cell, c, u, [&](const int a, const int l) { return in.reference.side_gradient(s, 0, a, l); }, D);
        stress_of_gradient(in.lame(in.block(c), 0), in.lame(in.block(c), 1), D, sigma);
        for (int i = 0; i < 3; ++i) {
          const double t = sigma[i][0] * n[0] + sigma[i][1] * n[1] + sigma[i][2] * n[2];
          for (int a = 0; a < nodes; ++a) own[3 * a + i] += in.tables.moment(0, a) / both * (toward > 0 ? 1 : -1) * t;
        }
        continue;
      }
      for (int q = 0; q < static_cast<int>(in.tables.shape.extent(0)); ++q) {
        gradient_in_space(
            in, cell, c, u, [&](const int a, const int l) { return in.reference.side_gradient(s, q, a, l); }, D);
        stress_of_gradient(in.lame(in.block(c), 0), in.lame(in.block(c), 1), D, sigma);
        const double w = in.reference.side_weight(q) / both * (toward > 0 ? 1 : -1);
        for (int a = 0; a < nodes; ++a)
          for (int i = 0; i < 3; ++i)
            own[3 * a + i] +=
                w * in.tables.shape(q, a) * (sigma[i][0] * n[0] + sigma[i][1] * n[1] + sigma[i][2] * n[2]);
      }
    }
  }
};

/// Norms of stresses that lift the loads beyond the degree of the stresses.
struct LiftedInSpace {
  SpaceInput in;
  LiftedLoads lifted;
  DeviceView<double ***> load;
  int own, all;
  static constexpr int most = 4 * 10 * 3; // coefficients of degree 3

  KOKKOS_FUNCTION void operator()(const LO c, double &sum) const
  {
    const int beyond = all - own;
    double x[most] = {}, S[6][6];
    bool any = false;
    const AffineTetrahedron cell(in, c);
    for (int s = 0; s < 4; ++s) {
      const LO f = in.facets.of_cell(c, s);
      if (!in.facets.on_boundary(f)) continue;
      for (int j = 0; j < beyond; ++j)
        for (int i = 0; i < 3; ++i) {
          const int at = (s * beyond + j) * 3 + i;
          for (int l = 0; l < 3; ++l) x[at] += cell.inverse[i][l] * load(f, own + j, l);
          any = any || x[at] != 0;
        }
    }
    if (!any) return;
    compliance_of_images(in, cell, c, S);
    int pair = 0;
    for (int p = 0; p < 6; ++p) sum += S[p][p] * squared(pair++, x);
    for (int p = 0; p < 6; ++p)
      for (int q = p + 1; q < 6; ++q) sum += S[p][q] * squared(pair++, x);
  }
  KOKKOS_FUNCTION double squared(const int pair, const double *x) const
  {
    double sum = 0;
    for (int i = 0; i < lifted.columns; ++i)
      for (int j = 0; j < lifted.columns; ++j) sum += x[i] * lifted.energy(pair, i, j) * x[j];
    return sum;
  }
};

} // namespace

FacetTables facet_tables(const int order)
{
  const FacetPolynomials polynomials(3, order);
  const FacetRule rule = facet_rule(3, order + 2), points = facet_rule(3, 3);
  const int n = polynomials.size();
  const auto shape = [&](const int a, const Barycentric &at) {
    if (order == 1) return at[a];
    if (a < 3) return at[a] * (2 * at[a] - 1);
    return 4 * at[a == 4 ? 1 : 0] * at[a == 3 ? 1 : 2];
  };
  Dense moment(n, n), back(n, n);
  FacetTables t;
  t.moment = DeviceView<double **>("rpc::bound::moment", n, n);
  t.from_moments = DeviceView<double **>("rpc::bound::from_moments", n, n);
  t.bernstein = DeviceView<double **>("rpc::bound::bernstein", n, n);
  t.linear = DeviceView<double **>("rpc::bound::linear", 3, 3);
  t.shape = DeviceView<double **>("rpc::bound::shape", points.size(), n);
  const auto means = Kokkos::create_mirror_view(t.moment), inverse = Kokkos::create_mirror_view(t.from_moments),
             linear = Kokkos::create_mirror_view(t.linear), bernstein = Kokkos::create_mirror_view(t.bernstein),
             values = Kokkos::create_mirror_view(t.shape);
  for (int q = 0; q < rule.size(); ++q)
    for (int j = 0; j < n; ++j) {
      const double weighted = rule.weight[q] * polynomials(j, rule.point[q]);
      for (int a = 0; a < n; ++a) {
        OfTriangle own{};
        own[a] = 1;
        bernstein(j, a) += weighted * value_of(order, own, rule.point[q]);
        moment(j, a) += weighted * shape(a, rule.point[q]);
      }
      for (int v = 0; v < 3 && j < 3; ++v) linear(j, v) += weighted * rule.point[q][v];
    }
  back = kernel_of(transposed(moment)).inverse; // of moments m_a = sum_j moment(j, a) t_j
  for (int j = 0; j < n; ++j)
    for (int a = 0; a < n; ++a) {
      means(j, a) = moment(j, a);
      inverse(j, a) = back(j, a);
    }
  for (int q = 0; q < points.size(); ++q)
    for (int a = 0; a < n; ++a) values(q, a) = shape(a, points.point[q]);
  Kokkos::deep_copy(t.moment, means);
  Kokkos::deep_copy(t.from_moments, inverse);
  Kokkos::deep_copy(t.linear, linear);
  Kokkos::deep_copy(t.bernstein, bernstein);
  Kokkos::deep_copy(t.shape, values);
  return t;
}

void find_kinds(SpaceInput &in, const Comm &comm)
{
  const Kinds kinds = kinds_of_cells(comm, in.coords, in.cells, in.block, 4);
  in.kind = kinds.kind;
  in.example = kinds.example;
}

double norm_of_lifted_loads(const SpaceInput &in, const Comm &comm, const LiftedLoads &lifted,
                            const DeviceView<double ***> &load)
{
  double squared = 0;
  Kokkos::parallel_reduce("rpc::bound::lifted_loads", device_range(in.num_owned_cells),
                          LiftedInSpace{in, lifted, load, FacetPolynomials::count(3, in.reference.degree),
                                        FacetPolynomials::count(3, ReferenceStress::degree_of_loads_in_space)},
                          squared);
  return std::sqrt(std::max(sum_all(comm, squared), 0.));
}

DeviceView<double ***> nodal_forces(const SpaceInput &in, const fem::Discretization &, const Vector &u)
{
  DeviceView<double ***> Q("rpc::bound::nodal_forces", in.num_cells(), in.cells.extent(1), 3);
  Kokkos::parallel_for("rpc::bound::nodal_forces", device_range(in.num_cells()), NodalForces{in, device_read(u), Q});
  Kokkos::fence();
  return Q;
}

Tractions mean_moments(const SpaceInput &in, const Vector &u)
{
  Tractions mean("rpc::bound::mean_moments", 3 * in.facets.size() * in.facets.node.extent(1));
  Kokkos::parallel_for("rpc::bound::mean_moments", device_range(in.facets.size()),
                       MeanMoments{in, device_read(u), mean});
  Kokkos::fence();
  return mean;
}

double largest_distortion(const SpaceInput &in, const mesh::Element &element)
{
  double largest = 0;
  if (element.order == 1) return largest;
  DeviceView<int *[2]> ends("rpc::bound::ends", in.cells.extent(1));
  const auto host = Kokkos::create_mirror_view(ends);
  for (const auto &edge : element.edges())
    for (int k = 0; k < 2; ++k) host(edge[2], k) = edge[k];
  Kokkos::deep_copy(ends, host);
  Kokkos::parallel_reduce(
      "rpc::bound::distortion", device_range(in.num_cells()),
      KOKKOS_LAMBDA(const LO c, double &most) {
        for (int m = 4; m < 10; ++m)
          for (int i = 0; i < 3; ++i) {
            const double a = in.coords(in.cells(c, ends(m, 0)), i), b = in.coords(in.cells(c, ends(m, 1)), i);
            double size = 0;
            for (int k = 0; k < 3; ++k)
              size = math::fmax(
                  size, math::magnitude(in.coords(in.cells(c, ends(m, 0)), k) - in.coords(in.cells(c, ends(m, 1)), k)));
            most = math::fmax(most, math::magnitude(in.coords(in.cells(c, m), i) - (a + b) / 2) / size);
          }
      },
      Kokkos::Max<double>(largest));
  return largest;
}

} // namespace rpc::bound
