// SPDX-License-Identifier: BSD-3-Clause
#include "kind_difference.hpp"

#include "float_products.hpp"

#include <algorithm>

namespace rpc::bound
{
namespace
{

struct DifferenceOfKinds {
  using Sizes = SpaceSizes<1>;
  SpaceInput in;
  SpaceForms forms;
  ReadDisplacement u;
  Tractions t;
  DeviceView<double *> of_cell;

  /// Largest force, or moment by the size of the cell, that is left, and largest force on a facet.
  KOKKOS_FUNCTION void judge_balance(const double *x, const AffineTetrahedron &cell, double &imbalance,
                                     double &force) const
  {
    CellBalance balance{};
    double vertex[4][3]; // vertices relative to the centre
    for (int i = 0; i < 3; ++i) {
      vertex[0][i] = -(cell.F[i][0] + cell.F[i][1] + cell.F[i][2]) / 4;
      for (int l = 0; l < 3; ++l) vertex[l + 1][i] = vertex[0][i] + cell.F[i][l];
    }
    for (int s = 0; s < 4; ++s) {
      const double *const T = x + s * Sizes::per_facet;
      const int corner[3] = {s == 0 ? 1 : 0, s <= 1 ? 2 : 1, s == 3 ? 2 : 3};
      double arm[3], along[2][3];
      for (int i = 0; i < 3; ++i) {
        const double first = vertex[corner[0]][i];
        arm[i] = (first + vertex[corner[1]][i] + vertex[corner[2]][i]) / 3;
        for (int j = 0; j < 2; ++j)
          along[j][i] = in.tables.linear(1 + j, 1) * (vertex[corner[1]][i] - first) +
                        in.tables.linear(1 + j, 2) * (vertex[corner[2]][i] - first);
      }
      balance.add(T, arm, along);
    }
    balance.judge(imbalance, force);
  }

  KOKKOS_FUNCTION void operator()(const LO c, double &sum, double &imbalance, double &force) const
  {
    const AffineTetrahedron cell(in, c);
    double x[Sizes::tractions], D[3][3], sigma[3][3];
    for (int s = 0; s < 4; ++s) {
      const double sign = in.facets.sign(c, s);
      const std::size_t from = static_cast<std::size_t>(in.facets.of_cell(c, s)) * Sizes::per_facet;
      for (int q = 0; q < Sizes::per_facet; ++q) x[s * Sizes::per_facet + q] = sign * t(from + q);
    }
    judge_balance(x, cell, imbalance, force);
    gradient_in_space(
        in, cell, c, u, [&](const int a, const int l) { return in.reference.gradient(0, 0, a, l); }, D);
    stress_of_gradient(in.lame(in.block(c), 0), in.lame(in.block(c), 1), D, sigma);
    double normal[4][3] = {}; // outward, as long as the areas
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 3; ++i) {
        normal[l + 1][i] = -cell.determinant / 2 * cell.inverse[l][i];
        normal[0][i] -= normal[l + 1][i];
      }
    for (int s = 0; s < 4; ++s)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) x[s * Sizes::per_facet + i] -= sigma[i][j] * normal[s][j];
    const int kind = in.kind(c);
    const double *const A = forms.exact.data() + static_cast<std::size_t>(kind) * Sizes::tractions * Sizes::tractions;
    const double energy = math::fmax(0., FloatProducts::square<Sizes::tractions>(A, x) / 2);
    of_cell(c) = energy;
    sum += energy;
  }
};

/// By how much this rank's cells differ from their kinds, of their size at most.
double largest_difference(const SpaceInput &in)
{
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::bound::difference_from_kinds", device_range(in.num_cells()),
      KOKKOS_LAMBDA(const LO c, double &most) {
        const LO example = in.example(in.kind(c));
        for (int i = 0; i < 3; ++i) {
          double off = 0, size = 0;
          for (int l = 1; l < 4; ++l) {
            const double here = in.coords(in.cells(c, l), i) - in.coords(in.cells(c, 0), i),
                         there = in.coords(in.cells(example, l), i) - in.coords(in.cells(example, 0), i);
            off = math::fmax(off, math::magnitude(here - there));
            size = math::fmax(size, math::magnitude(here));
          }
          most = math::fmax(most, off / size);
        }
      },
      Kokkos::Max<double>(largest));
  return largest;
}

} // namespace

bool energies_by_kinds(const SpaceInput &in)
{
  constexpr std::size_t cells_of_kind = 16; // on the average: then its energy takes little beside its cells' tractions
  constexpr double rounding = 1e-12;        // of differences of coordinates: kinds tell less apart, see find_kinds()
  return in.reference.degree == 1 && !in.loaded() && !in.of_hexahedra &&
         cells_of_kind * in.example.extent(0) <= static_cast<std::size_t>(in.num_cells()) &&
         largest_difference(in) <= rounding;
}

StressDifference difference_of_kinds(const SpaceInput &in, const Comm &comm, const SpaceForms &forms,
                                     const Tractions &t, const Vector &u, const DeviceView<double *> &of_cell)
{
  StressDifference d;
  Kokkos::parallel_reduce("rpc::bound::difference_of_kinds", device_range(in.num_owned_cells),
                          DifferenceOfKinds{in, forms, device_read(u), t, of_cell}, d.energy,
                          Kokkos::Max<double>(d.imbalance), Kokkos::Max<double>(d.force));
  d.energy = sum_all(comm, d.energy);
  d.imbalance = max_all(comm, std::max(d.imbalance, 0.));
  d.force = max_all(comm, std::max(d.force, 0.));
  return d;
}

} // namespace rpc::bound
