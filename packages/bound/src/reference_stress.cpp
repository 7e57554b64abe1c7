// SPDX-License-Identifier: BSD-3-Clause
#include "reference_stress.hpp"

#include "dense.hpp"
#include "facet_polynomials.hpp"
#include "gauss.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/fem/basis.hpp"
#include "rpc/mesh/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace rpc::bound
{
namespace
{

using Place = std::array<double, 3>; // in the plane the last one is 0

Place difference(const Place &a, const Place &b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double along_of(const Place &a, const Place &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Of symmetric stresses xx yy xy, or xx yy zz yz xz xy.
int component_of(const int dim, const int i, const int j)
{
  if (i == j) return i;
  return dim == 2 ? 2 : 6 - i - j;
}

/// The reference cell, split, with the stresses of some degree. Part s is what the centre makes with facet s.
struct SplitCell {
  int dim, sides, degree, monomials, components;
  std::vector<Place> vertex;           // relative to the centre
  std::vector<std::vector<int>> facet; // its vertices
  std::vector<std::array<int, 3>> power;
  Place centre{};

  SplitCell(const mesh::Element &element, const int k)
      : dim(element.dim), sides(element.num_facets()), degree(k), components(dim * (dim + 1) / 2)
  {
    for (int v = 0; v < element.num_vertices(); ++v) {
      Place x{};
      for (int d = 0; d < dim; ++d) {
        const double on_lattice = element.lattice()[v][d];
        x[d] = element.shape == mesh::Shape::simplex ? on_lattice / element.order : 2 * on_lattice / element.order - 1;
        centre[d] += x[d] / element.num_vertices();
      }
      vertex.push_back(x);
    }
    for (Place &x : vertex)
      for (int d = 0; d < dim; ++d) x[d] -= centre[d];
    for (int s = 0; s < sides; ++s) {
      RPC_REQUIRE_CODE(dim == 3 || (element.facets()[s][0] == s && element.facets()[s][1] == (s + 1) % sides),
                       ExitCode::internal_error,
                       "bound: side " << s << " of " << element.name() << " does not follow its vertex");
      facet.push_back({});
      for (int v = 0; v < element.num_vertices(); ++v) // of tetrahedra side s lies opposite vertex s
        if (dim == 3 && v != s) facet[s].push_back(v);
      if (dim == 2) facet[s] = {s, (s + 1) % sides};
    }
    for (int n = 0; n <= k; ++n)
      for (int b = 0; b <= n; ++b)
        for (int c = 0; c <= (dim == 3 ? b : 0); ++c) power.push_back({n - b, b - c, c});
    monomials = static_cast<int>(power.size());
  }
  int coefficients() const { return components * sides * monomials; }
  int at(const int part, const int component, const int m) const
  {
    return (part * components + component) * monomials + m;
  }
  double monomial(const int m, const Place &x) const
  {
    return std::pow(x[0], power[m][0]) * std::pow(x[1], power[m][1]) * std::pow(x[2], power[m][2]);
  }
  Place on_facet(const int s, const Barycentric &at) const
  {
    Place x{};
    for (int v = 0; v < dim; ++v)
      for (int d = 0; d < dim; ++d) x[d] += at[v] * vertex[facet[s][v]][d];
    return x;
  }
  /// Normal of a line or a triangle by its corners, as long as its size.
  Place normal_of(const Place &a, const Place &b, const Place &c) const
  {
    const Place e = difference(b, a), f = difference(c, a);
    if (dim == 2) return {e[1], -e[0], 0};
    return {(e[1] * f[2] - e[2] * f[1]) / 2, (e[2] * f[0] - e[0] * f[2]) / 2, (e[0] * f[1] - e[1] * f[0]) / 2};
  }
  /// Outward.
  Place normal(const int s) const
  {
    const Place &a = vertex[facet[s][0]];
    Place n = normal_of(a, vertex[facet[s][1]], vertex[facet[s][dim - 1]]);
    const double toward = along_of(n, a) > 0 ? 1 : -1;
    for (double &x : n) x *= toward;
    return n;
  }
  /// row(s) += factor * (component of s n) at a point of a part.
  void add_traction(Dense &rows, const int row, const int part, const int component, const Place &x, const Place &n,
                    const double factor) const
  {
    for (int d = 0; d < dim; ++d)
      for (int m = 0; m < monomials; ++m)
        rows(row, at(part, component_of(dim, component, d), m)) += factor * n[d] * monomial(m, x);
  }
};

/// Where two parts meet: the corners that they have in common besides the centre.
struct Interface {
  int part[2];
  std::vector<int> vertices;
};

std::vector<Interface> interfaces(const SplitCell &c)
{
  std::vector<Interface> all;
  for (int s = 0; s < c.sides; ++s)
    for (int r = 0; r < s; ++r) {
      Interface common{{s, r}, {}};
      for (const int v : c.facet[s])
        if (std::find(c.facet[r].begin(), c.facet[r].end(), v) != c.facet[r].end()) common.vertices.push_back(v);
      if (static_cast<int>(common.vertices.size()) == c.dim - 1) all.push_back(common);
    }
  return all;
}

/// Points that determine polynomials of degree k on the line or the triangle from the centre to these vertices.
std::vector<Place> lattice_points(const SplitCell &c, const std::vector<int> &vertices)
{
  std::vector<Place> all;
  const double k = c.degree;
  for (int i = 0; i <= c.degree; ++i)
    for (int j = 0; j <= (c.dim == 3 ? c.degree - i : 0); ++j) {
      Place x{};
      for (int d = 0; d < c.dim; ++d) {
        x[d] = i / k * c.vertex[vertices[0]][d];
        if (c.dim == 3) x[d] += j / k * c.vertex[vertices[1]][d];
      }
      all.push_back(x);
    }
  return all;
}

/// Jumps of tractions across the inner lines or triangles, and the polynomials of the divergence.
Dense conditions(const SplitCell &c)
{
  const std::vector<Interface> inner = interfaces(c);
  const auto lower = [&](const std::array<int, 3> &power) { return power[0] + power[1] + power[2] < c.degree; };
  const int of_divergence = static_cast<int>(std::count_if(c.power.begin(), c.power.end(), lower)),
            points = FacetPolynomials::count(c.dim, c.degree);
  Dense rows(c.dim * (static_cast<int>(inner.size()) * points + c.sides * of_divergence), c.coefficients());
  int row = 0;
  for (const Interface &between : inner) {
    const Place n = c.normal_of({}, c.vertex[between.vertices[0]], c.vertex[between.vertices[c.dim - 2]]);
    for (const Place &x : lattice_points(c, between.vertices))
      for (int component = 0; component < c.dim; ++component, ++row) {
        c.add_traction(rows, row, between.part[0], component, x, n, 1);
        c.add_traction(rows, row, between.part[1], component, x, n, -1);
      }
  }
  for (int part = 0; part < c.sides; ++part)
    for (int component = 0; component < c.dim; ++component) {
      for (int m = 0; m < c.monomials; ++m)
        for (int d = 0; d < c.dim; ++d) {
          std::array<int, 3> power = c.power[m];
          if (power[d]-- == 0) continue;
          const auto found = std::find(c.power.begin(), c.power.end(), power);
          rows(row + static_cast<int>(found - c.power.begin()), c.at(part, component_of(c.dim, component, d), m)) +=
              c.power[m][d];
        }
      row += of_divergence;
    }
  return rows;
}

/// Coefficients of the tractions times the sizes of facets, by the polynomials of each.
Dense tractions_of(const SplitCell &c)
{
  const FacetPolynomials polynomials(c.dim, c.degree);
  Dense rows(c.dim * polynomials.size() * c.sides, c.coefficients());
  const FacetRule rule = facet_rule(c.dim, c.degree + 1);
  int row = 0;
  for (int s = 0; s < c.sides; ++s)
    for (int j = 0; j < polynomials.size(); ++j)
      for (int component = 0; component < c.dim; ++component, ++row)
        for (int q = 0; q < rule.size(); ++q)
          c.add_traction(rows, row, s, component, c.on_facet(s, rule.point[q]), c.normal(s),
                         rule.weight[q] * polynomials(j, rule.point[q]) / polynomials.square(j));
  return rows;
}

/// Points of each part.
struct PartPoints {
  std::vector<Place> point; // (sides * points)
  std::vector<double> weight;
};
/// Exact for polynomials up to degree 2 n - dim.
PartPoints part_points(const SplitCell &c, const int n)
{
  PartPoints p;
  const Gauss line = gauss(n);
  const FacetRule across = facet_rule(c.dim, n);
  for (int s = 0; s < c.sides; ++s) {
    const double volume = along_of(c.normal(s), c.vertex[c.facet[s][0]]); // times dim
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < across.size(); ++j) {
        const double r = line.point[i];
        const Place x = c.on_facet(s, across.point[j]);
        p.point.push_back({r * x[0], r * x[1], r * x[2]});
        p.weight.push_back(line.weight[i] * across.weight[j] * (c.dim == 2 ? r : r * r) * volume);
      }
  }
  return p;
}

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

/// Stresses of the tractions and inner ones, in columns.
struct Columns {
  Dense of_tractions, inner;
};
Columns columns_of(const SplitCell &c)
{
  const Dense admissible = kernel_of(conditions(c)).basis;
  const Kernel k = kernel_of(product(tractions_of(c), admissible));
  const int rank = admissible.cols - k.basis.cols,
            wanted = c.dim * FacetPolynomials::count(c.dim, c.degree) * c.sides - (c.dim == 2 ? 3 : 6);
  RPC_REQUIRE_CODE(rank == wanted, ExitCode::internal_error,
                   "bound: stresses of degree " << c.degree << " have " << rank << " independent tractions instead of "
                                                << wanted);
  return {product(admissible, k.inverse), product(admissible, k.basis)};
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
