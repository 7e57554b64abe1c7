// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_pressure.hpp"
#include "facets.hpp"
#include "gauss.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/evaluate.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace rpc::bound
{

/// The host's copy of the facets of a mesh's sides.
struct OnHost {
  const mesh::Mesh &mesh;
  HostView<LO **> of_cell;
  HostView<LO *[2]> cell, node;
  HostView<LO *> middle;
  HostView<double **> coords;
  static constexpr int points_of_fields = 8; // of loads and gaps on a facet

  OnHost(const mesh::Mesh &m, const Facets &f)
      : mesh(m), of_cell("", f.of_cell.extent(0), f.of_cell.extent(1)), cell("", f.size()), node("", f.size()),
        middle("", f.size()), coords("", m.coords.extent(0), 2)
  {
    const auto all = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), f.of_cell);
    for (std::size_t c = 0; c < all.extent(0); ++c)
      for (std::size_t s = 0; s < all.extent(1); ++s) of_cell(c, s) = all(c, s);
    const auto cells = to_host(f.cell), nodes = to_host(f.node);
    const auto middles = to_host(f.middle);
    const auto x = to_host(m.coords);
    for (LO e = 0; e < f.size(); ++e) {
      middle(e) = middles(e);
      for (int k = 0; k < 2; ++k) {
        cell(e, k) = cells(e, k);
        node(e, k) = nodes(e, k);
      }
    }
    for (std::size_t i = 0; i < x.extent(0); ++i)
      for (int d = 0; d < 2; ++d) coords(i, d) = x(i, d);
  }
  /// Numbers of the facets of a side. Collective.
  std::vector<LO> facets_of(const mesh::Side &side) const
  {
    const auto cells = to_host(side.cell);
    const auto ordinals = to_host(side.ordinal);
    std::vector<LO> all;
    int inside = 0;
    for (std::size_t k = 0; k < cells.extent(0); ++k) {
      all.push_back(of_cell(cells(k), ordinals(k)));
      if (cell(all.back(), 1) >= 0) inside = 1;
    }
    RPC_REQUIRE(max_all(mesh.comm(), inside) == 0,
                "deck: \"Adapt->Error Bound\" = guaranteed covers sides on the boundary of the body; side \""
                    << side.name << "\" lies within it. Write \"estimated\"");
    return all;
  }
  std::array<double, 2> edge(const LO f) const
  {
    return {coords(node(f, 1), 0) - coords(node(f, 0), 0), coords(node(f, 1), 1) - coords(node(f, 0), 1)};
  }
  double length_of(const LO f) const { return std::hypot(edge(f)[0], edge(f)[1]); }
  /// Points of a quadrature rule on facets, (facets * points, 2).
  HostView<double **> points(const std::vector<LO> &facets, const Gauss &rule) const
  {
    const std::size_t n = rule.point.size();
    HostView<double **> x("rpc::bound::points", facets.size() * n, 2);
    for (std::size_t e = 0; e < facets.size(); ++e)
      for (std::size_t q = 0; q < n; ++q)
        for (int d = 0; d < 2; ++d)
          x(e * n + q, d) = coords(node(facets[e], 0), d) + rule.point[q] * edge(facets[e])[d];
    return x;
  }
};

/// What integrals over the section are to be multiplied with: of a body of revolution the circle that a point describes [m].
inline double around(const bool revolution, const double r)
{
  return revolution ? 2 * std::acos(-1.) * r : 1;
}

/// What the elements make of values at the ends and in the middle of a facet, at a point of it.
inline double at_point(const int order, const OfFacet &g, const double s)
{
  if (order == 1) return g[0] + s * (g[1] - g[0]);
  return g[0] * (1 - s) * (1 - 2 * s) + g[1] * s * (2 * s - 1) + g[2] * 4 * s * (1 - s);
}

} // namespace rpc::bound
