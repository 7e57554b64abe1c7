// SPDX-License-Identifier: BSD-3-Clause
#include "reference_stress.hpp"

#include "float_products.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/fem/basis.hpp"
#include "rpc/mesh/quadrature.hpp"
#include "split_cell.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace rpc::bound
{
namespace
{

/// int s_c t_d over the cell, as a matrix between coefficients.
class Masses
{
public:
  explicit Masses(const SplitCell &c) : c_(c)
  {
    const PartPoints p = part_points(c, c.degree + 2);
    const int per_part = static_cast<int>(p.weight.size()) / c.sides;
    std::vector<double> value(c.monomials);
    for (int s = 0; s < c.sides; ++s) {
      of_part_.emplace_back(c.monomials, c.monomials);
      for (int q = s * per_part; q < (s + 1) * per_part; ++q) {
        for (int m = 0; m < c.monomials; ++m) value[m] = c.monomial(m, p.point[q]);
        for (int i = 0; i < c.monomials; ++i)
          for (int j = 0; j < c.monomials; ++j) of_part_[s](i, j) += p.weight[q] * value[i] * value[j];
      }
    }
  }
  Dense operator()(const int component, const int other) const
  {
    Dense m(c_.coefficients(), c_.coefficients());
    for (int s = 0; s < c_.sides; ++s)
      for (int i = 0; i < c_.monomials; ++i)
        for (int j = 0; j < c_.monomials; ++j) m(c_.at(s, component, i), c_.at(s, other, j)) = of_part_[s](i, j);
    return m;
  }

private:
  const SplitCell &c_;
  std::vector<Dense> of_part_;
};

/// Products of the columns of stresses, by pairs of components: each with itself, then with those after it.
EnergyTable energies(const SplitCell &c, const Dense &stress)
{
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < c.components; ++i) pairs.push_back({i, i});
  for (int i = 0; i < c.components; ++i)
    for (int j = i + 1; j < c.components; ++j) pairs.push_back({i, j});
  const Masses mass(c);
  const Dense left = transposed(stress);
  EnergyTable table("rpc::bound::energies", pairs.size(), stress.cols, stress.cols);
  const auto host = Kokkos::create_mirror_view(table);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Dense e = product(left, product(mass(pairs[p][0], pairs[p][1]), stress));
    const bool both = pairs[p][0] != pairs[p][1];
    for (int i = 0; i < stress.cols; ++i)
      for (int j = 0; j < stress.cols; ++j) host(p, i, j) = both ? e(i, j) + e(j, i) : e(i, j);
  }
  Kokkos::deep_copy(table, host);
  return table;
}

/// The rows of the lower triangles, one after another.
Kokkos::View<double **, Kokkos::LayoutRight, Device> lower_rows(const EnergyTable &table)
{
  const std::size_t n = table.extent(1);
  Kokkos::View<double **, Kokkos::LayoutRight, Device> lower("rpc::bound::lower_energy", table.extent(0),
                                                             row_of_triangle(n));
  const auto from = to_host(table);
  const auto to = Kokkos::create_mirror_view(lower);
  for (std::size_t p = 0; p < table.extent(0); ++p)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j) to(p, row_of_triangle(i) + j) = from(p, i, j);
  Kokkos::deep_copy(lower, to);
  return lower;
}

/// Stresses without divergence.
Columns columns_of(const SplitCell &c)
{
  return columns_of(c, kernel_of(stacked(jumps_in(c), divergence_in(c))).basis, c.dim == 2 ? 3 : 6);
}

template <class View = DeviceView<double **>>
View table_of(const Dense &x, const std::string &label)
{
  View table(label, x.rows, x.cols);
  const auto host = Kokkos::create_mirror_view(table);
  for (int i = 0; i < x.rows; ++i)
    for (int j = 0; j < x.cols; ++j) host(i, j) = x(i, j);
  Kokkos::deep_copy(table, host);
  return table;
}

/// Gradients of the shape functions at points relative to the centre: (sides, points, nodes, dim).
DeviceView<double ****> gradients(const mesh::Element &element, const SplitCell &c, const std::vector<Place> &points)
{
  const int nodes = element.num_nodes(), per_side = static_cast<int>(points.size()) / c.sides;
  DeviceView<double ****> table("rpc::bound::gradients", c.sides, per_side, nodes, c.dim);
  const auto host = Kokkos::create_mirror_view(table);
  mesh::QuadratureRule rule;
  for (const Place &x : points) {
    rule.point.push_back({x[0] + c.centre[0], x[1] + c.centre[1], x[2] + c.centre[2]});
    rule.weight.push_back(1);
  }
  const fem::BasisTable basis = fem::tabulate(element, rule);
  const auto gradient = to_host(basis.gradient);
  for (int q = 0; q < static_cast<int>(points.size()); ++q)
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < c.dim; ++d) host(q / per_side, q % per_side, a, d) = gradient(q, a, d);
  Kokkos::deep_copy(table, host);
  return table;
}

