// SPDX-License-Identifier: BSD-3-Clause
#include "space_cells.hpp"

#include "cell_kinds.hpp"
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

/// The integrals of products of a cell's stresses, by the compliance of their images: factors of the tables of pairs.
KOKKOS_INLINE_FUNCTION void factors_of_pairs(const double (&S)[6][6], double (&factor)[21])
{
  int pair = 0;
  for (int p = 0; p < 6; ++p) factor[pair++] = S[p][p];
  for (int p = 0; p < 6; ++p)
    for (int q = p + 1; q < 6; ++q) factor[pair++] = S[p][q];
}

/// First derivatives by tractions and inner stresses, from `first` on, that the body force adds in the reference cell.
template <int K>
KOKKOS_INLINE_FUNCTION void derivative_of_force(const SpaceInput &in, const AffineTetrahedron &cell,
                                                const double (&S)[6][6], const int first,
                                                double (&of_force)[SpaceSizes<K>::columns])
{
  double image[3][6];
  image_of_force(in, cell, image);
  for (int i = first; i < SpaceSizes<K>::columns; ++i) {
    of_force[i] = 0;
    for (int k = 0; k < 6; ++k)
      for (int l = 0; l < 3; ++l)
        for (int m = 0; m < 6; ++m) of_force[i] += in.reference.moment(k, l, i) * S[k][m] * image[l][m];
  }
}

