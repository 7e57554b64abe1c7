// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact_terms.hpp"

/// Where data of the contact law jump or have a kink between nodes: what that leaves open, and where it makes the pressure singular.
namespace rpc::adapt
{

/// What jumps between the nodes of a facet leave open, over the facets of a side.                    doc/theory.md (10.7b)
struct Jumps {
  ContactTerms terms; // in
  // Difference of a quantity that jumps, over its largest value on the facet: see ContactTerms::state_of().
  static constexpr double jump = 0.1;
  // Of the largest pressure: tractions along the side that jump by less make no singularity that would be seen.
  static constexpr double seen = 0.05;

  KOKKOS_FUNCTION double at(const LO f, const std::size_t a, const int column) const
  {
    return terms.field(terms.facets(f, a), column);
  }

  /// Whether values of a column at the nodes of a facet are all near one or the other end of their range, as on both sides of a jump. A slope
  /// has middle nodes between; two nodes alone do not tell one from the other.
  KOKKOS_FUNCTION bool jumps(const LO f, const int column) const
  {
    double least = at(f, 0, column), most = least;
    for (std::size_t a = 1; a < terms.facets.extent(1); ++a) {
      least = math::fmin(least, at(f, a, column));
      most = math::fmax(most, at(f, a, column));
    }
    if (!(most - least > jump * most)) return false;
    for (std::size_t a = 0; a < terms.facets.extent(1); ++a) {
      const double place = (at(f, a, column) - least) / (most - least);
      if (place > 0.25 && place < 0.75) return false;
    }
    return true;
  }

  KOKKOS_FUNCTION double distance(const LO f, const std::size_t a, const std::size_t b, const int column) const
  {
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = at(f, a, column + k) - at(f, b, column + k);
      square += d * d;
    }
    return math::sqrt(square);
  }
  KOKKOS_FUNCTION bool slips(const LO f, const std::size_t a) const
  {
    for (int k = 0; k < 3; ++k)
      if (at(f, a, slip + k) != 0) return true;
    return false;
  }

  /// @param force     += tractions that jump, over half a facet [N], in the plane per m
  /// @param energy    += what the body releases if contact ends half a facet further in [J], in the plane per m
  /// @param singular  += facets on which the traction of a body that slips jumps
  KOKKOS_FUNCTION void operator()(const LO f, double &force, double &energy, double &singular) const
  {
    if (terms.cell(f) >= terms.num_owned_cells || !(terms.highest > 0)) return;
    const std::size_t nodes = terms.facets.extent(1);
    const int of = terms.block(terms.cell(f));
    const double area = terms.area(f);
    const double depth = terms.size(f) / (terms.lame(of, 0) + 2 * terms.lame(of, 1)), smooth = terms.smooth_opening(f);
    const bool yield_jumps = jumps(f, law), friction_jumps = terms.friction && jumps(f, bearable);
    double lost = 0, sheared = 0, released = 0;
    for (std::size_t a = 0; a < nodes; ++a) {
      const double p = at(f, a, pressure);
      if (!(p > 0)) continue;
      const bool yields = p >= contact::yield_limit(terms.law_at(f, a));
      for (std::size_t b = 0; b < nodes; ++b) {
        const double other = at(f, b, pressure);
        const bool ends = other == 0 && -at(f, b, penetration) > smooth;
        if (yields && (yield_jumps || ends)) lost = math::fmax(lost, p > other ? p - other : other - p);
        if (!yields && ends) released = math::fmax(released, p * p * depth / 2);
        if (friction_jumps && slips(f, a)) sheared = math::fmax(sheared, distance(f, a, b, traction));
      }
    }
    force += math::fmax(lost, sheared) * area / 2;
    energy += released * area;
    if (sheared > seen * terms.highest) singular += 1;
  }
};

/// What makes the pressure singular, or nearly so, at nodes of a plane side, or one of revolution, that have at least half of the largest
/// pressure; 0 in space.                                                                              (10.8a), (10.8b)
struct SingularNodes {
  double kink =
      0; ///< how much the pressure grows while the distance to a kink of the gap falls to 1/e of itself, over the largest one: the most
  double rounded = 0, rounded_depth = 0; ///< see PressurePeak [Pa], [m]
  double edges = 0; ///< number of those at an end of the side, but for the axis, that bear a traction along it
};
SingularNodes singular_nodes(const fem::Discretization &d, const ContactTerms &terms);

} // namespace rpc::adapt
