// SPDX-License-Identifier: BSD-3-Clause
#include "cells.hpp"

#include "revolution_cells.hpp"
#include "revolution_energy.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

using ReadU = decltype(device_read(std::declval<const Vector &>()));

/// Second and first derivatives of the energy of a kind of cells by its tractions.
struct MakeForms {
  CellInput in;
  CellForms out;

  KOKKOS_FUNCTION void operator()(const LO kind) const
  {
    const LO c = in.example(kind);
    const ReferenceStress &r = in.reference;
    const int nt = r.tractions, n = r.columns();
    const AffineCell cell(in, c);
    CellEnergy e(in, cell, c, 0);
    e.factor_inner(nt, n);
    double of_tractions[ReferenceStress::most_tractions][ReferenceStress::most_tractions];
    // Rows of A and the force's part without inner stresses: those are at their best.
    double x[ReferenceStress::most_columns];
    for (int j = 0; j <= nt; ++j) { // the last column is that of the force
      for (int i = nt; i < n; ++i) x[i] = j < nt ? e.A[j][i] : e.of_force[i];
      e.solve_inner(nt, n, x);
      for (int i = 0; i < nt; ++i) {
        double sum = 0;
        for (int z = nt; z < n; ++z) sum += e.A[i][z] * x[z];
        if (j < nt)
          of_tractions[i][j] = e.A[i][j] - sum;
        else
          e.of_force[i] -= sum;
      }
    }
    // From reference tractions to those of the facets: t^ = F^-1 t.
    const auto &G = cell.inverse;
    for (int p = 0; p < nt / 2; ++p)
      for (int q = 0; q <= p; ++q) {
        double half[2][2]; // A G
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j)
            half[i][j] = of_tractions[2 * p + i][2 * q] * G[0][j] + of_tractions[2 * p + i][2 * q + 1] * G[1][j];
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2 && 2 * q + j <= 2 * p + i; ++j)
            out.A(kind, row_of_triangle(2 * p + i) + 2 * q + j) = G[0][i] * half[0][j] + G[1][i] * half[1][j];
      }
    if (in.force[0] == 0 && in.force[1] == 0) return;
    double tau[ReferenceStress::most_tractions];
    tractions_of_force(in, cell, c, tau);
    for (int p = 0; p < nt; ++p) {
      const int of = p / 2 * 2;
      double sum = G[0][p % 2] * e.of_force[of] + G[1][p % 2] * e.of_force[of + 1];
      for (int q = 0; q < nt; ++q) sum -= out.second(kind, p, q) * tau[q];
      out.b(kind, p) = sum;
    }
  }
};

/// The traction coefficients of a cell, outward.
KOKKOS_INLINE_FUNCTION void read_tractions(const CellInput &in, const Tractions &t, const LO c, double *x)
{
  const int per_facet = 2 * (in.reference.degree + 1);
  for (int s = 0; s < in.reference.sides; ++s)
    for (int q = 0; q < per_facet; ++q)
      x[s * per_facet + q] = side_factor(in.facets.sign(c, s), q / 2) * t(in.facets.of_cell(c, s) * per_facet + q);
}

/// Energy and balance of the stress of a cell.
struct Difference {
  CellInput in;
  ReadU u;
  Tractions t;
  DeviceView<double *> of_cell;
  int order;