/// L^-1 x for inner stresses, by the rows that factor_inner() leaves.
template <int K>
KOKKOS_INLINE_FUNCTION void forward_inner(const double *row, double *const x)
{
  constexpr int nt = SpaceSizes<K>::tractions;
  for (int i = nt; i < SpaceSizes<K>::columns; row += ++i) {
    for (int k = nt; k < i; ++k) x[i] -= row[k] * x[k];
    x[i] /= row[i];
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
    double S[6][6], factor[21], A[row_of_triangle(n)], of_force[n];
    compliance_of_images(in, cell, c, S);
    factors_of_pairs(S, factor);
    FloatProducts::sum_tables(in.reference.lower_energy.data(), in.reference.lower_energy.extent(1),
                              static_cast<int>(row_of_triangle(n)), factor, A);
    if (in.loaded()) derivative_of_force<K>(in, cell, S, 0, of_force);
    if constexpr (nz > 0) { // at their best
      double *const rows = A + row_of_triangle(nt);
      FloatProducts::factor_inner(nt, n, rows);
      FloatProducts::eliminate_inner(nt, n, A);
      for (std::size_t k = 0; k < out.inner.extent(1); ++k) out.inner(kind, k) = rows[k];
      if (in.loaded()) {
        forward_inner<K>(rows, of_force);
        for (int z = nt; z < n; ++z)
          for (int r = 0; r < nt; ++r) of_force[r] -= A[row_of_triangle(z) + r] * of_force[z];
      }
    }
    // From reference tractions to those of the facets: t^ = F^-1 t.
    const auto &G = cell.inverse;
    for (int p = 0; p < nt / 3; ++p)
      for (int q = 0; q <= p; ++q) {
        double block[3][3], half[3][3];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            block[i][j] =
                p == q && i < j ? A[row_of_triangle(3 * q + j) + 3 * p + i] : A[row_of_triangle(3 * p + i) + 3 * q + j];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            half[i][j] = block[i][0] * G[0][j] + block[i][1] * G[1][j] + block[i][2] * G[2][j];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            put(kind, 3 * p + i, 3 * q + j, G[0][i] * half[0][j] + G[1][i] * half[1][j] + G[2][i] * half[2][j]);
      }
    if (!in.loaded()) return;
    for (int p = 0; p < nt / 3; ++p)
      for (int i = 0; i < 3; ++i) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += G[k][i] * of_force[3 * p + k];
        out.b(kind, 3 * p + i) = sum;
      }
    for (int s = 0; s < 4; ++s) {
      double tau[3][3];
      traction_of_force(in, cell, c, s, tau);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const int at = s * Sizes::per_facet + 3 * j + i;
          for (int p = 0; p < nt; ++p) out.b(kind, p) -= out.second(kind, nt, p, at) * tau[j][i];
        }
    }
  }
  /// Of two entries that are alike the one in the lower triangle decides.
  KOKKOS_FUNCTION void put(const LO kind, const int i, const int j, const double a) const
  {
    constexpr int nt = Sizes::tractions;
    if (i < j) return;
    const auto rounded = static_cast<float>(a);
    if (out.lower)
      out.A(kind, row_of_triangle(i) + j) = rounded;
    else
      out.A(kind, i * nt + j) = out.A(kind, j * nt + i) = rounded;
    if (out.exact.extent(0) > 0) out.exact(kind, i, j) = out.exact(kind, j, i) = a;
  }
};

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
    const float *const A = forms.A.data() + kind * forms.A.extent(1);
    const double *const b = linear && in.loaded() ? forms.b.data() + static_cast<std::size_t>(kind) * nt : nullptr;
    const double product = FloatProducts::template of_cell<nt>(A, forms.lower, given, sign, b, y);
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

  /// In one tetrahedron.
  struct Here {
    static constexpr bool is_linear = K == 1; ///< the gradient is constant
    const TetrahedronField &field;
    const AffineTetrahedron &cell;
    LO c;

    KOKKOS_FUNCTION Here(const TetrahedronField &of, const AffineTetrahedron &in, const LO at)
        : field(of), cell(in), c(at)
    {
    }
    /// du_i / dx_j at a point of a part.
    KOKKOS_FUNCTION void gradient(const int s, const int q, double (&D)[3][3]) const
    {
      gradient_in_space(
          field.in, cell, c, field.u, [&](const int a, const int l) { return field.in.reference.gradient(s, q, a, l); },
          D);
    }
  };
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

  /// The inner stresses by the tractions of the image. Those of the kind will do: any are admissible.
  KOKKOS_FUNCTION void best_inner(const LO c, const AffineTetrahedron &cell, double (&x)[Sizes::columns]) const
  {
    constexpr int nt = Sizes::tractions, n = Sizes::columns;
    constexpr int size = static_cast<int>(row_of_triangle(n) - row_of_triangle(nt));
    double S[6][6], factor[21], found[size];
    const bool of_kind = forms.inner.extent(0) > 0;
    const double *const rows = of_kind ? forms.inner.data() + static_cast<std::size_t>(in.kind(c)) * size : found;
    if (!of_kind || in.loaded()) compliance_of_images(in, cell, c, S);
    if (!of_kind) {
      factors_of_pairs(S, factor);
      FloatProducts::sum_tables(in.reference.lower_energy.data() + row_of_triangle(nt),
                                in.reference.lower_energy.extent(1), size, factor, found);
      FloatProducts::factor_inner(nt, n, found);
    }
    for (int z = nt; z < n; ++z) x[z] = 0;
    if (in.loaded()) {
      derivative_of_force<K>(in, cell, S, nt, x);
      forward_inner<K>(rows, x);
    }
    const double *row = rows;
    for (int z = nt; z < n; row += ++z) {
      double parts[4] = {};
      for (int i = 0; i < nt; i += 4)
        for (int k = 0; k < 4; ++k) parts[k] += row[i + k] * x[i + k];
      for (const double part : parts) x[z] += part;
    }
    for (int i = n - 1; i >= nt; --i) {
      row -= i + 1;
      x[i] /= -row[i];
      for (int k = nt; k < i; ++k) x[k] += row[k] * x[i];
    }
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
    if constexpr (nz > 0) best_inner(c, cell, x);
    double coefficient[Sizes::coefficients];
    for (double &value : coefficient) value = 0;
    const double *column = in.reference.by_column.data();
    for (int i = 0; i < Sizes::columns; i += 2, column += 2 * Sizes::coefficients)
      for (int k = 0; k < Sizes::coefficients; ++k)
        coefficient[k] += column[k] * x[i] + column[Sizes::coefficients + k] * x[i + 1];
    double T[6][6], energy = 0, of_u[3][3] = {};
    cell.stress_map(T);
    const double lambda = in.lame(in.block(c), 0), mu = in.lame(in.block(c), 1), a = lambda / (3 * lambda + 2 * mu);
    const typename Field::Here here(u, cell, c);
    for (int s = 0; s < 4; ++s) {
      double stress[6][nm] = {}; // by monomials
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          for (int m = 0; m < nm; ++m) stress[i][m] += T[i][j] * coefficient[(s * 6 + j) * nm + m];
      for (int i = 0; in.loaded() && i < 3; ++i)
        for (int l = 0; l < 3; ++l) stress[i][1 + l] -= in.force[i] * cell.F[i][l];
      for (int q = 0; q < static_cast<int>(in.reference.weight.extent(1)); ++q) {
        if (!Field::Here::is_linear || q + s == 0) {
          double D[3][3];
          here.gradient(s, q, D);
          stress_of_gradient(lambda, mu, D, of_u);
        }
        double off[6], squares = 0;
        for (int component = 0; component < 6; ++component) {
          int i, j;
          AffineTetrahedron::entry(component, i, j);
          off[component] = -of_u[i][j];
          for (int m = 0; m < nm; ++m) off[component] += stress[component][m] * in.reference.value(s, q, m);
          squares += (component < 3 ? 1 : 2) * off[component] * off[component];
        }
        const double trace = off[0] + off[1] + off[2];
        energy += in.reference.weight(s, q) * cell.determinant * (squares - a * trace * trace) / (4 * mu); // (13.2)
      }
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
  forms.lower = all_differ(in);
  forms.A = decltype(forms.A)(Kokkos::view_alloc("rpc::bound::A", Kokkos::WithoutInitializing), kinds,
                              forms.lower ? row_of_triangle(nt) : static_cast<std::size_t>(nt) * nt);
  if (energies_by_kinds(in)) forms.exact = decltype(forms.exact)("rpc::bound::exact", kinds, nt, nt);
  forms.b = decltype(forms.b)("rpc::bound::b", in.loaded() ? kinds : 0, nt);
  if (!forms.lower && in.reference.inner > 0)
    forms.inner = decltype(forms.inner)("rpc::bound::inner", kinds,
                                        row_of_triangle(in.reference.columns()) - row_of_triangle(nt));
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
