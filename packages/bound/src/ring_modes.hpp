// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "space_stress.hpp"

namespace rpc::bound
{

/// The modes of a ring, as kernels see them.
template <int K>
struct RingModes {
  static constexpr int own = SpaceSizes<K>::per_facet - 6,
                       all = 6 + own; ///< of each facet, and with those that are handed on
  SpaceInput in;
  DeviceView<unsigned char *> free;

  KOKKOS_FUNCTION int size(const LO ring) const { return 6 + own * in.facets.num_ring_facets(ring); }
  KOKKOS_FUNCTION std::size_t first(const LO ring) const
  {
    return 6 * static_cast<std::size_t>(ring) + own * in.facets.first_facet(ring);
  }
  /// Factor of a facet's traction that makes it the one on the cell behind the facet.
  KOKKOS_FUNCTION double toward(const LO ring, const int k) const
  {
    return in.facets.toward(in.facets.first_facet(ring) + k);
  }
  KOKKOS_FUNCTION void centre_of(const LO f, double (&centre)[3]) const
  {
    for (int i = 0; i < 3; ++i)
      centre[i] = (in.coords(in.facets.node(f, 0), i) + in.coords(in.facets.node(f, 1), i) +
                   in.coords(in.facets.node(f, 2), i)) /
                  3;
  }
  /// The place of a facet's mode among those of its ring.
  KOKKOS_FUNCTION int place(const int k, const int mode) const { return mode < 6 ? mode : 6 + own * k + mode - 6; }
  /// Which of the forces and moments along the axes the ring hands on, as bits.
  KOKKOS_FUNCTION int common(const LO ring) const
  {
    const std::size_t begin = in.facets.first_facet(ring);
    const int n = in.facets.num_ring_facets(ring);
    if (n == in.facets.num_ring_cells(ring)) return 63;
    return handed_on(in.facets.ring_facet(begin)) & handed_on(in.facets.ring_facet(begin + n - 1));
  }
  /// The same of a facet. Where components are known, it is a facet across an axis that hands on what lies along the axis or in the facet.
  KOKKOS_FUNCTION int handed_on(const LO f) const
  {
    const int components = free(f) & 7, axis = free(f) >> 3;
    if (components == 7) return 63;
    if (axis == 3) return 0;
    const int along = 1 << axis, within = 7 - along;
    if (components == along) return along | within << 3;
    if (components == within) return within | along << 3;
    return 0;
  }
};

/// What tractions of a facet do as a whole, about its centre, and what they have beside that.
template <int K>
struct FacetShare {
  static constexpr int own = RingModes<K>::own, size = 6 + own;
  double force[3] = {}, moment[3] = {}, rest[own] = {};
};

/// The tractions of a facet. T_0 + T_1 P_1 + T_2 P_2 + ... has the force T_0 and the moment d_1 x T_1 + d_2 x T_2 about the facet's centre, with
/// the d of FacetFrame. A moment is given by those T_1, T_2 that are least.
template <int K>
struct FacetModes {
  using Sizes = SpaceSizes<K>;
  using Share = FacetShare<K>;
  FacetFrame frame;
  double squared = 0; // of the normal
  int components;     // that are free
  bool in_plane; // whether the linear modes without force and moment, which lie in the plane of the facet, are free

