// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_terms.hpp"

namespace rpc::adapt
{

/// What the ends of a smooth contact leave open of forces: they lie anywhere between two nodes, and a force is the derivative by the motion of the
/// energy, which depends on where.                                                                 doc/theory.md (10.7g)
struct ContactEnds {
  ContactTerms terms; // in
  int order;          // of the elements, in
  static constexpr double factor = 3.14159265358979323846 / 32;

  /// @param sum, squares  += of A p^2 pi/(32 order^2), and its square, p the largest pressure of an owned facet that is partly open [N Pa], in 2D per m
  /// @param force         += integral of the pressure [N], in 2D per m
  KOKKOS_FUNCTION void operator()(const LO f, double &sum, double &squares, double &force) const
  {
    if (terms.cell(f) >= terms.num_owned_cells) return;
    const double smooth = terms.smooth_opening(f);
    double most = 0;
    bool ends = false, jumps = false;
    for (std::size_t a = 0; a < terms.facets.extent(1); ++a) {
      const double p = terms.field(terms.facets(f, a), int(pressure));
      most = math::fmax(most, p);
      if (p > 0) continue;
      ends = true;
      jumps = jumps || -terms.field(terms.facets(f, a), int(penetration)) > smooth;
    }
    const int points = static_cast<int>(terms.value.extent(0));
    for (int q = 0; q < points && most > 0; ++q)
      force += terms.measure(f * points + q) * terms.point(f, q, false).at[pressure];
    if (!ends || jumps) return; // at a jump of the gap the end is known: (10.7b)
    const double part = factor * terms.area(f) * most * most / (order * order);
    sum += part;
    squares += part * part;
  }
};

} // namespace rpc::adapt
