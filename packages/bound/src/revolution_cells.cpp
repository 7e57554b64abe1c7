// SPDX-License-Identifier: BSD-3-Clause
#include "revolution_cells.hpp"

#include "revolution_energy.hpp"

#include <algorithm>

namespace rpc::bound
{
namespace
{

using ReadDisplacement = RevolutionEnergy::ReadDisplacement;

/// The force of the body on the axis' direction, S_zz = -f 2 pi r z, at a facet of its first cell: coefficients of the polynomials up to 2.
KOKKOS_INLINE_FUNCTION void traction_of_force(const CellInput &in, const LO f, double (&t)[3])
{
  const LO a = in.facets.node(f, 0), b = in.facets.node(f, 1);
  const double r = in.coords(a, 0), dr = in.coords(b, 0) - r, z = in.coords(a, 1), dz = in.coords(b, 1) - z;
  const double factor = in.force[1] * 2 * Circle::pi * dr; // n_z = -dr
  const double c[3] = {factor * r * z, factor * (r * dz + z * dr), factor * dr * dz};
  t[0] = c[0] + c[1] / 2 + c[2] / 3;
  t[1] = (c[1] + c[2]) / 2;
  t[2] = c[2] / 6;
}

KOKKOS_INLINE_FUNCTION bool is_on_axis(const CellInput &in, const LO node)
{
  return in.coords(node, 0) <= in.on_axis;
}

struct MakeFormsOfRevolution {
  CellInput in;
  ReadDisplacement u;
  CellForms out;

  KOKKOS_FUNCTION void operator()(const LO c) const
  {
    const int nt = in.reference.tractions;
    RevolutionEnergy e(in, u, c);
    e.factor();
    double reduced[ReferenceStress::most_tractions][ReferenceStress::most_tractions],
        linear[ReferenceStress::most_tractions];
    double x[RevolutionTables::most_inner], mu[RevolutionTables::most_conditions],
        unit[ReferenceStress::most_tractions];
    for (int j = 0; j <= nt; ++j) { // the last one is that of the displacement
      for (int i = 0; i < nt; ++i) unit[i] = i == j ? 1 : 0;
      e.solve(unit, j == nt, x, mu);
      for (int i = 0; i < nt; ++i) {
        double sum = j < nt ? e.A[i][j] : e.g[i];
        for (int z = 0; z < e.inner; ++z) sum += e.A[i][nt + z] * x[z];
        for (int r = 0; r < e.conditions; ++r) sum += e.D[r][i] * mu[r];
        if (j < nt)
          reduced[i][j] = sum;
        else
          linear[i] = sum;
      }
    }
    const auto &G = e.cell.inverse;
    for (int p = 0; p < nt / 2; ++p) {
      for (int q = 0; q <= p; ++q)
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2 && 2 * q + j <= 2 * p + i; ++j) {
            double sum = 0;
            for (int a = 0; a < 2; ++a)
              for (int b = 0; b < 2; ++b) sum += G[a][i] * reduced[2 * p + a][2 * q + b] * G[b][j];
            out.A(c, row_of_triangle(2 * p + i) + 2 * q + j) = sum;
          }
      for (int i = 0; i < 2; ++i) out.b(c, 2 * p + i) = G[0][i] * linear[2 * p] + G[1][i] * linear[2 * p + 1];
    }
  }
};

struct DifferenceOfRevolution {
  CellInput in;
  ReadDisplacement u;
  Tractions t;
  DeviceView<double *> of_cell;

  KOKKOS_FUNCTION void operator()(const LO c, double &sum, double &imbalance, double &force) const
  {
    const int nt = in.reference.tractions, k = in.reference.degree, sides = in.reference.sides;
    RevolutionEnergy e(in, u, c);
    double x[RevolutionTables::most_columns], mu[RevolutionTables::most_conditions], along = 0, off = 0;
    for (int s = 0; s < sides; ++s) {
      const LO f = in.facets.of_cell(c, s);
      double at_end[2][2] = {};
      for (int j = 0; j <= k; ++j)
        for (int i = 0; i < 2; ++i) {
          const double y = t((f * (k + 1) + j) * 2 + i) * side_factor(in.facets.sign(c, s), j);
          x[(s * (k + 1) + j) * 2 + i] = y;
          if (j == 0) force = math::fmax(force, math::magnitude(y));
          if (j == 0 && i == 1) along += y;
          at_end[0][i] += j % 2 == 0 ? y : -y;
          at_end[1][i] += y;
        }
      for (int end = 0; end < 2; ++end)
        for (int i = 0; i < 2 && is_on_axis(in, in.cells(c, (s + end) % sides)); ++i)
          off = math::fmax(off, math::magnitude(at_end[end][i]));
    }
    for (int p = 0; p < nt / 2; ++p) {
      const double y[2] = {x[2 * p], x[2 * p + 1]};
      for (int i = 0; i < 2; ++i) x[2 * p + i] = e.cell.inverse[i][0] * y[0] + e.cell.inverse[i][1] * y[1];
    }
    e.factor();
    e.solve(x, true, x + nt, mu);
    for (int r = 0; r < e.conditions; ++r) {
      double left = 0;
      for (int j = 0; j < e.columns; ++j) left += e.D[r][j] * x[j];
      off = math::fmax(off, math::magnitude(left));
    }
    imbalance = math::fmax(imbalance, math::fmax(off, math::magnitude(along)));
    of_cell(c) = e.energy_of(u, x, true) / 2;
    sum += of_cell(c);
  }
};

} // namespace

