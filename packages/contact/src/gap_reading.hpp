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
  const Lattice *lattice = nullptr;
  std::vector<FacetSample> points;
  std::vector<double> penetration;

  double beyond_dents(const std::size_t n) const { return penetration[n] - points[n].dent; } // [m]
};

/// How far the gap is from its interpolants [m], at most.                                                         (3.15a)
struct OffInterpolants {
  double whole = 0, halves = 0; // on a facet and on its halves

  /// Whether something of the gap is narrower than the facet: halves would follow it hardly better.
  /// @param smooth  how far the gap is from its interpolant on other facets, where it is smooth [m]
  bool hides(double smooth) const;
};
OffInterpolants off_interpolants(const SampledFacet &at);

/// How deep the foundation may have been pressed in [m] where the body would lie in it by some depth below the dents if it bore nothing: a layer
/// of the body gives way in series.                                                                               (3.16a)
/// @param layer  its compliance [m/Pa]
double pressed_in(const ContactOptions &options, const Point &x, double dent, double depth, double layer);

/// Of facets that bear a pressure what lies between their nodes: nodal quadrature has the gap's interpolant there.
struct GapReading {
  const ContactOptions &options;
  const FacetRows &rows;
  bool axisymmetric;
  double diameter; // of the body [m]

  /// The samples of a lattice.
  void sample(LO f, const Lattice &lattice, SampledFacet &found) const;
  /// Whether samples are far from what the nodes show: the gap jumps, or has a kink. NaN and infinity, where the obstacle is missed, are not.
  bool is_off(LO f, const SampledFacet &at) const;
  /// Whether a node without weight, which nodal quadrature does not see, lies deeper in the foundation than its pressure explains.
  /// @param modulus  of the cell: lambda + 2 mu [Pa]
  bool has_deep_node(LO f, double modulus) const;
  /// Of a facet that is_off() or has_deep_node().
  /// @param modulus, of_surface  of the cell: lambda + 2 mu, and E/(1 - nu^2), by which a surface gives way [Pa]
  Misread read(LO f, double modulus, double of_surface, const SampledFacet &at) const;
  /// The work of the pressure over what the interpolant differs by from the gap [J], in 2D per m; with its sign.          (3.16b)
  double work_of_interpolation(LO f, const SampledFacet &at) const;

private:
  // Of the range of the gap at the nodes. Between nodes beside a jump it is off by a half or more, on a smooth slope by little.
  static constexpr double off = 0.25;
};

} // namespace rpc::contact
