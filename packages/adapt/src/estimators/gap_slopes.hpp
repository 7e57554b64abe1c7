// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_terms.hpp"

/// Whether contact ends because the gap jumps, or has a kink, there, or because a smooth gap opens.
namespace rpc::adapt
{

/// How steep the gap is on the facets around each node of a side, where contact is closed and where it is open.
struct GapSlopes {
  ContactTerms terms;             // in
  DeviceView<double **> coords;   // (overlap nodes, dim)  [m]  in
  int vertices;                   // of a facet, its first nodes  in
  DeviceView<double **> steepest; // (overlap nodes; Around), -1 where there is no such facet  out
  enum Around { in_contact, clear, num_around };

  /// Largest difference of the gap between two vertices of a facet over their distance.
  KOKKOS_FUNCTION double slope(const LO f) const
  {
    double most = 0;
    for (int a = 0; a < vertices; ++a)
      for (int b = 0; b < a; ++b) {
        const LO m = terms.facets(f, a), n = terms.facets(f, b);
        double square = 0;
        for (std::size_t k = 0; k < coords.extent(1); ++k)
          square += (coords(m, k) - coords(n, k)) * (coords(m, k) - coords(n, k));
        const double rise = math::magnitude(terms.field(m, int(gap)) - terms.field(n, int(gap)));
        most = math::fmax(most, rise / math::sqrt(square));
      }
    return most;
  }

  /// Facets that are closed, or open, at all their nodes tell their slopes to their vertices.
  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    const std::size_t nodes = terms.facets.extent(1);
    std::size_t closed = 0;
    for (std::size_t a = 0; a < nodes; ++a)
      if (terms.field(terms.facets(f, a), int(pressure)) > 0) ++closed;
    if (closed > 0 && closed < nodes) return;
    const double mine = slope(f);
    for (int a = 0; a < vertices; ++a)
      Kokkos::atomic_fetch_max(&steepest(terms.facets(f, a), closed > 0 ? int(in_contact) : int(clear)), mine);
  }
};

/// (overlap nodes; GapSlopes::Around) of all facets around a node, those of other ranks too. Collective.
RCP<const MultiVector> gap_slopes(const fem::Discretization &d, const GapSlopes &slopes);

/// Whether the gap on a facet on which contact ends rises as at a jump or a kink: more than it does on the facets beyond, which have as much
/// where it is curved alone.                                                                                       (10.8)
/// @param around  see gap_slopes()
/// @param opens   of a facet's length: what smooth contact can open there [m]
KOKKOS_INLINE_FUNCTION bool rises_at_once(const GapSlopes &slopes, const ReadColumns &around, const LO f,
                                          const double opens)
{
  const ContactTerms &terms = slopes.terms;
  double inside = 0, outside = -1;
  for (int a = 0; a < slopes.vertices; ++a) {
    const LO node = terms.facets(f, a);
    if (terms.field(node, int(pressure)) > 0)
      inside = math::fmax(inside, around(node, int(GapSlopes::in_contact)));
    else
      outside = math::fmax(outside, around(node, int(GapSlopes::clear)));
  }
  const double here = slopes.slope(f), grows = here - inside;
  // Between the middles of equal facets a parabola's slope grows alike everywhere. Where the side ends here, only what lies inside tells.
  const double goes_on = math::fmax(0., outside < 0 ? inside : outside - here);
  return grows * terms.size(f) > opens && grows > 2 * goes_on;
}

} // namespace rpc::adapt
