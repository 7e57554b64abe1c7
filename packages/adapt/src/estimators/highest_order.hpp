// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_terms.hpp"

namespace rpc::adapt
{

/// How deep the foundation may give way, and how large the pressure may be where it yields and hardens: with what the highest order of the
/// facets adds along edges along which it does.                                                    doc/theory.md (10.8c)
struct HighestOrder {
  ContactTerms terms; // in
  int num_vertices;   // of a facet, in

  KOKKOS_FUNCTION double at(const LO f, const int a, const int column) const
  {
    return terms.field(terms.facets(f, a), column);
  }

  /// What the highest order adds along an edge from vertex a to b, with the node m between them where the order is 2.
  KOKKOS_FUNCTION double added(const LO f, const int a, const int b, const int m, const int column) const
  {
    const double difference =
        m < 0 ? at(f, a, column) - at(f, b, column) : at(f, a, column) - 2 * at(f, m, column) + at(f, b, column);
    return difference < 0 ? -difference : difference;
  }

  /// @param depth  max of how deep, [m]   @param most  max of the pressure [Pa]
  KOKKOS_FUNCTION void operator()(const LO f, double &depth, double &most) const
  {
    if (terms.cell(f) >= terms.num_owned_cells) return;
    const bool quadratic = static_cast<int>(terms.facets.extent(1)) > num_vertices;
    const bool middles_alone = quadratic && num_vertices == 3; // vertices of quadratic triangles have no weight
    for (int a = 0; a < (num_vertices == 2 ? 1 : num_vertices); ++a) {
      const int b = (a + 1) % num_vertices, m = quadratic ? num_vertices + a : -1;
      const double deeper = added(f, a, b, m, int(pressed)), more = added(f, a, b, m, int(pressure));
      const int nodes[3] = {m, a, b};
      // All along the edge: beside a jump of the gap, and where the foundation begins to give way, the difference is that of a kink.
      bool gives_way = true;
      for (int k = quadratic ? 0 : 1; k < 3; ++k)
        gives_way = gives_way && at(f, nodes[k], pressure) > 0 && at(f, nodes[k], pressed) > 0;
      if (!gives_way) continue;
      for (int k = quadratic ? 0 : 1; k < (middles_alone ? 1 : 3); ++k) {
        const double p = at(f, nodes[k], pressure), w = at(f, nodes[k], pressed);
        depth = math::fmax(depth, w + deeper);
        const contact::Foundation law = terms.law_at(f, nodes[k]);
        if (contact::hardens(law) && p >= contact::yield_limit(law)) most = math::fmax(most, p + more);
      }
    }
  }
};

} // namespace rpc::adapt