  KOKKOS_FUNCTION FacetModes(const RingModes<K> &modes, const LO f) : frame(modes.in, f), components(modes.free(f) & 7)
  {
    const int axis = modes.free(f) >> 3;
    in_plane = components == 7 || (axis < 3 && (components | 1 << axis) == 7);
    for (int i = 0; i < 3; ++i) squared += frame.normal[i] * frame.normal[i];
  }
  /// (tractions of a facet) Others than the free ones are 0.
  KOKKOS_FUNCTION void expand(const Share &of, double *t) const
  {
    const auto &d = frame.along;
    const auto &n = frame.normal;
    double along = 0, by[2] = {0, 0};
    for (int i = 0; i < 3; ++i) {
      along += of.moment[i] * n[i] / (2 * squared);
      for (int j = 0; j < 2; ++j) by[j] += of.moment[i] * d[j][i] / squared;
    }
    for (int i = 0; i < 3; ++i) {
      t[i] = of.force[i];
      t[3 + i] = along * d[1][i] - by[1] * n[i];
      t[6 + i] = -along * d[0][i] + by[0] * n[i];
      if (in_plane) {
        t[3 + i] += of.rest[0] * d[0][i] + of.rest[2] * d[1][i];
        t[6 + i] += of.rest[1] * d[1][i] + of.rest[2] * d[0][i];
      }
    }
    for (int p = 9; p < Sizes::per_facet; ++p) t[p] = of.rest[p - 6];
    for (int p = 0; components != 7 && p < Sizes::per_facet; ++p)
      if (!(components >> p % 3 & 1)) t[p] = 0;
  }
  /// The transpose.
  KOKKOS_FUNCTION Share reduced(const double *given) const
  {
    const auto &d = frame.along;
    const auto &n = frame.normal;
    double g[Sizes::per_facet], along = 0, by[2] = {0, 0};
    Share of;
    for (int p = 0; p < Sizes::per_facet; ++p) g[p] = components >> p % 3 & 1 ? given[p] : 0;
    for (int i = 0; i < 3; ++i) {
      along += (g[3 + i] * d[1][i] - g[6 + i] * d[0][i]) / (2 * squared);
      by[0] += g[6 + i] * n[i] / squared;
      by[1] += g[3 + i] * n[i] / squared;
      if (!in_plane) continue;
      of.rest[0] += g[3 + i] * d[0][i];
      of.rest[1] += g[6 + i] * d[1][i];
      of.rest[2] += g[3 + i] * d[1][i] + g[6 + i] * d[0][i];
    }
    for (int i = 0; i < 3; ++i) {
      of.force[i] = g[i];
      of.moment[i] = along * n[i] + by[0] * d[0][i] - by[1] * d[1][i];
    }
    for (int p = 9; p < Sizes::per_facet; ++p) of.rest[p - 6] = g[p];
    return of;
  }
};

/// What modes of a ring have in common: the middle of its edge, the unit of moments, what it hands on.
struct RingFrame {
  double middle[3], unit = 0;
  int may;

  /// Of answers, which are scaled, and 0 where the ring hands on nothing.
  KOKKOS_FUNCTION RingFrame(const double (&a)[3], const double (&b)[3]) : unit(1), may(63)
  {
    for (int i = 0; i < 3; ++i) middle[i] = (a[i] + b[i]) / 2;
  }

  template <int K>
  KOKKOS_FUNCTION RingFrame(const RingModes<K> &modes, const LO ring) : may(modes.common(ring))
  {
    for (int i = 0; i < 3; ++i) {
      const double a = modes.in.coords(modes.in.facets.edge(ring, 0), i),
                   b = modes.in.coords(modes.in.facets.edge(ring, 1), i);
      middle[i] = (a + b) / 2;
      unit += (a - b) * (a - b);
    }
    unit = math::sqrt(unit);
  }
};

/// The modes of a ring at one of its facets.
template <int K>
struct ModesAtFacet {
  using Share = FacetShare<K>;
  static constexpr int own = RingModes<K>::own;
  double arm[3], to_moment, to_linear, toward; // from the middle of the edge to the centre; factors; of the normal
  int may;

  /// @param centre  of the facet
  KOKKOS_FUNCTION ModesAtFacet(const RingFrame &ring, const double (&centre)[3], const double sign)
      : to_moment(sign * ring.unit), to_linear(sign / ring.unit), toward(sign), may(ring.may)
  {
    for (int i = 0; i < 3; ++i) arm[i] = centre[i] - ring.middle[i];
  }
  /// share += the sum of the modes, in the signs of the facet.
  template <class Real>
  KOKKOS_FUNCTION void expand(const Real *common, const Real *of_facet, Share &share) const
  {
    double force[3];
    for (int i = 0; i < 3; ++i) force[i] = may >> i & 1 ? toward * common[i] : 0;
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      share.force[i] += force[i];
      share.moment[i] += (may >> (3 + i) & 1 ? to_moment * common[3 + i] : 0) - (arm[a] * force[b] - arm[b] * force[a]);
    }
    for (int m = 0; m < own; ++m) share.rest[m] += (m < 3 ? to_linear : toward) * of_facet[m];
  }
  /// The transpose: common += ..., of_facet = ...
  KOKKOS_FUNCTION void reduce(const Share &share, double *common, double *of_facet) const
  {
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      if (may >> i & 1) common[i] += toward * (share.force[i] - (share.moment[a] * arm[b] - share.moment[b] * arm[a]));
      if (may >> (3 + i) & 1) common[3 + i] += to_moment * share.moment[i];
    }
    for (int m = 0; m < own; ++m) of_facet[m] = (m < 3 ? to_linear : toward) * share.rest[m];
  }
};

} // namespace rpc::bound
