// SPDX-License-Identifier: BSD-3-Clause
#include "space_cells.hpp"

#include "float_products.hpp"
#include "hexahedra.hpp"
#include "kind_difference.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace rpc::bound
{
namespace
{

/// Calls with the order of the elements as a constant.
template <class Function>
void for_order(const int order, const Function &f)
{
  if (order == 1)
    f(std::integral_constant<int, 1>{});
  else
    f(std::integral_constant<int, 2>{});
}

/// The image of the stress that takes up the body force: coefficients of X_l.
KOKKOS_INLINE_FUNCTION void image_of_force(const SpaceInput &in, const AffineTetrahedron &cell, double (&image)[3][6])
{
  for (int l = 0; l < 3; ++l) {
    double sigma[3][3] = {};
    for (int i = 0; i < 3; ++i) sigma[i][i] = -in.force[i] * cell.F[i][l];
    cell.image(sigma, image[l]);
  }
}

/// The tractions of a cell, outward.
template <int K>
KOKKOS_INLINE_FUNCTION void read_space_tractions(const SpaceInput &in, const Tractions &t, const LO c, double *x)
{
  constexpr int n = SpaceSizes<K>::per_facet;
  for (int s = 0; s < 4; ++s) {
    const double sign = in.facets.sign(c, s);
    const std::size_t from = static_cast<std::size_t>(in.facets.of_cell(c, s)) * n;
    for (int q = 0; q < n; ++q) x[s * n + q] = sign * t(from + q);
  }
}

/// Second and first derivatives of the energy of a kind of cells by their tractions.
template <int K>
struct MakeSpaceForms {
  using Sizes = SpaceSizes<K>;
  SpaceInput in;
  SpaceForms out;

  KOKKOS_FUNCTION void operator()(const LO kind) const
  {
    constexpr int nt = Sizes::tractions, n = Sizes::columns, nz = Sizes::inner;
    const LO c = in.example(kind);
    const AffineTetrahedron cell(in, c);
    double S[6][6], A[n][n], of_force[n];
    compliance_of_images(in, cell, c, S);
    double factor[pairs];
    int pair = 0;
    for (int p = 0; p < 6; ++p) factor[pair++] = S[p][p];
    for (int p = 0; p < 6; ++p)
      for (int q = p + 1; q < 6; ++q) factor[pair++] = S[p][q];
    sum_energies(factor, A);
    double image[3][6];
    image_of_force(in, cell, image);
    for (int i = 0; i < n; ++i) {
      of_force[i] = 0;
      for (int k = 0; in.loaded() && k < 6; ++k)
        for (int l = 0; l < 3; ++l)
          for (int m = 0; m < 6; ++m) of_force[i] += in.reference.moment(k, l, i) * S[k][m] * image[l][m];
    }
    if constexpr (nz > 0) eliminate_inner(kind, A, of_force);
    // From reference tractions to those of the facets: t^ = F^-1 t.
    const auto &G = cell.inverse;
    for (int p = 0; p < nt / 3; ++p)
      for (int q = 0; q < nt / 3; ++q) {
        double half[3][3];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            half[i][j] = 0;
            for (int k = 0; k < 3; ++k) half[i][j] += A[3 * p + i][3 * q + k] * G[k][j];
          }
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) sum += G[k][i] * half[k][j];
            out.A(kind, 3 * p + i, 3 * q + j) = static_cast<float>(sum);
            if (out.exact.extent(0) > 0) out.exact(kind, 3 * p + i, 3 * q + j) = sum;
          }
      }
    for (int p = 0; p < nt / 3; ++p)
      for (int i = 0; i < 3; ++i) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += G[k][i] * of_force[3 * p + k];
        out.b(kind, 3 * p + i) = sum;
      }
    for (int s = 0; in.loaded() && s < 4; ++s) {
      double tau[3][3];
      traction_of_force(in, cell, c, s, tau);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const int at = s * Sizes::per_facet + 3 * j + i;
          for (int p = 0; p < nt; ++p) out.b(kind, p) -= out.A(kind, p, at) * tau[j][i];
        }
    }
  }

  static constexpr int pairs = 21;
  /// A <- the tables of pairs times factors, three at once.
  KOKKOS_FUNCTION void sum_energies(const double (&factor)[pairs], double (&A)[Sizes::columns][Sizes::columns]) const
  {
    constexpr int size = Sizes::columns * Sizes::columns;
    const double *table = in.reference.energy.data();
    double *const sum = &A[0][0];
    for (int k = 0; k < size; ++k) sum[k] = 0;
    for (int p = 0; p < pairs; p += 3, table += 3 * size)
      for (int k = 0; k < size; ++k)
        sum[k] += factor[p] * table[k] + factor[p + 1] * table[size + k] + factor[p + 2] * table[2 * size + k];
  }
  /// A and the force's part with the inner stresses at their best, which are kept.
  KOKKOS_FUNCTION void eliminate_inner(const LO kind, double (&A)[Sizes::columns][Sizes::columns],
                                       double (&of_force)[Sizes::columns]) const
  {
    constexpr int nt = Sizes::tractions, n = Sizes::columns;
    for (int j = nt; j < n; ++j) {
      for (int k = nt; k < j; ++k)
        for (int i = j; i < n; ++i) A[i][j] -= A[i][k] * A[j][k];
      const double pivot = math::sqrt(A[j][j]);
      for (int i = j; i < n; ++i) A[i][j] /= pivot;
    }
    for (int t = 0; t <= nt; ++t) {
      double x[Sizes::columns];
      for (int i = nt; i < n; ++i) {
        x[i] = t < nt ? A[t][i] : of_force[i];
        for (int k = nt; k < i; ++k) x[i] -= A[i][k] * x[k];
        x[i] /= A[i][i];
      }
      for (int i = n - 1; i >= nt; --i) {
        for (int k = i + 1; k < n; ++k) x[i] -= A[k][i] * x[k];
        x[i] /= A[i][i];
      }
      for (int i = nt; i < n; ++i) out.inner(kind, t, i - nt) = -x[i];
      for (int r = 0; t == nt && r < nt; ++r)
        for (int z = nt; z < n; ++z) of_force[r] -= A[r][z] * x[z];
    }
    for (int r = 0; r < nt; ++r)
      for (int t = 0; t < nt; ++t)
        for (int z = nt; z < n; ++z) A[r][t] += A[r][z] * out.inner(kind, t, z - nt);
  }
};

