// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "facet_polynomials.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/point.hpp"
#include "space_facets.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace rpc::bound
{

/// The host's view of the facets of a mesh's sides.
struct SpaceFacetsOnHost {
  template <class View>
  using Host = decltype(to_host(std::declval<const View &>()));
  const mesh::Mesh &mesh;
  Host<DeviceView<LO **>> nodes_of_cell, node;
  Host<DeviceView<LO *[4]>> of_cell;
  Host<DeviceView<LO *[2]>> cell;
  Host<decltype(mesh::Mesh::coords)> coords;

  SpaceFacetsOnHost(const mesh::Mesh &m, const SpaceFacets &f)
      : mesh(m), nodes_of_cell(to_host(f.nodes_of_cell)), node(to_host(f.node)), of_cell(to_host(f.of_cell)),
        cell(to_host(f.cell)), coords(to_host(m.coords))
  {
  }
  /// Numbers of the facets of a side. Collective.
  std::vector<LO> facets_of(const mesh::Side &side) const
  {
    const auto cells = to_host(side.cell);
    const auto ordinals = to_host(side.ordinal);
    const auto given = to_host(mesh.cells);
    std::vector<LO> all;
    int within = 0;
    for (std::size_t k = 0; k < cells.extent(0); ++k) {
      const auto &local = mesh.element.facets()[ordinals(k)];
      int opposite = 0;
      for (int v = 0; v < 4; ++v) {
        bool on_it = false;
        for (int a = 0; a < 3; ++a) on_it = on_it || given(cells(k), local[a]) == nodes_of_cell(cells(k), v);
        if (!on_it) opposite = v;
      }
      all.push_back(of_cell(cells(k), opposite));
      if (cell(all.back(), 1) != SpaceFacets::none) within = 1;
    }
    RPC_REQUIRE(max_all(mesh.comm(), within) == 0,
                "deck: \"Adapt->Error Bound\" = guaranteed covers sides on the boundary of the body; side \""
                    << side.name << "\" lies within it. Write \"estimated\"");
    return all;
  }
  Point corner(const LO f, const int v) const
  {
    return {coords(node(f, v), 0), coords(node(f, v), 1), coords(node(f, v), 2)};
  }
  /// Normal as long as the area.
  Point normal(const LO f) const
  {
    const Point a = corner(f, 0), b = corner(f, 1), c = corner(f, 2);
    Point n;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      n[i] = ((b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j])) / 2;
    }
    return n;
  }
  double area(const LO f) const
  {
    const Point n = normal(f);
    return std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
  /// Points of a rule on facets, (facets * points, 3).
  HostView<double **> points(const std::vector<LO> &facets, const FacetRule &rule) const
  {
    const std::size_t n = rule.size();
    HostView<double **> x("rpc::bound::points", facets.size() * n, 3);
    for (std::size_t e = 0; e < facets.size(); ++e)
      for (std::size_t q = 0; q < n; ++q)
        for (int v = 0; v < 3; ++v)
          for (int d = 0; d < 3; ++d) x(e * n + q, d) += rule.point[q][v] * coords(node(facets[e], v), d);
    return x;
  }
};

} // namespace rpc::bound
