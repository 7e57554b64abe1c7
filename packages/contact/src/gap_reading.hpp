// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "facet_samples.hpp"
#include "rpc/contact/law/foundation.hpp"

#include <vector>

namespace rpc::contact
{

/// What reading the gap at the nodes alone leaves open, of a facet or of several.                                 (3.16a)
struct Misread {
  double energy = 0, force = 0, penetration = 0; // [J], [N], in 2D per m; the most [m]
  double ends = 0; // half of the facet if its nodes bear and a sample does not [m^(dim-1)]
};

/// The points of a lattice on a facet, and how deep each lies in the foundation that has no dents [m].
struct SampledFacet {
  std::vector<FacetSample> points;
  std::vector<double> penetration;
};

/// Of facets that bear a pressure what lies between their nodes: nodal quadrature has the gap's interpolant there.
struct GapReading {
  const ContactOptions &options;
  const FacetRows &rows;
  const std::vector<FacetShape> &fine, &coarse;
  bool axisymmetric;

  /// The samples of one of the two lattices.
  void sample(LO f, const std::vector<FacetShape> &lattice, SampledFacet &found) const;
  /// Whether samples are far from what the nodes show: the gap jumps, or has a kink. NaN and infinity, where the obstacle is missed, are not.
  /// So it is where a node without weight, which nodal quadrature does not see, lies deeper in the foundation than its pressure explains.
  /// @param modulus  of the cell: lambda + 2 mu [Pa]   @param at  samples of the coarse lattice
  bool is_off(LO f, double modulus, const SampledFacet &at) const;
  /// Of a facet that is_off().
  /// @param modulus, of_surface  of the cell: lambda + 2 mu, and E/(1 - nu^2), by which a surface gives way [Pa]
  Misread read(LO f, double modulus, double of_surface) const;
  /// The work of the pressure over what the interpolant differs by from the gap [J], in 2D per m; with its sign.          (3.16b)
  /// @param at  samples of the fine lattice
  double work_of_interpolation(LO f, const SampledFacet &at) const;

private:
  // Of the range of the gap at the nodes. Between nodes beside a jump it is off by a half or more, on a smooth slope by little.
  static constexpr double off = 0.25;
  double penetration_at_sample(LO f, const FacetShape &shape, const FacetSample &sample) const;
  /// The foundation with a layer of the body in series.
  Foundation law(const Point &x, double dent, double layer) const;
};

} // namespace rpc::contact