  /// C eps(u) at a point: dN_a / dX in the cell.
  KOKKOS_FUNCTION void stress_of_displacement(const AffineCell &cell, const LO c, const int s, const int q,
                                              double (&sigma)[3]) const
  {
    double H[2][2] = {}; // du_i / dX_l
    for (int a = 0; a < static_cast<int>(in.cells.extent(1)); ++a)
      for (int i = 0; i < 2; ++i)
        for (int l = 0; l < 2; ++l) H[i][l] += u(dof(2, in.cells(c, a), i)) * in.reference.gradient(s, q, a, l);
    double D[2][2] = {};
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int l = 0; l < 2; ++l) D[i][j] += H[i][l] * cell.inverse[l][j];
    const double lambda = in.lame(in.block(c), 0), mu = in.lame(in.block(c), 1), trace = D[0][0] + D[1][1];
    sigma[0] = lambda * trace + 2 * mu * D[0][0];
    sigma[1] = lambda * trace + 2 * mu * D[1][1];
    sigma[2] = mu * (D[0][1] + D[1][0]);
  }

  /// @param balance  largest force, or moment by the size of the cell, that is left   @param force  largest on a side
  KOKKOS_FUNCTION void judge_balance(const LO c, const double *x, const AffineCell &cell, double &imbalance,
                                     double &force) const
  {
    const int k = in.reference.degree, sides = in.reference.sides;
    const double area = cell.determinant * (sides == 3 ? 0.5 : 4);
    double sum[3] = {in.force[0] * area, in.force[1] * area, 0}, size = 0;
    for (int s = 0; s < sides; ++s) {
      double e[2], middle[2];
      for (int i = 0; i < 2; ++i) {
        const double a = in.coords(in.cells(c, s), i), b = in.coords(in.cells(c, (s + 1) % sides), i);
        e[i] = b - a;
        middle[i] = (a + b) / 2 - cell.centre[i];
      }
      const double *const t0 = x + s * 2 * (k + 1), *const t1 = t0 + 2;
      sum[0] += t0[0];
      sum[1] += t0[1];
      sum[2] += middle[0] * t0[1] - middle[1] * t0[0] + (e[0] * t1[1] - e[1] * t1[0]) / 6;
      size = math::fmax(size, e[0] * e[0] + e[1] * e[1]);
      for (int i = 0; i < 2; ++i) force = math::fmax(force, math::magnitude(t0[i]) + math::magnitude(t1[i]));
    }
    imbalance = math::fmax(math::fmax(math::magnitude(sum[0]), math::magnitude(sum[1])),
                           math::magnitude(sum[2]) / math::sqrt(size));
  }

  KOKKOS_FUNCTION void operator()(const LO c, double &sum, double &imbalance, double &force) const
  {
    const ReferenceStress &r = in.reference;
    const int nt = r.tractions, n = r.columns(), nm = r.monomials;
    const AffineCell cell(in, c);
    CellEnergy e(in, cell, c, nt);
    double x[ReferenceStress::most_columns], tau[ReferenceStress::most_tractions];
    read_tractions(in, t, c, x);
    double off = 0;
    judge_balance(c, x, cell, off, force);
    imbalance = math::fmax(imbalance, off);
    tractions_of_force(in, cell, c, tau);
    for (int p = 0; p < nt / 2; ++p) {
      const double y[2] = {x[2 * p] - tau[2 * p], x[2 * p + 1] - tau[2 * p + 1]};
      for (int i = 0; i < 2; ++i) x[2 * p + i] = cell.inverse[i][0] * y[0] + cell.inverse[i][1] * y[1];
    }
    for (int z = nt; z < n; ++z) {
      x[z] = -e.of_force[z];
      for (int i = 0; i < nt; ++i) x[z] -= e.A[z][i] * x[i];
    }
    e.factor_inner(nt, n);
    e.solve_inner(nt, n, x);
    double S[3][3], T[3][3];
    compliance(in.lame(in.block(c), 0), in.lame(in.block(c), 1), S);
    cell.stress_map(T);
    double energy = 0;
    for (int s = 0; s < r.sides; ++s) {
      double coefficient[3][16] = {};
      for (int component = 0; component < 3; ++component)
        for (int m = 0; m < nm; ++m) {
          double value = m == 1 || m == 2 ? e.force_stress[m - 1][component] : 0;
          for (int i = 0; i < n; ++i) value += r.stress((s * 3 + component) * nm + m, i) * x[i];
          coefficient[component][m] = value;
        }
      for (int q = 0; q < static_cast<int>(r.weight.extent(1)); ++q) {
        double image[3] = {}, sigma[3], difference[3];
        for (int component = 0; component < 3; ++component)
          for (int m = 0; m < nm; ++m) image[component] += coefficient[component][m] * r.value(s, q, m);
        stress_of_displacement(cell, c, s, q, sigma);
        for (int i = 0; i < 3; ++i) {
          difference[i] = -sigma[i];
          for (int j = 0; j < 3; ++j) difference[i] += T[i][j] * image[j];
        }
        double density = 0;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) density += difference[i] * S[i][j] * difference[j];
        energy += r.weight(s, q) * cell.determinant * density / 2;
      }
    }
    of_cell(c) = energy;
    sum += energy;
  }
};

} // namespace

