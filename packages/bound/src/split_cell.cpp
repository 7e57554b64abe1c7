// SPDX-License-Identifier: BSD-3-Clause
#include "split_cell.hpp"

#include "gauss.hpp"

#include <algorithm>

namespace rpc::bound
{
namespace
{

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

} // namespace

Dense jumps_in(const SplitCell &c)
{
  const std::vector<Interface> inner = interfaces(c);
  Dense rows(c.dim * static_cast<int>(inner.size()) * FacetPolynomials::count(c.dim, c.degree), c.coefficients());
  int row = 0;
  for (const Interface &between : inner) {
    const Place n = c.normal_of({}, c.vertex[between.vertices[0]], c.vertex[between.vertices[c.dim - 2]]);
    for (const Place &x : lattice_points(c, between.vertices))
      for (int component = 0; component < c.dim; ++component, ++row) {
        c.add_traction(rows, row, between.part[0], component, x, n, 1);
        c.add_traction(rows, row, between.part[1], component, x, n, -1);
      }
  }
  return rows;
}

Dense divergence_in(const SplitCell &c)
{
  const auto lower = [&](const std::array<int, 3> &power) { return power[0] + power[1] + power[2] < c.degree; };
  const int per_part = static_cast<int>(std::count_if(c.power.begin(), c.power.end(), lower));
  Dense rows(c.sides * c.dim * per_part, c.coefficients());
  for (int part = 0; part < c.sides; ++part)
    for (int component = 0; component < c.dim; ++component)
      for (int m = 0; m < c.monomials; ++m)
        for (int d = 0; d < c.dim; ++d) {
          std::array<int, 3> power = c.power[m];
          if (power[d]-- == 0) continue;
          const int found = static_cast<int>(std::find(c.power.begin(), c.power.end(), power) - c.power.begin());
          rows((part * c.dim + component) * per_part + found, c.at(part, component_of(c.dim, component, d), m)) +=
              c.power[m][d];
        }
  return rows;
}

Dense tractions_in(const SplitCell &c)
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

Columns columns_of(const SplitCell &c, const Dense &admissible, const int balances)
{
  const Kernel k = kernel_of(product(tractions_in(c), admissible));
  const int rank = admissible.cols - k.basis.cols,
            wanted = c.dim * FacetPolynomials::count(c.dim, c.degree) * c.sides - balances;
  RPC_REQUIRE_CODE(rank == wanted, ExitCode::internal_error,
                   "bound: stresses of degree " << c.degree << " have " << rank << " independent tractions instead of "
                                                << wanted);
  return {product(admissible, k.inverse), product(admissible, k.basis)};
}

} // namespace rpc::bound
