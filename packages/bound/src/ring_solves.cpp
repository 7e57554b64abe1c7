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
  using Sizes = SpaceSizes<K>;
  static constexpr int own = Sizes::per_facet - 6, all = 6 + own; ///< of each facet, and with those that are handed on
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
  KOKKOS_FUNCTION void origin(const LO ring, double (&o)[3], double &unit) const
  {
    unit = 0;
    for (int i = 0; i < 3; ++i) {
      const double a = in.coords(in.facets.edge(ring, 0), i), b = in.coords(in.facets.edge(ring, 1), i);
      o[i] = (a + b) / 2;
      unit += (a - b) * (a - b);
    }
    unit = math::sqrt(unit);
  }

  /// (tractions of a facet, modes), in the signs of the facet; others than the free ones are 0.
  KOKKOS_FUNCTION void of_facet(const LO ring, const int k, double (&M)[Sizes::per_facet][all]) const
  {
    for (auto &row : M)
      for (double &x : row) x = 0;
    const std::size_t at = in.facets.first_facet(ring) + k;
    const LO f = in.facets.ring_facet(at);
    const double toward = in.facets.toward(at);
    const int components = free(f) & 7;
    if (components == 0) return;
    const FacetFrame frame(in, f);
    const auto &d = frame.along;
    double o[3], unit, squared = 0;
    origin(ring, o, unit);
    for (const double x : frame.normal) squared += x * x;
    const int may = common(ring);
    for (int mode = 0; mode < 6; ++mode) {
      if (!(may >> mode & 1)) continue;
      double force[3] = {}, moment[3] = {}; // about the centre of the facet
      if (mode < 3) {
        force[mode] = 1;
        const int a = (mode + 1) % 3, b = (mode + 2) % 3;
        moment[a] = -(frame.centre[b] - o[b]);
        moment[b] = frame.centre[a] - o[a];
      } else {
        moment[mode - 3] = unit;
      }
      double along = 0, by[2] = {0, 0};
      for (int i = 0; i < 3; ++i) {
        along += moment[i] * frame.normal[i];
        for (int j = 0; j < 2; ++j) by[j] += moment[i] * d[j][i];
      }
      for (int i = 0; i < 3; ++i) {
        M[i][mode] = toward * force[i];
        M[3 + i][mode] = toward * (along * d[1][i] / 2 - by[1] * frame.normal[i]) / squared;
        M[6 + i][mode] = toward * (-along * d[0][i] / 2 + by[0] * frame.normal[i]) / squared;
      }
    }
    for (int i = 0; i < 3; ++i) {
      M[3 + i][6] = toward * d[0][i] / unit;
      M[6 + i][7] = toward * d[1][i] / unit;
      M[3 + i][8] = toward * d[1][i] / unit;
      M[6 + i][8] = toward * d[0][i] / unit;
    }
    for (int j = 3; j < Sizes::functions; ++j)
      for (int i = 0; i < 3; ++i) M[3 * j + i][3 * j + i] = toward;
    if (components == 7) return;
    // Of the modes without force and moment those in the plane stay if all of it is free; what is known must not change.
    const int axis = free(f) >> 3;
    const bool in_plane = axis < 3 && (components | 1 << axis) == 7;
    for (int p = 0; p < Sizes::per_facet; ++p)
      for (int mode = 0; mode < all; ++mode)
        if (!(components >> p % 3 & 1) || (mode >= 6 && mode < 9 && !in_plane)) M[p][mode] = 0;
  }
};

/// The energy of a ring in its modes, and its Cholesky factor, column by column.
template <int K>
struct FactorRings {
  using Modes = RingModes<K>;
  using Sizes = SpaceSizes<K>;
  Modes modes;
  SpaceForms forms;
  DeviceView<LO *> example;        // (kinds) ring
  DeviceView<std::size_t *> first; // (kinds)
  DeviceView<double *> factor;

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
      ordinal[s] = in.facets.ordinal(f, in.facets.cell(f, 0) == c ? 0 : 1);
      modes.of_facet(ring, of_ring[s], M[s]);
      const double sign = in.facets.cell(f, 0) == c ? 1 : -1;
      for (auto &row : M[s])
        for (double &x : row) x *= sign;
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

  KOKKOS_FUNCTION void operator()(const LO kind) const
  {
    const LO ring = example(kind);
    const int n = modes.size(ring);
    double *const H = factor.data() + first(kind);
    for (int i = 0; i < n * n; ++i) H[i] = 0;
    for (int k = 0; k < modes.in.facets.num_ring_cells(ring); ++k) add_cell(ring, k, n, H);
    for (int j = 0; j < n; ++j) { // column j of the factor lies at j n
      double *const column = H + j * n;
      const double own = column[j];
      for (int k = 0; k < j; ++k) {
        const double by = H[k * n + j];
        for (int i = j; by != 0 && i < n; ++i) column[i] -= H[k * n + i] * by;
      }
      if (!(column[j] > 1e-12 * own)) { // a mode that is not there
        for (int i = j; i < n; ++i) column[i] = 0;
        continue;
      }
      const double pivot = math::sqrt(column[j]);
      for (int i = j; i < n; ++i) column[i] /= pivot;
    }
  }
};

