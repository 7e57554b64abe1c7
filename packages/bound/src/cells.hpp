// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cell_stress.hpp"
#include "float_products.hpp"
#include "rpc/core/tpetra.hpp"

#include <cstddef>
#include <type_traits>

namespace rpc::bound
{

/// Coefficients of tractions: (facets * (k + 1) * 2), facet by facet, of the polynomials P_j.
using Tractions = DeviceView<double *>;

/// target += one of two parts: their sum does not depend on which comes first.
template <class Real>
KOKKOS_INLINE_FUNCTION void add_part(Real &target, const Real part)
{
#ifdef KOKKOS_ENABLE_SERIAL
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Serial>)
    target += part;
  else
#endif
    Kokkos::atomic_add(&target, part);
}

/// The energies of the kinds of cells by their tractions, outward, the inner stresses at their best:
///
///     E_T(t) = t . A t/2 + b . t + const.                                                             doc/bounds.md (13.8)
struct CellForms {
  Kokkos::View<double **, Kokkos::LayoutRight, Device> A; ///< (kinds, rows of the lower triangle)
  DeviceView<double **> b;                                ///< (kinds, tractions)
  DeviceView<double *> boundary; ///< (tractions) what the displacement on the boundary adds, in the signs of the facets

  CellForms(const CellInput &in)
      : A("rpc::bound::A", in.example.extent(0), row_of_triangle(in.reference.tractions)),
        b("rpc::bound::b", in.example.extent(0), in.reference.tractions),
        boundary("rpc::bound::boundary", static_cast<std::size_t>(in.facets.size()) * 2 * (in.reference.degree + 1))
  {
  }
  KOKKOS_INLINE_FUNCTION double second(const int kind, const int i, const int j) const
  {
    return i < j ? A(kind, row_of_triangle(j) + i) : A(kind, row_of_triangle(i) + j);
  }
};

/// @param u  (overlap dofs) the displacement whose stress the others are compared with [m]
CellForms cell_forms(const CellInput &in, const Vector &u);

/// The derivative of the sum of the energies by the tractions, or with linear = false A x.
void add_up(const CellInput &in, const CellForms &forms, const Tractions &t, bool linear, const Tractions &sum);

/// Bounds of a(u, u) [J]: where it is an integral of polynomials both are this integral.
struct Squared {
  double lower = 0, upper = 0;
  Squared() = default;
  Squared(const double exact) : lower(exact), upper(exact) {}
  Squared(const double low, const double high) : lower(low), upper(high) {}
};

/// What the stresses of tractions leave, on all ranks.
struct StressDifference {
  double energy = 0;    ///< |sigma - C eps(u)|^2 / 2 over the body [J], in 2D per m
  double imbalance = 0; ///< largest force or moment, by the size of the cell, that is out of balance on a cell [N]
  double force = 0;     ///< largest force of a traction on a cell [N]
};
/// Collective. @param of_cell  (owned cells) the energy of each, out
StressDifference stress_difference(const CellInput &in, const Comm &comm, const Tractions &t, const Vector &u,
                                   const DeviceView<double *> &of_cell);

/// Norm |tau| of stresses that lift what the loads of facets have beyond degree k, in the norm of C^-1 [J^(1/2)].
/// Collective. @param load  (facets, degrees, 2) coefficients of the tractions on the boundary, by unit of the parameter
double norm_of_lifted_loads(const CellInput &in, const Comm &comm, const LiftedLoads &lifted,
                            const DeviceView<double ***> &load);

/// Moments in the cells: Q_a = int C eps(u) grad N_a - int f N_a.
/// @return (cells, nodes, 2) [N]
DeviceView<double ***> nodal_forces(const CellInput &in, const fem::Discretization &d, const Vector &u);

/// Means over the cells at a facet of the moments of the tractions of C eps(u) with the functions of order 1 or 2 that belong to both
/// vertices: (facets, 2, 2) [N]
DeviceView<double ***> mean_moments(const CellInput &in, const Vector &u);

/// By how much nodes lie off the affine map of their cells, over the cells' size.
double largest_distortion(const CellInput &in, const mesh::Element &element);

} // namespace rpc::bound