/// target += one of two parts: their sum does not depend on which comes first.
KOKKOS_INLINE_FUNCTION void add_part(float &target, const float part)
{
#ifdef KOKKOS_ENABLE_SERIAL
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Serial>)
    target += part;
  else
#endif
    Kokkos::atomic_add(&target, part);
}

/// A t, and with linear = true the first derivatives, in the signs of the facets.
template <int K>
struct DerivativeOfCells {
  SpaceInput in;
  SpaceForms forms;
  Tractions t;
  bool linear;
  DeviceView<float *> out; // (tractions) inout

  /// @param work  += that of t with this, of owned cells
  KOKKOS_FUNCTION void operator()(const LO c, double &work) const
  {
    constexpr int nt = SpaceSizes<K>::tractions, n = SpaceSizes<K>::per_facet;
    float sign[4], y[nt]; // of single precision, as A
    const double *given[4];
    std::size_t from[4];
    const int kind = in.kind(c);
    for (int s = 0; s < 4; ++s) {
      const LO f = in.facets.of_cell(c, s);
      sign[s] = in.facets.cell(f, 0) == c ? 1 : -1;
      from[s] = static_cast<std::size_t>(f) * n;
      given[s] = t.data() + from[s];
    }
    if constexpr (!on_gpu) {
      const LO later = c + 4 < in.num_cells() ? c + 4 : c;
      for (int s = 0; s < 4; ++s) {
        const std::size_t at = static_cast<std::size_t>(in.facets.of_cell(later, s)) * n;
        soon(t.data() + at);
        soon(t.data() + at + n - 1);
        soon(out.data() + at);
      }
    }
    const float *const A = forms.A.data() + static_cast<std::size_t>(kind) * nt * nt;
    const double *const b = linear ? forms.b.data() + static_cast<std::size_t>(kind) * nt : nullptr;
    const double product = FloatProducts::template of_cell<nt>(A, given, sign, b, y);
    if (c < in.num_owned_cells) work += product;
    for (int s = 0; s < 4; ++s) {
      float *const to = out.data() + from[s];
      for (int q = 0; q < n; ++q) add_part(to[q], y[s * n + q]);
    }
  }
};

/// The displacement of a tetrahedron's own shape functions.
template <int K>
struct TetrahedronField {
  SpaceInput in;
  ReadDisplacement u;
  static constexpr bool is_linear = K == 1; ///< C eps is constant

