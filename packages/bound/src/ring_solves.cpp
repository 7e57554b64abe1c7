// SPDX-License-Identifier: BSD-3-Clause
#include "ring_solves.hpp"

#include "ring_kinds.hpp"
#include "ring_modes.hpp"

#include <algorithm>

namespace rpc::bound
{
namespace
{

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
      const FacetModes<K> of_facet(modes, f);
      const ModesAtFacet<K> at(RingFrame(modes, ring), of_facet.frame.centre, modes.toward(ring, of_ring[s]));
      for (int mode = 0; mode < both; ++mode) {
        double y[both] = {}, t[per_facet];
        y[mode] = 1;
        FacetShare<K> share;
        at.expand(y, y + 6, share);
        of_facet.expand(share, t);
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

/// What the derivative has of each facet, for the rings of its edges.
template <int K>
struct ReduceAtFacets {
  RingModes<K> modes;
  Tractions g;
  DeviceView<float **> shares; // (facets, numbers of a share)

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    if (!modes.in.facets.is_whole(f)) return;
    const FacetShare<K> of =
        FacetModes<K>(modes, f).reduced(&g(static_cast<std::size_t>(f) * SpaceSizes<K>::per_facet));
    for (int i = 0; i < 3; ++i) {
      shares(f, i) = static_cast<float>(of.force[i]);
      shares(f, 3 + i) = static_cast<float>(of.moment[i]);
    }
    for (int m = 0; m < FacetShare<K>::own; ++m) shares(f, 6 + m) = static_cast<float>(of.rest[m]);
  }
};

template <int K>
struct SolveRings {
  RingModes<K> modes;
  DeviceView<int *> kind;
  DeviceView<std::size_t *> first;
  DeviceView<float *> inverse, answer;
  DeviceView<float **> shares;

  KOKKOS_FUNCTION void operator()(const LO ring) const
  {
    const int n = modes.size(ring), facets = modes.in.facets.num_ring_facets(ring);
    float *const y = answer.data() + modes.first(ring);
    double common[6] = {};
    for (int i = 0; i < n; ++i) y[i] = 0;
    const float *const H = inverse.data() + first(kind(ring));
    const RingFrame frame(modes, ring);
    for (int k = 0; k < facets; ++k) {
      double of_facet[RingModes<K>::own], centre[3];
      const LO f = modes.in.facets.ring_facet(modes.in.facets.first_facet(ring) + k);
      FacetShare<K> share;
      for (int i = 0; i < 3; ++i) {
        share.force[i] = shares(f, i);
        share.moment[i] = shares(f, 3 + i);
      }
      for (int m = 0; m < FacetShare<K>::own; ++m) share.rest[m] = shares(f, 6 + m);
      modes.centre_of(f, centre);
      ModesAtFacet<K>(frame, centre, modes.toward(ring, k)).reduce(share, common, of_facet);
      for (int m = 0; m < RingModes<K>::own; m += 3) add(H + modes.place(k, 6 + m) * n, of_facet + m, n, y);
    }
    for (int m = 0; m < 6; m += 3) add(H + m * n, common + m, n, y);
  }
  /// y += three columns times factors.
  KOKKOS_FUNCTION static void add(const float *columns, const double *factor, const int n, float *y)
  {
    const float a = static_cast<float>(factor[0]), b = static_cast<float>(factor[1]), c = static_cast<float>(factor[2]);
    const float *const second = columns + n, *const third = second + n;
    for (int i = 0; i < n; ++i) y[i] += columns[i] * a + second[i] * b + third[i] * c;
  }
};

/// What the ring of an edge makes of a facet.
template <int K>
struct ReadRings {
  RingModes<K> modes;
  DeviceView<float *> answer;

  KOKKOS_FUNCTION void operator()(const LO f, const int e, const double (&centre)[3], FacetShare<K> &share) const
  {
    const LO ring = modes.in.facets.ring(f, e);
    const int k = modes.in.facets.place(f, e);
    const float *const of_ring = answer.data() + modes.first(ring);
    ModesAtFacet<K>(RingFrame(modes, ring), centre, modes.toward(ring, k))
        .expand(of_ring, of_ring + modes.place(k, 6), share);
  }
};

/// For other ranks.
template <int K>
struct ServeRings {
  ReadRings<K> read;
  DeviceView<LO *[2]> served;
  DeviceView<double **> out; // (served, numbers of a share)

  KOKKOS_FUNCTION void operator()(const LO k) const
  {
    FacetShare<K> share;
    double centre[3];
    read.modes.centre_of(served(k, 0), centre);
    read(served(k, 0), served(k, 1), centre, share);
    for (int i = 0; i < 3; ++i) {
      out(k, i) = share.force[i];
      out(k, 3 + i) = share.moment[i];
    }
    for (int m = 0; m < FacetShare<K>::own; ++m) out(k, 6 + m) = share.rest[m];
  }
};

template <int K>
struct GatherRings {
  ReadRings<K> read;
  SlotExchange::Rows row; // of edges
  DeviceView<double **> fetched;
  Tractions z;

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    FacetShare<K> sum;
    double centre[3];
    read.modes.centre_of(f, centre);
    for (int e = 0; e < 3; ++e) {
      const LO there = row(f, e);
      if (there < 0) {
        read(f, e, centre, sum);
        continue;
      }
      for (int i = 0; i < 3; ++i) {
        sum.force[i] += fetched(there, i);
        sum.moment[i] += fetched(there, 3 + i);
      }
      for (int m = 0; m < FacetShare<K>::own; ++m) sum.rest[m] += fetched(there, 6 + m);
    }
    FacetModes<K>(read.modes, f).expand(sum, &z(static_cast<std::size_t>(f) * SpaceSizes<K>::per_facet));
  }
};

} // namespace

RingSolves::RingSolves(const SpaceInput &in, const BoundaryTractions &boundary, const SpaceForms &forms,
                       const SpaceExchanges &exchanges)
    : in_(in), exchanges_(exchanges), free_(free_components(in, boundary, exchanges.of_facets))
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
  shares_ = DeviceView<float **>("rpc::bound::shares", in.facets.size(), per_facet);
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

template <int K>
void RingSolves::apply_of_order(const Tractions &g, const Tractions &z) const
{
  const RingModes<K> modes{in_, free_};
  Kokkos::parallel_for("rpc::bound::reduce_at_facets", device_range(in_.facets.size()),
                       ReduceAtFacets<K>{modes, g, shares_});
  Kokkos::parallel_for("rpc::bound::solve_rings", device_range(in_.facets.num_rings()),
                       SolveRings<K>{modes, kind_, first_, inverse_, answer_, shares_});
  const ReadRings<K> read{modes, answer_};
  const SlotExchange &edges = exchanges_.of_edges;
  const LO count = static_cast<LO>(edges.served().extent(0));
  const DeviceView<double **> served("rpc::bound::served_rings", count, FacetShare<K>::size);
  Kokkos::parallel_for("rpc::bound::serve_rings", device_range(count), ServeRings<K>{read, edges.served(), served});
  Kokkos::parallel_for("rpc::bound::gather_rings", device_range(in_.facets.size()),
                       GatherRings<K>{read, edges.rows(), edges.fetched(served), z});
  Kokkos::fence();
}

void RingSolves::apply(const Tractions &g, const Tractions &z) const
{
  if (in_.reference.degree == 1)
    apply_of_order<1>(g, z);
  else
    apply_of_order<2>(g, z);
}

} // namespace rpc::bound