CellForms cell_forms(const CellInput &in, const Vector &u)
{
  if (in.of_revolution()) return forms_of_revolution(in, u);
  const CellForms forms(in);
  Kokkos::parallel_for("rpc::bound::make_forms", device_range(static_cast<LO>(in.example.extent(0))),
                       MakeForms{in, forms});
  const auto x = device_read(u);
  const auto to = forms.boundary;
  const Facets facets = in.facets;
  const int order = in.reference.degree;
  Kokkos::parallel_for(
      "rpc::bound::boundary_displacements", device_range(facets.size()), KOKKOS_LAMBDA(const LO f) {
        if (!facets.on_boundary(f)) return; // elsewhere those of both cells cancel
        const LO a = facets.node(f, 0), b = facets.node(f, 1), m = order == 2 ? facets.middle(f) : a;
        for (int j = 0; j <= order; ++j)
          for (int i = 0; i < 2; ++i)
            to((f * (order + 1) + j) * 2 + i) =
                -legendre_moment(order, j, x(dof(2, a, i)), x(dof(2, b, i)), x(dof(2, m, i)));
      });
  Kokkos::fence();
  return forms;
}

void add_up(const CellInput &in, const CellForms &forms, const Tractions &t, const bool linear, const Tractions &sum)
{
  const int nt = in.reference.tractions, per_facet = 2 * (in.reference.degree + 1);
  if (linear)
    Kokkos::deep_copy(sum, forms.boundary);
  else
    Kokkos::deep_copy(sum, 0);
  Kokkos::parallel_for(
      "rpc::bound::derivative_of_cells", device_range(in.num_cells()), KOKKOS_LAMBDA(const LO c) {
        double x[ReferenceStress::most_tractions], y[ReferenceStress::most_tractions];
        read_tractions(in, t, c, x);
        const int kind = in.kind(c);
        const double *row = forms.A.data() + kind * forms.A.extent(1);
        for (int i = 0; i < nt; ++i) {
          double own = (linear ? forms.b(kind, i) : 0) + row[i] * x[i];
          for (int j = 0; j < i; ++j) {
            own += row[j] * x[j];
            y[j] += row[j] * x[i];
          }
          y[i] = own;
          row += i + 1;
        }
        for (int s = 0; s < in.reference.sides; ++s)
          for (int q = 0; q < per_facet; ++q)
            add_part(sum(in.facets.of_cell(c, s) * per_facet + q),
                     side_factor(in.facets.sign(c, s), q / 2) * y[s * per_facet + q]);
      });
  Kokkos::fence();
}

StressDifference stress_difference(const CellInput &in, const Comm &comm, const Tractions &t, const Vector &u,
                                   const DeviceView<double *> &of_cell)
{
  if (in.of_revolution()) return difference_of_revolution(in, comm, t, u, of_cell);
  StressDifference d;
  Kokkos::parallel_reduce("rpc::bound::stress_difference", device_range(static_cast<LO>(of_cell.extent(0))),
                          Difference{in, device_read(u), t, of_cell, in.reference.degree}, d.energy,
                          Kokkos::Max<double>(d.imbalance), Kokkos::Max<double>(d.force));
  d.energy = sum_all(comm, d.energy);
  d.imbalance = max_all(comm, std::max(d.imbalance, 0.));
  d.force = max_all(comm, std::max(d.force, 0.));
  return d;
}

double norm_of_lifted_loads(const CellInput &in, const Comm &comm, const LiftedLoads &lifted,
                            const DeviceView<double ***> &load)
{
  const int k = in.reference.degree, beyond = ReferenceStress::degree_of_loads - k, sides = in.reference.sides;
  double squared = 0;
  Kokkos::parallel_reduce(
      "rpc::bound::lifted_loads", device_range(in.num_owned_cells),
      KOKKOS_LAMBDA(const LO c, double &sum) {
        double x[4 * ReferenceStress::degree_of_loads * 2] = {};
        bool any = false;
        const AffineCell cell(in, c);
        for (int s = 0; s < sides; ++s) {
          const LO f = in.facets.of_cell(c, s);
          if (!in.facets.on_boundary(f)) continue;
          for (int j = 0; j < beyond; ++j) {
            const double t[2] = {load(f, k + 1 + j, 0), load(f, k + 1 + j, 1)};
            any = any || t[0] != 0 || t[1] != 0;
            for (int i = 0; i < 2; ++i)
              x[(s * beyond + j) * 2 + i] = cell.inverse[i][0] * t[0] + cell.inverse[i][1] * t[1];
          }
        }
        double thickness = 1;
        for (int v = 0; v < sides && in.of_revolution(); ++v) {
          const double circle = 2 * Circle::pi * in.coords(in.cells(c, v), 0);
          thickness = v == 0 ? circle : math::fmin(thickness, circle);
        }
        if (!any || thickness <= 2 * Circle::pi * in.on_axis) return; // at the axis there are none
        double C[3][3], T[3][3], S[3][3] = {};
        compliance(in.lame(in.block(c), 0), in.lame(in.block(c), 1), C);
        if (in.of_revolution()) { // S has no divergence, so that there is no stress around the axis
          const double lambda = in.lame(in.block(c), 0), mu = in.lame(in.block(c), 1),
                       a = lambda / (3 * lambda + 2 * mu);
          C[0][0] = C[1][1] = (1 - a) / (2 * mu);
          C[0][1] = C[1][0] = -a / (2 * mu);
        }
        cell.stress_map(T);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            for (int a = 0; a < 3; ++a)
              for (int b = 0; b < 3; ++b) S[i][j] += T[a][i] * C[a][b] * T[b][j] * cell.determinant;
        const double s[6] = {S[0][0], S[1][1], S[2][2], S[0][1], S[0][2], S[1][2]};
        for (int p = 0; p < 6; ++p)
          for (int i = 0; i < lifted.columns; ++i)
            for (int j = 0; j < lifted.columns; ++j) sum += s[p] * x[i] * lifted.energy(p, i, j) * x[j] / thickness;
      },
      squared);
  return std::sqrt(std::max(sum_all(comm, squared), 0.));
}