CellForms forms_of_revolution(const CellInput &in, const Vector &u)
{
  const CellForms forms(in);
  Kokkos::parallel_for("rpc::bound::make_forms_of_revolution", device_range(in.num_cells()),
                       MakeFormsOfRevolution{in, device_read(u), forms});
  Kokkos::fence();
  return forms;
}

StressDifference difference_of_revolution(const CellInput &in, const Comm &comm, const Tractions &t, const Vector &u,
                                          const DeviceView<double *> &of_cell)
{
  StressDifference d;
  Kokkos::parallel_reduce("rpc::bound::difference_of_revolution", device_range(static_cast<LO>(of_cell.extent(0))),
                          DifferenceOfRevolution{in, device_read(u), t, of_cell}, d.energy,
                          Kokkos::Max<double>(d.imbalance), Kokkos::Max<double>(d.force));
  d.energy = sum_all(comm, d.energy);
  d.imbalance = max_all(comm, std::max(d.imbalance, 0.));
  d.force = max_all(comm, std::max(d.force, 0.));
  return d;
}

Squared squared_of_revolution(const CellInput &in, const Comm &comm, const Vector &u)
{
  Squared s;
  const auto x = device_read(u);
  Kokkos::parallel_reduce(
      "rpc::bound::squared_of_revolution", device_range(in.num_owned_cells),
      KOKKOS_LAMBDA(const LO c, double &lower, double &upper) {
        const RevolutionEnergy e(in, c);
        lower += e.energy_of(x, nullptr, false);
        upper += e.energy_of(x, nullptr, true);
      },
      s.lower, s.upper);
  return {sum_all(comm, s.lower), sum_all(comm, s.upper)};
}

void admit_on_axis(const CellInput &in, const Tractions &t)
{
  const int k = in.reference.degree;
  Kokkos::parallel_for(
      "rpc::bound::admit_on_axis", device_range(in.facets.size()), KOKKOS_LAMBDA(const LO f) {
        double own[3] = {};
        traction_of_force(in, f, own);
        for (int j = 0; j <= k; ++j) t((f * (k + 1) + j) * 2 + 1) -= own[j];
        for (int end = 0; end < 2; ++end)
          for (int i = 0; i < 2 && is_on_axis(in, in.facets.node(f, end)); ++i) {
            double at_end = 0;
            for (int j = 0; j <= k; ++j) at_end += (end == 0 && j == 1 ? -1 : 1) * t((f * (k + 1) + j) * 2 + i);
            t((f * (k + 1) + 1) * 2 + i) -= (end == 0 ? -1 : 1) * at_end;
          }
      });
  Kokkos::fence();
}

std::string loads_not_covered(const CellInput &in, const Comm &comm, const BoundaryTractions &loads, const LO num_owned)
{
  constexpr double rounding = 1e-12;
  double most = 0, beyond = 0;
  int slanted = 0;
  const int k = in.reference.degree, degrees = static_cast<int>(loads.load.extent(1));
  const bool heavy = in.force[1] != 0 && k == 1;
  Kokkos::parallel_reduce(
      "rpc::bound::loads_not_covered", device_range(in.facets.size()),
      KOKKOS_LAMBDA(const LO f, double &all, double &bend, int &any) {
        const LO a = in.facets.node(f, 0), b = in.facets.node(f, 1);
        if (!in.facets.on_boundary(f) || (a >= num_owned && b >= num_owned)) return; // another rank has all cells there
        const double dr = math::magnitude(in.coords(b, 0) - in.coords(a, 0)),
                     dz = math::magnitude(in.coords(b, 1) - in.coords(a, 1));
        if (heavy && loads.known(f, 1) && math::fmin(dr, dz) > rounding * math::fmax(dr, dz)) any = 1;
        bool at_axis = false;
        for (int v = 0; v < in.reference.sides; ++v)
          at_axis = at_axis || is_on_axis(in, in.cells(in.facets.cell(f, 0), v));
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < degrees && loads.known(f, i); ++j) {
            const double size = math::magnitude(loads.load(f, j, i));
            all = math::fmax(all, size);
            if (at_axis && j > k) bend = math::fmax(bend, size);
          }
      },
      Kokkos::Max<double>(most), Kokkos::Max<double>(beyond), Kokkos::Max<int>(slanted));
  if (max_all(comm, std::max(slanted, 0)) > 0)
    return "a body of revolution of order 1 has a body force along its axis and sides that are neither along the "
           "axis nor across it; order 2 allows both";
  if (max_all(comm, std::max(beyond, 0.)) > rounding * max_all(comm, std::max(most, 0.)))
    return std::string("loads on a cell at the axis ") +
           (k == 1 ? "depend on the place there, which order 2 allows" : "are no linear functions of the place there");
  return "";
}

} // namespace rpc::bound
