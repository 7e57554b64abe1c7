// SPDX-License-Identifier: BSD-3-Clause
#include "ring_solves.hpp"

#include <algorithm>
#include <map>
#include <vector>

namespace rpc::bound
{
namespace
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

/// The modes of a ring at one of its facets. The traction T_0 + T_1 P_1 + T_2 P_2 + ... has the force T_0 and the moment d_1 x T_1 + d_2 x T_2
/// about the facet's centre, with the d of FacetFrame. What is handed on has the T_1, T_2 with the least of them that gives its moment.
template <int K>
struct ModesAtFacet {
  using Sizes = SpaceSizes<K>;
  static constexpr int own = RingModes<K>::own;
  FacetFrame frame;
  double arm[3], unit = 0, squared = 0,
                 toward; ///< from the middle of the edge to the centre; the unit of moments; of the normal
  int may, components;
  bool in_plane; ///< whether the linear modes without force and moment, which lie in the plane of the facet, are free

  KOKKOS_FUNCTION ModesAtFacet(const RingModes<K> &modes, const LO ring, const int k)
      : ModesAtFacet(modes, ring, modes.in.facets.first_facet(ring) + k)
  {
  }
  /// (tractions of a facet) t = sum of the modes, in the signs of the facet; others than the free ones are 0.
  KOKKOS_FUNCTION void expand(const double *common, const double *of_facet, double *t) const
  {
    const auto &d = frame.along;
    const auto &n = frame.normal;
    double force[3], moment[3], along = 0, by[2] = {0, 0};
    for (int i = 0; i < 3; ++i) force[i] = may >> i & 1 ? common[i] : 0;
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      moment[i] = (may >> (3 + i) & 1 ? unit * common[3 + i] : 0) - (arm[a] * force[b] - arm[b] * force[a]);
    }
    for (int i = 0; i < 3; ++i) {
      along += moment[i] * n[i] / (2 * squared);
      for (int j = 0; j < 2; ++j) by[j] += moment[i] * d[j][i] / squared;
    }
    for (int i = 0; i < 3; ++i) {
      t[i] = force[i];
      t[3 + i] = along * d[1][i] - by[1] * n[i];
      t[6 + i] = -along * d[0][i] + by[0] * n[i];
      if (in_plane) {
        t[3 + i] += (of_facet[0] * d[0][i] + of_facet[2] * d[1][i]) / unit;
        t[6 + i] += (of_facet[1] * d[1][i] + of_facet[2] * d[0][i]) / unit;
      }
    }
    for (int p = 9; p < Sizes::per_facet; ++p) t[p] = of_facet[p - 6];
    for (int p = 0; p < Sizes::per_facet; ++p) t[p] = components >> p % 3 & 1 ? toward * t[p] : 0;
  }
  /// The transpose: common += ..., of_facet = ...
  KOKKOS_FUNCTION void reduce(const double *given, double *common, double *of_facet) const
  {
    const auto &d = frame.along;
    const auto &n = frame.normal;
    double g[Sizes::per_facet], along = 0, by[2] = {0, 0}, w[3];
    for (int p = 0; p < Sizes::per_facet; ++p) g[p] = components >> p % 3 & 1 ? toward * given[p] : 0;
    for (int m = 0; m < 3; ++m) of_facet[m] = 0;
    for (int i = 0; i < 3; ++i) {
      along += (g[3 + i] * d[1][i] - g[6 + i] * d[0][i]) / (2 * squared);
      by[0] += g[6 + i] * n[i] / squared;
      by[1] += g[3 + i] * n[i] / squared;
      if (!in_plane) continue;
      of_facet[0] += g[3 + i] * d[0][i] / unit;
      of_facet[1] += g[6 + i] * d[1][i] / unit;
      of_facet[2] += (g[3 + i] * d[1][i] + g[6 + i] * d[0][i]) / unit;
    }
    for (int i = 0; i < 3; ++i) w[i] = along * n[i] + by[0] * d[0][i] - by[1] * d[1][i];
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      if (may >> i & 1) common[i] += g[i] - (w[a] * arm[b] - w[b] * arm[a]);
      if (may >> (3 + i) & 1) common[3 + i] += unit * w[i];
    }
    for (int p = 9; p < Sizes::per_facet; ++p) of_facet[p - 6] = g[p];
  }