namespace
{

/// Of a point of a table in a body of revolution; 0 in others.
KOKKOS_INLINE_FUNCTION double radius(const CellInput &in, const LO c, const fem::BasisTable &table, const int q)
{
  double r = 0;
  for (int a = 0; a < static_cast<int>(in.cells.extent(1)) && in.of_revolution(); ++a)
    r += table.value(q, a) * in.coords(in.cells(c, a), 0);
  return r;
}

} // namespace

DeviceView<double ***> nodal_forces(const CellInput &in, const fem::Discretization &d, const Vector &u)
{
  const int nodes = static_cast<int>(in.cells.extent(1));
  DeviceView<double ***> Q("rpc::bound::nodal_forces", in.num_cells(), nodes, 2);
  const auto x = device_read(u);
  const fem::BasisTable stress = d.reference.cell, load = d.reference.cell_load;
  const bool loaded = in.force[0] != 0 || in.force[1] != 0;
  Kokkos::parallel_for(
      "rpc::bound::nodal_forces", device_range(in.num_cells()), KOKKOS_LAMBDA(const LO c) {
        const AffineCell cell(in, c);
        const double lambda = in.lame(in.block(c), 0), mu = in.lame(in.block(c), 1);
        for (int q = 0; q < stress.num_points(); ++q) {
          double H[2][2] = {}, D[2][2] = {}, hoop = 0; // the latter u_r/r
          const double r = radius(in, c, stress, q);
          for (int a = 0; a < nodes && r > 0; ++a) hoop += x(dof(2, in.cells(c, a), 0)) * stress.value(q, a) / r;
          for (int a = 0; a < nodes; ++a)
            for (int i = 0; i < 2; ++i)
              for (int l = 0; l < 2; ++l) H[i][l] += x(dof(2, in.cells(c, a), i)) * stress.gradient(q, a, l);
          for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
              for (int l = 0; l < 2; ++l) D[i][j] += H[i][l] * cell.inverse[l][j];
          const double trace = D[0][0] + D[1][1] + hoop,
                       w = stress.weight(q) * cell.determinant * (r > 0 ? 2 * Circle::pi * r : 1);
          const double s[2][2] = {{lambda * trace + 2 * mu * D[0][0], mu * (D[0][1] + D[1][0])},
                                  {mu * (D[0][1] + D[1][0]), lambda * trace + 2 * mu * D[1][1]}};
          for (int a = 0; a < nodes; ++a)
            for (int j = 0; j < 2; ++j) {
              const double dN =
                  stress.gradient(q, a, 0) * cell.inverse[0][j] + stress.gradient(q, a, 1) * cell.inverse[1][j];
              for (int i = 0; i < 2; ++i) Q(c, a, i) += w * s[i][j] * dN;
            }
          for (int a = 0; a < nodes && r > 0; ++a)
            Q(c, a, 0) += w * (lambda * trace + 2 * mu * hoop) * stress.value(q, a) / r;
        }
        for (int q = 0; loaded && q < load.num_points(); ++q) {
          const double r = radius(in, c, load, q);
          for (int a = 0; a < nodes; ++a)
            for (int i = 0; i < 2; ++i)
              Q(c, a, i) -=
                  load.weight(q) * cell.determinant * load.value(q, a) * in.force[i] * (r > 0 ? 2 * Circle::pi * r : 1);
        }
      });
  Kokkos::fence();
  return Q;
}

