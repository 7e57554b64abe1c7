// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "dense.hpp"
#include "facet_polynomials.hpp"
#include "rpc/core/error.hpp"
#include "rpc/mesh/element.hpp"

#include <array>
#include <cmath>
#include <vector>

/// The reference cell that its centre splits, and piecewise polynomials on its parts. On the host.
namespace rpc::bound
{

using Place = std::array<double, 3>; // in the plane the last one is 0

inline Place difference_of(const Place &a, const Place &b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double along_of(const Place &a, const Place &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Of symmetric stresses xx yy xy, or xx yy zz yz xz xy.
inline int component_of(const int dim, const int i, const int j)
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
    const Place e = difference_of(b, a), f = difference_of(c, a);
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

/// Points of each part.
struct PartPoints {
  std::vector<Place> point; // (sides * points)
  std::vector<double> weight;
};
/// Exact for polynomials up to degree 2 n - dim.
PartPoints part_points(const SplitCell &c, int n);

/// Jumps of tractions across the inner lines or triangles.
Dense jumps_in(const SplitCell &c);
/// Polynomials of the divergence, by its part, component and monomials of less than the degree.
Dense divergence_in(const SplitCell &c);
/// Coefficients of the tractions times the sizes of facets, by the polynomials of each.
Dense tractions_in(const SplitCell &c);

/// Stresses of the tractions and inner ones, in columns.
struct Columns {
  Dense of_tractions, inner;
};
/// Those of a space of stresses. @param balances  how many conditions its tractions have
Columns columns_of(const SplitCell &c, const Dense &admissible, int balances);

} // namespace rpc::bound