private:
  KOKKOS_FUNCTION ModesAtFacet(const RingModes<K> &modes, const LO ring, const std::size_t at)
      : frame(modes.in, modes.in.facets.ring_facet(at)), toward(modes.in.facets.toward(at)), may(modes.common(ring)),
        components(modes.free(modes.in.facets.ring_facet(at)) & 7)
  {
    const int axis = modes.free(modes.in.facets.ring_facet(at)) >> 3;
    in_plane = components == 7 || (axis < 3 && (components | 1 << axis) == 7);
    for (int i = 0; i < 3; ++i) {
      const double a = modes.in.coords(modes.in.facets.edge(ring, 0), i),
                   b = modes.in.coords(modes.in.facets.edge(ring, 1), i);
      arm[i] = frame.centre[i] - (a + b) / 2;
      unit += (a - b) * (a - b);
      squared += frame.normal[i] * frame.normal[i];
    }
    unit = math::sqrt(unit);
  }
};

/// The energy of each kind of rings in its modes, and the inverse of that.
template <int K>
struct InvertRings {
  using Modes = RingModes<K>;
  using Sizes = SpaceSizes<K>;
  Modes modes;
  SpaceForms forms;
  DeviceView<LO *> example;        // (kinds) ring
  DeviceView<std::size_t *> first; // (kinds)
  DeviceView<float *> inverse;
  DeviceView<double *> work; // of the kinds from `from` on
  LO from;

  KOKKOS_FUNCTION void add_cell(const LO ring, const int k, const int n, double *H) const
  {
    constexpr int per_facet = Sizes::per_facet, both = Modes::all;
    const SpaceInput &in = modes.in;
    const int facets = in.facets.num_ring_facets(ring), of_ring[2] = {k, (k + 1) % facets};
    const LO c = in.facets.ring_cell(in.facets.first(ring) + k);
    const int kind = in.kind(c);
    int ordinal[2];
    double M[2][per_facet][both], AM[per_facet][both];
    for (int s = 0; s < 2; ++s) {
      const LO f = in.facets.ring_facet(in.facets.first_facet(ring) + of_ring[s]);
      const double sign = in.facets.cell(f, 0) == c ? 1 : -1;
      ordinal[s] = in.facets.ordinal(f, in.facets.cell(f, 0) == c ? 0 : 1);
      const ModesAtFacet<K> at(modes, ring, of_ring[s]);
      for (int mode = 0; mode < both; ++mode) {
        double y[both] = {}, t[per_facet];
        y[mode] = 1;
        at.expand(y, y + 6, t);
        for (int p = 0; p < per_facet; ++p) M[s][p][mode] = sign * t[p];
      }
    }
    for (int r = 0; r < 2; ++r)
      for (int s = 0; s < 2; ++s) {
        for (int p = 0; p < per_facet; ++p) {
          for (int b = 0; b < both; ++b) AM[p][b] = 0;
          for (int q = 0; q < per_facet; ++q) {
            const double a = forms.A(kind, ordinal[s] * per_facet + p, ordinal[r] * per_facet + q);
            for (int b = 0; b < both; ++b) AM[p][b] += a * M[r][q][b];
          }
        }
        for (int a = 0; a < both; ++a) {
          double row[both] = {};
          for (int p = 0; p < per_facet; ++p)
            for (int b = 0; b < both; ++b) row[b] += M[s][p][a] * AM[p][b];
          const int i = modes.place(of_ring[s], a);
          for (int b = 0; b < both; ++b) H[modes.place(of_ring[r], b) * n + i] += row[b];
        }
      }
  }

  KOKKOS_FUNCTION void operator()(const LO of_batch) const
  {
    const LO kind = from + of_batch, ring = example(kind);
    const int n = modes.size(ring);
    double *const H = work.data() + (first(kind) - first(from));
    for (int i = 0; i < n * n; ++i) H[i] = 0;
    for (int k = 0; k < modes.in.facets.num_ring_cells(ring); ++k) add_cell(ring, k, n, H);
    invert(n, H);
    float *const result = inverse.data() + first(kind);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) result[j * n + i] = static_cast<float>(H[(i < j ? i : j) * n + (i < j ? j : i)]);
  }

  /// The lower part of the inverse, in place; 0 in rows of modes that are not there. Column j lies at j n.
  KOKKOS_FUNCTION static void invert(const int n, double *H)
  {
    for (int j = 0; j < n; ++j) { // Cholesky's factor
      double *const column = H + j * n;
      const double own = column[j];
      for (int k = 0; k < j; ++k) {
        const double by = H[k * n + j];
        for (int i = j; by != 0 && i < n; ++i) column[i] -= H[k * n + i] * by;
      }
      if (!(column[j] > 1e-12 * own)) {
        for (int i = j; i < n; ++i) column[i] = 0;
        for (int k = 0; k < j; ++k) H[k * n + j] = 0;
        continue;
      }
      const double pivot = math::sqrt(column[j]);
      for (int i = j; i < n; ++i) column[i] /= pivot;
    }
    for (int j = n - 1; j >= 0; --j) { // its inverse M: column j from those after it
      double *const column = H + j * n;
      const double own = column[j] > 0 ? 1 / column[j] : 0;
      column[j] = own;
      for (int i = n - 1; i > j; --i) {
        double sum = 0;
        for (int k = j + 1; k <= i; ++k) sum += H[k * n + i] * column[k];
        column[i] = -own * sum;
      }
    }
    for (int i = 0; i < n; ++i) // M^T M
      for (int j = 0; j <= i; ++j) {
        double sum = 0;
        for (int k = i; k < n; ++k) sum += H[i * n + k] * H[j * n + k];
        H[j * n + i] = sum;
      }
  }
};