DeviceView<double ***> mean_moments(const CellInput &in, const Vector &u)
{
  const int nodes = static_cast<int>(in.cells.extent(1)), sides = in.reference.sides, order = in.reference.degree;
  DeviceView<double ***> mean("rpc::bound::mean_moments", in.facets.size(), 2, 2);
  const auto x = device_read(u);
  Kokkos::parallel_for(
      "rpc::bound::mean_moments", device_range(in.facets.size()), KOKKOS_LAMBDA(const LO f) {
        const int both = in.facets.on_boundary(f) ? 1 : 2;
        for (int side = 0; side < both; ++side) {
          const LO c = in.facets.cell(f, side);
          const int s = in.facets.ordinal(f, side);
          const AffineCell cell(in, c);
          const double lambda = in.lame(in.block(c), 0), mu = in.lame(in.block(c), 1);
          const LO from = in.cells(c, s), to = in.cells(c, (s + 1) % sides);
          const double n[2] = {in.coords(to, 1) - in.coords(from, 1), in.coords(from, 0) - in.coords(to, 0)};
          for (int q = 0; q < 3; ++q) {
            const double y = in.reference.side_point(q);
            const double r = in.of_revolution() ? (1 - y) * in.coords(from, 0) + y * in.coords(to, 0) : 0;
            double H[2][2] = {}, D[2][2] = {}, u_r = 0;
            if (r > 0) {
              const double ends = order == 1 ? 1 - y : (1 - y) * (1 - 2 * y), other = order == 1 ? y : y * (2 * y - 1);
              u_r = ends * x(dof(2, from, 0)) + other * x(dof(2, to, 0));
              if (order == 2) u_r += 4 * y * (1 - y) * x(dof(2, in.cells(c, sides + s), 0));
            }
            for (int a = 0; a < nodes; ++a)
              for (int i = 0; i < 2; ++i)
                for (int l = 0; l < 2; ++l)
                  H[i][l] += x(dof(2, in.cells(c, a), i)) * in.reference.side_gradient(s, q, a, l);
            for (int i = 0; i < 2; ++i)
              for (int j = 0; j < 2; ++j)
                for (int l = 0; l < 2; ++l) D[i][j] += H[i][l] * cell.inverse[l][j];
            const double trace = D[0][0] + D[1][1] + (r > 0 ? u_r / r : 0), shear = mu * (D[0][1] + D[1][0]);
            const double t[2] = {(lambda * trace + 2 * mu * D[0][0]) * n[0] + shear * n[1],
                                 shear * n[0] + (lambda * trace + 2 * mu * D[1][1]) * n[1]};
            const double w = in.reference.side_weight(q) / both * (in.of_revolution() ? 2 * Circle::pi * r : 1);
            for (int e = 0; e < 2; ++e) { // the functions of the vertices, in the direction of the cell
              const double z = e == 0 ? 1 - y : y, N = order == 1 ? z : z * (2 * z - 1);
              const int end = side == 0 ? e : 1 - e;
              for (int i = 0; i < 2; ++i) mean(f, end, i) += (side == 0 ? 1 : -1) * w * N * t[i];
            }
          }
        }
      });
  Kokkos::fence();
  return mean;
}

double largest_distortion(const CellInput &in, const mesh::Element &element)
{
  const int nodes = element.num_nodes(), order = element.order;
  const bool simplex = element.shape == mesh::Shape::simplex;
  DeviceView<double **> X("rpc::bound::nodes_of_reference", nodes, 2);
  const auto host = Kokkos::create_mirror_view(X);
  for (int a = 0; a < nodes; ++a)
    for (int d = 0; d < 2; ++d) {
      const double on_lattice = static_cast<double>(element.lattice()[a][d]) / order;
      host(a, d) = simplex ? on_lattice - 1. / 3 : 2 * on_lattice - 1;
    }
  Kokkos::deep_copy(X, host);
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::bound::distortion", device_range(in.num_cells()),
      KOKKOS_LAMBDA(const LO c, double &most) {
        const AffineCell cell(in, c);
        double size = 0;
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) size = math::fmax(size, math::magnitude(cell.F[i][j]));
        for (int a = 0; a < nodes; ++a)
          for (int i = 0; i < 2; ++i) {
            const double at = cell.centre[i] + cell.F[i][0] * X(a, 0) + cell.F[i][1] * X(a, 1);
            most = math::fmax(most, math::magnitude(in.coords(in.cells(c, a), i) - at) / size);
          }
      },
      Kokkos::Max<double>(largest));
  return largest;
}

} // namespace rpc::bound