  /// du_i / dx_j at a point of a part.
  KOKKOS_FUNCTION void gradient_at(const AffineTetrahedron &cell, const LO c, const int s, const int q,
                                   double (&D)[3][3]) const
  {
    gradient_in_space(
        in, cell, c, u, [&](const int a, const int l) { return in.reference.gradient(s, q, a, l); }, D);
  }
};

/// Energy and balance of the stress of a tetrahedron.
template <int K, class Field = TetrahedronField<K>>
struct SpaceDifference {
  using Sizes = SpaceSizes<K>;
  SpaceInput in;
  SpaceForms forms;
  Field u;
  Tractions t;
  DeviceView<double *> of_cell;

  /// @param balance  largest force, or moment by the size of the cell, that is left   @param force  largest on a facet
  KOKKOS_FUNCTION void judge_balance(const LO c, const double *x, const AffineTetrahedron &cell, double &imbalance,
                                     double &force) const
  {
    CellBalance balance{};
    for (int i = 0; i < 3; ++i) balance.force[i] = in.force[i] * cell.determinant / 6;
    for (int s = 0; s < 4; ++s) {
      const FacetFrame frame(in, in.facets.of_cell(c, s));
      double arm[3];
      for (int i = 0; i < 3; ++i) arm[i] = frame.centre[i] - cell.centre[i];
      balance.add(x + s * Sizes::per_facet, arm, frame.along);
    }
    balance.judge(imbalance, force);
  }

  KOKKOS_FUNCTION void operator()(const LO c, double &sum, double &imbalance, double &force) const
  {
    constexpr int nt = Sizes::tractions, nm = Sizes::monomials, nz = Sizes::inner;
    const AffineTetrahedron cell(in, c);
    double x[Sizes::columns];
    read_space_tractions<K>(in, t, c, x);
    judge_balance(c, x, cell, imbalance, force);
    for (int s = 0; in.loaded() && s < 4; ++s) {
      double tau[3][3];
      traction_of_force(in, cell, c, s, tau);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) x[s * Sizes::per_facet + 3 * j + i] -= tau[j][i];
    }
    for (int p = 0; p < nt / 3; ++p) {
      const double y[3] = {x[3 * p], x[3 * p + 1], x[3 * p + 2]};
      for (int i = 0; i < 3; ++i)
        x[3 * p + i] = cell.inverse[i][0] * y[0] + cell.inverse[i][1] * y[1] + cell.inverse[i][2] * y[2];
    }
    if constexpr (nz > 0) { // those of the kind: any are admissible
      const int kind = in.kind(c);
      for (int z = 0; z < nz; ++z) {
        x[nt + z] = in.loaded() ? forms.inner(kind, nt, z) : 0;
        for (int i = 0; i < nt; ++i) x[nt + z] += forms.inner(kind, i, z) * x[i];
      }
    }
    double coefficient[Sizes::coefficients], image[3][6];
    for (double &value : coefficient) value = 0;
    const double *column = in.reference.by_column.data();
    for (int i = 0; i < Sizes::columns; i += 2, column += 2 * Sizes::coefficients)
      for (int k = 0; k < Sizes::coefficients; ++k)
        coefficient[k] += column[k] * x[i] + column[Sizes::coefficients + k] * x[i + 1];
    image_of_force(in, cell, image);
    for (int s = 0; in.loaded() && s < 4; ++s)
      for (int component = 0; component < 6; ++component)
        for (int l = 0; l < 3; ++l) coefficient[(s * 6 + component) * nm + 1 + l] += image[l][component];
    double S[6][6];
    compliance_of_images(in, cell, c, S);
    double energy = 0, of_u[6] = {};
    for (int s = 0; s < 4; ++s)
      for (int q = 0; q < static_cast<int>(in.reference.weight.extent(1)); ++q) {
        double D[3][3], sigma[3][3], off[6];
        if (!Field::is_linear || q + s == 0) {
          u.gradient_at(cell, c, s, q, D);
          stress_of_gradient(in.lame(in.block(c), 0), in.lame(in.block(c), 1), D, sigma);
          cell.image(sigma, of_u);
        }
        for (int component = 0; component < 6; ++component) {
          off[component] = -of_u[component];
          for (int m = 0; m < nm; ++m)
            off[component] += coefficient[(s * 6 + component) * nm + m] * in.reference.value(s, q, m);
        }
        double density = 0;
        for (int i = 0; i < 6; ++i)
          for (int j = 0; j < 6; ++j) density += off[i] * S[i][j] * off[j];
        energy += in.reference.weight(s, q) * density / 2;
      }
    of_cell(c) = energy;
    sum += energy;
  }
};

} // namespace