template <int K>
struct SolveRings {
  using Sizes = SpaceSizes<K>;
  RingModes<K> modes;
  DeviceView<int *> kind;
  DeviceView<std::size_t *> first;
  DeviceView<float *> inverse, answer;
  Tractions g;

  KOKKOS_FUNCTION void operator()(const LO ring) const
  {
    const int n = modes.size(ring), facets = modes.in.facets.num_ring_facets(ring);
    float *const y = answer.data() + modes.first(ring);
    double common[6] = {};
    for (int i = 0; i < n; ++i) y[i] = 0;
    const float *const H = inverse.data() + first(kind(ring));
    for (int k = 0; k < facets; ++k) {
      double of_facet[RingModes<K>::own];
      const std::size_t f = modes.in.facets.ring_facet(modes.in.facets.first_facet(ring) + k);
      ModesAtFacet<K>(modes, ring, k).reduce(&g(f * Sizes::per_facet), common, of_facet);
      for (int m = 0; m < RingModes<K>::own; ++m) add(H + modes.place(k, 6 + m) * n, of_facet[m], n, y);
    }
    for (int m = 0; m < 6; ++m) add(H + m * n, common[m], n, y);
  }
  KOKKOS_FUNCTION static void add(const float *column, const double factor, const int n, float *y)
  {
    const float by = static_cast<float>(factor);
    for (int i = 0; i < n; ++i) y[i] += column[i] * by;
  }
};

template <int K>
struct GatherRings {
  using Sizes = SpaceSizes<K>;
  RingModes<K> modes;
  DeviceView<float *> answer;
  Tractions z;

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    double sum[Sizes::per_facet] = {};
    for (int e = 0; e < 3; ++e) {
      const LO ring = modes.in.facets.ring(f, e);
      const int k = modes.in.facets.place(f, e);
      const std::size_t first = modes.first(ring), at = first + modes.place(k, 6);
      double common[6], of_facet[RingModes<K>::own], t[Sizes::per_facet];
      for (int m = 0; m < 6; ++m) common[m] = answer(first + m);
      for (int m = 0; m < RingModes<K>::own; ++m) of_facet[m] = answer(at + m);
      ModesAtFacet<K>(modes, ring, k).expand(common, of_facet, t);
      for (int p = 0; p < Sizes::per_facet; ++p) sum[p] += t[p];
    }
    for (int p = 0; p < Sizes::per_facet; ++p) z(static_cast<std::size_t>(f) * Sizes::per_facet + p) = sum[p];
  }
};

/// Which components of the traction of a facet are free, as bits, and times 8 the axis that it lies across; 3: none.
DeviceView<unsigned char *> free_components(const SpaceInput &in, const BoundaryTractions &boundary)
{
  constexpr double straight = 1e-12;
  DeviceView<unsigned char *> free("rpc::bound::free", in.facets.size());
  Kokkos::parallel_for(
      "rpc::bound::free_components", device_range(in.facets.size()), KOKKOS_LAMBDA(const LO f) {
        int components = 7, axis = 3;
        if (in.facets.on_boundary(f)) {
          const FacetFrame frame(in, f);
          components = 0;
          double size = 0;
          for (int i = 0; i < 3; ++i) {
            if (!boundary.known(f, i)) components |= 1 << i;
            size = math::fmax(size, math::magnitude(frame.normal[i]));
          }
          for (int i = 0; i < 3; ++i)
            if (math::magnitude(frame.normal[(i + 1) % 3]) + math::magnitude(frame.normal[(i + 2) % 3]) <=
                straight * size)
              axis = i;
        }
        free(f) = static_cast<unsigned char>(components | axis << 3);
      });
  Kokkos::fence();
  return free;
}