/// Points for squares of stresses; of Q2 the gradients have degree 3.
PartPoints points_of_squares(const mesh::Element &element, const SplitCell &c)
{
  const bool simplex = element.shape == mesh::Shape::simplex;
  if (c.dim == 2) return part_points(c, element.order == 2 && !simplex ? 4 : c.degree + 1);
  const mesh::QuadratureRule rule = mesh::quadrature(3, mesh::Shape::simplex, 2 * c.degree);
  PartPoints p;
  for (int s = 0; s < c.sides; ++s)
    for (int q = 0; q < rule.num_points(); ++q) {
      const auto &at = rule.point[q];
      p.point.push_back({});
      for (int v = 0; v < 3; ++v) // the last corner is the centre
        for (int d = 0; d < 3; ++d) p.point.back()[d] += at[v] * c.vertex[c.facet[s][v]][d];
      p.weight.push_back(rule.weight[q] * 2 * along_of(c.normal(s), c.vertex[c.facet[s][0]]));
    }
  return p;
}

} // namespace

ReferenceStress reference_stress(const mesh::Element &element)
{
  const SplitCell c(element, element.order);
  const Columns columns = columns_of(c);
  ReferenceStress r;
  r.dim = c.dim;
  r.sides = c.sides;
  r.degree = c.degree;
  r.monomials = c.monomials;
  r.tractions = columns.of_tractions.cols;
  r.inner = columns.inner.cols;
  RPC_REQUIRE_CODE(r.columns() <= (c.dim == 2 ? ReferenceStress::most_columns : ReferenceStress::most_columns_in_space),
                   ExitCode::internal_error, "bound: " << r.columns() << " stresses of a cell");
  Dense all(c.coefficients(), r.columns());
  for (int i = 0; i < all.rows; ++i)
    for (int j = 0; j < all.cols; ++j)
      all(i, j) = j < r.tractions ? columns.of_tractions(i, j) : columns.inner(i, j - r.tractions);
  r.stress = table_of(all, "rpc::bound::stress");
  r.by_column = table_of<decltype(r.by_column)>(transposed(all), "rpc::bound::by_column");
  r.energy = energies(c, all);
  if (c.dim == 3) r.lower_energy = lower_rows(r.energy);
  const PartPoints points = points_of_squares(element, c);
  const int per_part = static_cast<int>(points.weight.size()) / c.sides;
  r.value = DeviceView<double ***>("rpc::bound::value", c.sides, per_part, c.monomials);
  r.weight = DeviceView<double **>("rpc::bound::weight", c.sides, per_part);
  r.moment = DeviceView<double ***>("rpc::bound::moment", c.components, c.dim, r.columns());
  const auto value = Kokkos::create_mirror_view(r.value);
  const auto weight = Kokkos::create_mirror_view(r.weight);
  const auto moment = Kokkos::create_mirror_view(r.moment);
  for (int s = 0; s < c.sides; ++s)
    for (int q = 0; q < per_part; ++q) {
      const Place &x = points.point[s * per_part + q];
      weight(s, q) = points.weight[s * per_part + q];
      for (int m = 0; m < c.monomials; ++m) value(s, q, m) = c.monomial(m, x);
      for (int component = 0; component < c.components; ++component)
        for (int l = 0; l < c.dim; ++l)
          for (int j = 0; j < r.columns(); ++j)
            for (int m = 0; m < c.monomials; ++m)
              moment(component, l, j) += weight(s, q) * x[l] * value(s, q, m) * all(c.at(s, component, m), j);
    }
  Kokkos::deep_copy(r.value, value);
  Kokkos::deep_copy(r.weight, weight);
  Kokkos::deep_copy(r.moment, moment);
  r.gradient = gradients(element, c, points.point);
  const FacetRule rule = facet_rule(c.dim, 3);
  std::vector<Place> on_sides;
  for (int s = 0; s < c.sides; ++s)
    for (const Barycentric &at : rule.point) on_sides.push_back(c.on_facet(s, at));
  r.side_gradient = gradients(element, c, on_sides);
  std::vector<double> along;
  for (const Barycentric &at : rule.point) along.push_back(at[1]);
  r.side_point = device_values(along, "rpc::bound::side_point");
  r.side_weight = device_values(rule.weight, "rpc::bound::side_weight");
  return r;
}

LiftedLoads lifted_loads(const mesh::Element &element)
{
  const int k = element.order, dim = element.dim, degree = ReferenceStress::degree_of_loads_in(dim);
  const SplitCell c(element, degree);
  const Columns columns = columns_of(c);
  Dense weight(c.coefficients(), c.coefficients()); // of |s|^2: the least stress in the reference cell
  const Masses mass(c);
  for (int component = 0; component < c.components; ++component) {
    const Dense m = mass(component, component);
    for (std::size_t i = 0; i < m.a.size(); ++i) weight.a[i] += (component < dim ? 1 : 2) * m.a[i];
  }
  const Dense by_weight = product(transposed(columns.inner), weight);
  const Dense correction =
      product(columns.inner, solved_spd(product(by_weight, columns.inner), product(by_weight, columns.of_tractions)));
  const int own = FacetPolynomials::count(dim, k), all = FacetPolynomials::count(dim, degree);
  LiftedLoads lifted;
  lifted.columns = c.sides * (all - own) * dim;
  Dense stress(c.coefficients(), lifted.columns);
  for (int s = 0; s < c.sides; ++s)
    for (int j = own; j < all; ++j)
      for (int component = 0; component < dim; ++component) {
        const int from = (s * all + j) * dim + component, to = (s * (all - own) + j - own) * dim + component;
        for (int i = 0; i < stress.rows; ++i) stress(i, to) = columns.of_tractions(i, from) - correction(i, from);
      }
  lifted.energy = energies(c, stress);
  return lifted;
}

} // namespace rpc::bound