template <int K>
struct SolveRings {
  using Modes = RingModes<K>;
  using Sizes = SpaceSizes<K>;
  Modes modes;
  DeviceView<int *> kind;
  DeviceView<std::size_t *> first;
  DeviceView<double *> factor, answer;
  Tractions g;

  KOKKOS_FUNCTION void operator()(const LO ring) const
  {
    const int n = modes.size(ring), facets = modes.in.facets.num_ring_facets(ring);
    double *const y = answer.data() + modes.first(ring);
    for (int i = 0; i < n; ++i) y[i] = 0;
    for (int k = 0; k < facets; ++k) {
      double M[Sizes::per_facet][Modes::all], sum[Modes::all] = {};
      modes.of_facet(ring, k, M);
      const std::size_t from =
          static_cast<std::size_t>(modes.in.facets.ring_facet(modes.in.facets.first_facet(ring) + k)) *
          Sizes::per_facet;
      for (int p = 0; p < Sizes::per_facet; ++p)
        for (int b = 0; b < Modes::all; ++b) sum[b] += M[p][b] * g(from + p);
      for (int b = 0; b < Modes::all; ++b) y[modes.place(k, b)] += sum[b];
    }
    const double *const L = factor.data() + first(kind(ring));
    for (int j = 0; j < n; ++j) {
      const double *const column = L + j * n;
      y[j] = column[j] > 0 ? y[j] / column[j] : 0;
      for (int i = j + 1; i < n; ++i) y[i] -= column[i] * y[j];
    }
    for (int j = n - 1; j >= 0; --j) {
      const double *const column = L + j * n;
      double sum = y[j];
      for (int i = j + 1; i < n; ++i) sum -= column[i] * y[i];
      y[j] = column[j] > 0 ? sum / column[j] : 0;
    }
  }
};

template <int K>
struct GatherRings {
  using Modes = RingModes<K>;
  using Sizes = SpaceSizes<K>;
  Modes modes;
  DeviceView<double *> answer;
  Tractions z;

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    double sum[Sizes::per_facet] = {};
    for (int e = 0; e < 3; ++e) {
      const LO ring = modes.in.facets.ring(f, e);
      const int k = modes.in.facets.place(f, e);
      double M[Sizes::per_facet][Modes::all];
      modes.of_facet(ring, k, M);
      for (int b = 0; b < Modes::all; ++b) {
        const double y = answer(modes.first(ring) + modes.place(k, b));
        for (int p = 0; p < Sizes::per_facet; ++p) sum[p] += M[p][b] * y;
      }
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
  for (LO ring = 0; ring < in.facets.num_rings(); ++ring) {
    key.clear();
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
  factor_ = DeviceView<double *>(Kokkos::view_alloc("rpc::bound::factor", Kokkos::WithoutInitializing), total);
  answer_ = DeviceView<double *>("rpc::bound::answer", 6 * static_cast<std::size_t>(in.facets.num_rings()) +
                                                           own * in.facets.ring_facet.extent(0));
  const auto range = device_range(static_cast<LO>(kinds.example.size()));
  if (in.reference.degree == 1)
    Kokkos::parallel_for("rpc::bound::factor_rings", range,
                         FactorRings<1>{{in_, free_}, forms, example, first_, factor_});
  else
    Kokkos::parallel_for("rpc::bound::factor_rings", range,
                         FactorRings<2>{{in_, free_}, forms, example, first_, factor_});
  Kokkos::fence();
}

void RingSolves::apply(const Tractions &g, const Tractions &z) const
{
  const auto rings = device_range(in_.facets.num_rings()), facets = device_range(in_.facets.size());
  if (in_.reference.degree == 1) {
    const RingModes<1> modes{in_, free_};
    Kokkos::parallel_for("rpc::bound::solve_rings", rings, SolveRings<1>{modes, kind_, first_, factor_, answer_, g});
    Kokkos::parallel_for("rpc::bound::gather_rings", facets, GatherRings<1>{modes, answer_, z});
  } else {
    const RingModes<2> modes{in_, free_};
    Kokkos::parallel_for("rpc::bound::solve_rings", rings, SolveRings<2>{modes, kind_, first_, factor_, answer_, g});
    Kokkos::parallel_for("rpc::bound::gather_rings", facets, GatherRings<2>{modes, answer_, z});
  }
  Kokkos::fence();
}

} // namespace rpc::bound