/// Kinds of rings, and a ring of each.
struct RingKinds {
  DeviceView<int *> kind;
  std::vector<LO> example;
};
RingKinds ring_kinds(const SpaceInput &in, const DeviceView<unsigned char *> &free)
{
  const auto cells = to_host(in.facets.ring_cell), facets = to_host(in.facets.ring_facet);
  const auto toward = to_host(in.facets.toward);
  const auto first = to_host(in.facets.first);
  const auto count = to_host(in.facets.num_ring_facets), of_cell = to_host(in.kind);
  const auto cell = to_host(in.facets.cell);
  const auto ordinal = to_host(in.facets.ordinal);
  const auto on_host = to_host(free);
  RingKinds kinds;
  kinds.kind = DeviceView<int *>("rpc::bound::kind", in.facets.num_rings());
  const auto kind = Kokkos::create_mirror_view(kinds.kind);
  std::map<std::vector<int>, int> found;
  std::vector<int> key;
  const bool all_differ = 2 * in.example.extent(0) > static_cast<std::size_t>(in.num_cells());
  for (LO ring = 0; ring < in.facets.num_rings(); ++ring) {
    key.clear();
    if (all_differ) {
      kind(ring) = ring;
      kinds.example.push_back(ring);
      continue;
    }
    const std::size_t begin = first(ring);
    const int n = static_cast<int>(first(ring + 1) - begin);
    for (int k = 0; k < count(ring); ++k) {
      const LO f = facets(begin + ring + k);
      if (k < n) {
        const LO c = cells(begin + k);
        key.push_back(of_cell(c));
        key.push_back(ordinal(f, cell(f, 0) == c ? 0 : 1));
      }
      if (k > 0) {
        const LO c = cells(begin + k - 1);
        key.push_back(ordinal(f, cell(f, 0) == c ? 0 : 1));
      }
      key.push_back(toward(begin + ring + k));
      key.push_back(on_host(f));
    }
    const auto [at, is_new] = found.try_emplace(key, static_cast<int>(found.size()));
    kind(ring) = at->second;
    if (is_new) kinds.example.push_back(ring);
  }
  Kokkos::deep_copy(kinds.kind, kind);
  return kinds;
}

} // namespace

RingSolves::RingSolves(const SpaceInput &in, const BoundaryTractions &boundary, const SpaceForms &forms)
    : in_(in), free_(free_components(in, boundary))
{
  const RingKinds kinds = ring_kinds(in, free_);
  kind_ = kinds.kind;
  const int per_facet = in.reference.tractions / 4, own = per_facet - 6;
  const auto count = to_host(in.facets.num_ring_facets);
  DeviceView<LO *> example("rpc::bound::example", kinds.example.size());
  first_ = DeviceView<std::size_t *>("rpc::bound::first", kinds.example.size());
  const auto examples = Kokkos::create_mirror_view(example);
  const auto first = Kokkos::create_mirror_view(first_);
  std::size_t total = 0;
  for (std::size_t k = 0; k < kinds.example.size(); ++k) {
    examples(k) = kinds.example[k];
    first(k) = total;
    const std::size_t n = 6 + own * count(kinds.example[k]);
    total += n * n;
  }
  Kokkos::deep_copy(example, examples);
  Kokkos::deep_copy(first_, first);
  inverse_ = DeviceView<float *>(Kokkos::view_alloc("rpc::bound::inverse", Kokkos::WithoutInitializing), total);
  answer_ = DeviceView<float *>("rpc::bound::answer", 6 * static_cast<std::size_t>(in.facets.num_rings()) +
                                                          own * in.facets.ring_facet.extent(0));
  constexpr LO batch = 1024; // kinds at once: what bounds the work space
  const LO num_kinds = static_cast<LO>(kinds.example.size());
  for (LO from = 0; from < num_kinds; from += batch) {
    const LO to = std::min(num_kinds, from + batch);
    const DeviceView<double *> work("rpc::bound::work", (to < num_kinds ? first(to) : total) - first(from));
    if (in.reference.degree == 1)
      Kokkos::parallel_for("rpc::bound::invert_rings", device_range(to - from),
                           InvertRings<1>{{in, free_}, forms, example, first_, inverse_, work, from});
    else
      Kokkos::parallel_for("rpc::bound::invert_rings", device_range(to - from),
                           InvertRings<2>{{in, free_}, forms, example, first_, inverse_, work, from});
    Kokkos::fence();
  }
}

void RingSolves::apply(const Tractions &g, const Tractions &z) const
{
  const auto rings = device_range(in_.facets.num_rings()), facets = device_range(in_.facets.size());
  if (in_.reference.degree == 1) {
    const RingModes<1> modes{in_, free_};
    Kokkos::parallel_for("rpc::bound::solve_rings", rings, SolveRings<1>{modes, kind_, first_, inverse_, answer_, g});
    Kokkos::parallel_for("rpc::bound::gather_rings", facets, GatherRings<1>{modes, answer_, z});
  } else {
    const RingModes<2> modes{in_, free_};
    Kokkos::parallel_for("rpc::bound::solve_rings", rings, SolveRings<2>{modes, kind_, first_, inverse_, answer_, g});
    Kokkos::parallel_for("rpc::bound::gather_rings", facets, GatherRings<2>{modes, answer_, z});
  }
  Kokkos::fence();
}

} // namespace rpc::bound