SpaceForms cell_forms(const SpaceInput &in, const Vector &u)
{
  const int nt = in.reference.tractions, kinds = static_cast<int>(in.example.extent(0)),
            functions = static_cast<int>(in.facets.node.extent(1));
  SpaceForms forms;
  forms.A = decltype(forms.A)("rpc::bound::A", kinds, nt, nt);
  if (energies_by_kinds(in)) forms.exact = decltype(forms.exact)("rpc::bound::exact", kinds, nt, nt);
  forms.b = decltype(forms.b)("rpc::bound::b", kinds, nt);
  forms.inner = DeviceView<double ***>("rpc::bound::inner", kinds, nt + 1, in.reference.inner);
  forms.boundary =
      DeviceView<double *>("rpc::bound::boundary", static_cast<std::size_t>(in.facets.num_outer) * 3 * functions);
  for_order(in.reference.degree, [&](const auto order) {
    Kokkos::parallel_for("rpc::bound::make_space_forms", device_range(static_cast<LO>(kinds)),
                         MakeSpaceForms<order.value>{in, forms});
  });
  const auto x = device_read(u);
  const auto to = forms.boundary;
  const SpaceFacets facets = in.facets;
  const auto moment = in.tables.moment;
  Kokkos::parallel_for(
      "rpc::bound::boundary_displacements", device_range(facets.size()), KOKKOS_LAMBDA(const LO f) {
        if (!facets.on_boundary(f)) return; // elsewhere those of both cells cancel
        for (int j = 0; j < functions; ++j)
          for (int a = 0; a < functions; ++a)
            for (int i = 0; i < 3; ++i)
              to((static_cast<std::size_t>(f) * functions + j) * 3 + i) -=
                  moment(j, a) * x(dof(3, facets.node(f, a), i));
      });
  Kokkos::fence();
  return forms;
}

double derivative(const SpaceInput &in, const SpaceForms &forms, const Tractions &t, const bool linear,
                  const DeviceView<float *> &out)
{
  Kokkos::deep_copy(out, 0);
  const auto boundary = forms.boundary;
  if (linear)
    Kokkos::parallel_for(
        "rpc::bound::derivative_at_boundary", device_range(static_cast<LO>(boundary.extent(0))),
        KOKKOS_LAMBDA(const LO i) { out(i) = static_cast<float>(boundary(i)); });
  double work = 0;
  for_order(in.reference.degree, [&](const auto order) {
    Kokkos::parallel_reduce("rpc::bound::derivative_of_cells", device_range(in.num_cells()),
                            DerivativeOfCells<order.value>{in, forms, t, linear, out}, work);
  });
  return work;
}

namespace
{

/// Over all ranks.
StressDifference over_ranks(const Comm &comm, StressDifference d)
{
  d.energy = sum_all(comm, d.energy);
  d.imbalance = max_all(comm, std::max(d.imbalance, 0.));
  d.force = max_all(comm, std::max(d.force, 0.));
  return d;
}

} // namespace

StressDifference stress_difference(const SpaceInput &in, const Comm &comm, const SpaceForms &forms, const Tractions &t,
                                   const Vector &u, const DeviceView<double *> &of_cell)
{
  if (forms.exact.extent(0) > 0) return difference_of_kinds(in, comm, forms, t, u, of_cell);
  StressDifference d;
  for_order(in.reference.degree, [&](const auto order) {
    constexpr int k = order.value;
    Kokkos::parallel_reduce("rpc::bound::stress_difference", device_range(in.num_owned_cells),
                            SpaceDifference<k>{in, forms, TetrahedronField<k>{in, device_read(u)}, t, of_cell},
                            d.energy, Kokkos::Max<double>(d.imbalance), Kokkos::Max<double>(d.force));
  });
  return over_ranks(comm, d);
}

StressDifference stress_difference(const HexahedraInput &in, const Comm &comm, const SpaceForms &forms,
                                   const Tractions &t, const FieldOfHexahedra &u, const DeviceView<double *> &of_cell)
{
  StressDifference d;
  const SpaceInput &split = in; // the tetrahedra alone
  Kokkos::parallel_reduce("rpc::bound::stress_difference_in_hexahedra", device_range(in.num_owned_cells),
                          SpaceDifference<1, FieldOfHexahedra>{split, forms, u, t, of_cell}, d.energy,
                          Kokkos::Max<double>(d.imbalance), Kokkos::Max<double>(d.force));
  return over_ranks(comm, d);
}

} // namespace rpc::bound
