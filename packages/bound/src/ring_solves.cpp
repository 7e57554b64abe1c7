// SPDX-License-Identifier: BSD-3-Clause
#include "ring_solves.hpp"

#include "float_products.hpp"
#include "ring_kinds.hpp"
#include "ring_modes.hpp"

#include <algorithm>
#include <type_traits>

namespace rpc::bound
{
namespace
{

/// The energy of each kind of rings in its modes, and the inverse of that.
template <int K>
struct InvertRings {
  using Modes = RingModes<K>;
  using Sizes = SpaceSizes<K>;
  static constexpr int per_facet = Sizes::per_facet, both = Modes::all;
  static constexpr int linear = 9; // tractions, and modes, of degree 0 and 1; others are modes as they are
  Modes modes;
  SpaceForms forms;
  DeviceView<LO *> example;        // (kinds) ring
  DeviceView<std::size_t *> first; // (kinds)
  DeviceView<float *> inverse;
  DeviceView<double *> work;              // of the kinds from `from` on: whole matrices
  DeviceView<std::size_t *> first_matrix; // (kinds)
  LO from;

  /// The modes at a facet of a ring: (tractions, modes) those of degree 1, and a factor of the others for each component of the traction.
  struct AtFacet {
    double linear_part[linear][linear], of_other[3];
  };
  KOKKOS_FUNCTION AtFacet at_facet(const LO ring, const RingFrame &frame, const int k) const
  {
    AtFacet at;
    const LO f = modes.in.facets.ring_facet(modes.in.facets.first_facet(ring) + k);
    const FacetModes<K> of_facet(modes, f);
    const double toward = modes.toward(ring, k);
    const ModesAtFacet<K> here(frame, of_facet.frame.centre, toward);
    for (int mode = 0; mode < linear; ++mode) {
      double y[both] = {}, t[per_facet];
      y[mode] = 1;
      FacetShare<K> share;
      here.expand(y, y + 6, share);
      of_facet.expand(share, t);
      for (int p = 0; p < linear; ++p) at.linear_part[p][mode] = t[p];
    }
    for (int i = 0; i < 3; ++i) at.of_other[i] = of_facet.components >> i & 1 ? toward : 0;
    return at;
  }

  /// What a cell between the facets k and the next one adds.
  KOKKOS_FUNCTION void add_cell(const LO ring, const int k, const int n, const AtFacet &here, const AtFacet &next,
                                double *H) const
  {
    const SpaceInput &in = modes.in;
    const int facets = in.facets.num_ring_facets(ring), of_ring[2] = {k, (k + 1) % facets};
    const LO c = in.facets.ring_cell(in.facets.first(ring) + k);
    const int kind = in.kind(c);
    const AtFacet *const at[2] = {&here, &next};
    int ordinal[2];
    double sign[2];
    for (int s = 0; s < 2; ++s) {
      const LO f = in.facets.ring_facet(in.facets.first_facet(ring) + of_ring[s]);
      ordinal[s] = in.facets.ordinal(f, in.facets.cell(f, 0) == c ? 0 : 1);
      sign[s] = in.facets.cell(f, 0) == c ? 1 : -1;
    }
    for (int s = 0; s < 2; ++s)
      for (int r = 0; r <= s; ++r) {
        double AM[per_facet][both], X[both][both];
        for (int p = 0; p < per_facet; ++p) {
          double a[per_facet];
          for (int q = 0; q < per_facet; ++q)
            a[q] = sign[s] * sign[r] *
                   forms.second(kind, Sizes::tractions, ordinal[s] * per_facet + p, ordinal[r] * per_facet + q);
          for (int b = 0; b < linear; ++b) AM[p][b] = 0;
          for (int q = 0; q < linear; ++q)
            for (int b = 0; b < linear; ++b) AM[p][b] += a[q] * at[r]->linear_part[q][b];
          for (int b = linear; b < both; ++b) AM[p][b] = a[b] * at[r]->of_other[b % 3];
        }
        for (int i = 0; i < linear; ++i) {
          for (int b = 0; b < both; ++b) X[i][b] = 0;
          for (int p = 0; p < linear; ++p)
            for (int b = 0; b < both; ++b) X[i][b] += at[s]->linear_part[p][i] * AM[p][b];
        }
        for (int i = linear; i < both; ++i)
          for (int b = 0; b < both; ++b) X[i][b] = at[s]->of_other[i % 3] * AM[i][b];
        for (int i = 0; i < both; ++i)
          for (int b = 0; b < both; ++b) { // the inverse is made of the lower triangle
            const int row = modes.place(of_ring[s], i), column = modes.place(of_ring[r], b);
            if (row >= column) H[column * n + row] += X[i][b];
            if (r < s && column >= row) H[row * n + column] += X[i][b]; // its mirror image
          }
      }
  }

  KOKKOS_FUNCTION void operator()(const LO of_batch) const
  {
    const LO kind = from + of_batch, ring = example(kind);
    const int n = modes.size(ring), facets = modes.in.facets.num_ring_facets(ring);
    double *const H = work.data() + (first_matrix(kind) - first_matrix(from));
    for (int i = 0; i < n * n; ++i) H[i] = 0;
    const RingFrame frame(modes, ring);
    AtFacet here = at_facet(ring, frame, 0);
    for (int k = 0; k < modes.in.facets.num_ring_cells(ring); ++k) {
      const AtFacet next = at_facet(ring, frame, (k + 1) % facets);
      add_cell(ring, k, n, here, next, H);
      here = next;
    }
    FloatProducts::invert(n, H);
    float *result = inverse.data() + first(kind);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < (forms.lower ? j + 1 : n); ++i)
        *result++ = static_cast<float>(i < j ? H[j * n + i] : H[i * n + j]);
  }
};

/// What a derivative has of each facet, for the rings of its edges.
template <int K, class Derivative>
struct ReduceAtFacets {
  RingModes<K> modes;
  double a;
  Derivative g;
  DeviceView<float *> shares; // (facets * numbers of a share) += a times it

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    constexpr int n = SpaceSizes<K>::per_facet;
    if (!modes.in.facets.is_whole(f)) return;
    double of_facet[n];
    const std::size_t at = static_cast<std::size_t>(f) * n;
    for (int q = 0; q < n; ++q) of_facet[q] = g(at + q);
    const FacetShare<K> of = FacetModes<K>(modes, f).reduced(of_facet);
    for (int i = 0; i < 3; ++i) {
      shares(at + i) += static_cast<float>(a * of.force[i]);
      shares(at + 3 + i) += static_cast<float>(a * of.moment[i]);
    }
    for (int m = 0; m < FacetShare<K>::own; ++m) shares(at + 6 + m) += static_cast<float>(a * of.rest[m]);
  }
};

/// The answers of rings: what they hand on, then what each facet has beside that; moments and linear tractions scaled as FacetShare has them.
template <int K>
struct SolveRings {
  RingModes<K> modes;
  DeviceView<int *> kind;
  DeviceView<std::size_t *> first;
  DeviceView<float *> inverse, answer, shares;
  DeviceView<float *> large; // (modes) work space for rings of more modes than usual; empty if there are none
  bool lower;                // whether inverses are the rows of lower triangles

  static constexpr int usual = 256; // modes of 83 facets of order 1
  /// @param work  += that of the answer with the derivative
  KOKKOS_FUNCTION void operator()(const LO ring, double &work) const
  {
    constexpr int own = RingModes<K>::own;
    const int n = modes.size(ring), facets = modes.in.facets.num_ring_facets(ring);
    float *const y = answer.data() + modes.first(ring);
    float reduced[usual];
    float *const r = n > usual ? large.data() + modes.first(ring) : reduced;
    double common[6] = {};
    const RingFrame frame(modes, ring);
    if constexpr (!on_gpu) {
      const LO later = ring + 4 < modes.in.facets.num_rings() ? ring + 4 : ring;
      for (int k = 0; k < modes.in.facets.num_ring_facets(later); ++k)
        soon(shares.data() +
             static_cast<std::size_t>(modes.in.facets.ring_facet(modes.in.facets.first_facet(later) + k)) *
                 FacetShare<K>::size);
    }
    for (int k = 0; k < facets; ++k) {
      double of_facet[own], centre[3];
      const LO f = modes.in.facets.ring_facet(modes.in.facets.first_facet(ring) + k);
      const float *const given = shares.data() + static_cast<std::size_t>(f) * FacetShare<K>::size;
      FacetShare<K> share;
      for (int i = 0; i < 3; ++i) {
        share.force[i] = given[i];
        share.moment[i] = given[3 + i];
      }
      for (int m = 0; m < own; ++m) share.rest[m] = given[6 + m];
      modes.centre_of(f, centre);
      ModesAtFacet<K>(frame, centre, modes.toward(ring, k)).reduce(share, common, of_facet);
      for (int m = 0; m < own; ++m) r[modes.place(k, 6 + m)] = static_cast<float>(of_facet[m]);
    }
    for (int i = 0; i < 6; ++i) r[i] = static_cast<float>(common[i]);
    const float *const of_kind = inverse.data() + first(kind(ring));
    work += lower ? FloatProducts::of_lower(of_kind, r, n, y) : FloatProducts::of_ring(of_kind, r, n, y);
    const float by = static_cast<float>(frame.unit), over = static_cast<float>(1 / frame.unit);
    for (int i = 3; i < 6; ++i) y[i] *= by;
    for (int k = 0; k < facets; ++k)
      for (int m = 0; m < 3; ++m) y[modes.place(k, 6 + m)] *= over;
  }
};

/// What the ring of an edge makes of a facet.
template <int K>
struct ReadRings {
  RingModes<K> modes;
  DeviceView<float *> answer;

  /// @param x  vertices of the facet   @param centre  of it
  KOKKOS_FUNCTION void operator()(const LO f, const int e, const double (&x)[3][3], const double (&centre)[3],
                                  FacetShare<K> &share) const
  {
    const LO ring = modes.in.facets.ring(f, e);
    const int k = modes.in.facets.place(f, e);
    const float *const of_ring = answer.data() + modes.first(ring);
    const RingFrame frame(x[e == 1 ? 1 : 0], x[e == 0 ? 1 : 2]);
    ModesAtFacet<K>(frame, centre, modes.toward(ring, k)).expand(of_ring, of_ring + modes.place(k, 6), share);
  }
  KOKKOS_FUNCTION void place_of(const LO f, double (&x)[3][3], double (&centre)[3]) const
  {
    for (int v = 0; v < 3; ++v)
      for (int i = 0; i < 3; ++i) x[v][i] = modes.in.coords(modes.in.facets.node(f, v), i);
    for (int i = 0; i < 3; ++i) centre[i] = (x[0][i] + x[1][i] + x[2][i]) / 3;
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
    double x[3][3], centre[3];
    read.place_of(served(k, 0), x, centre);
    read(served(k, 0), served(k, 1), x, centre, share);
    for (int i = 0; i < 3; ++i) {
      out(k, i) = share.force[i];
      out(k, 3 + i) = share.moment[i];
    }
    for (int m = 0; m < FacetShare<K>::own; ++m) out(k, 6 + m) = share.rest[m];
  }
};

/// d <- a d + b z with z the sum of what rings make of facets.
template <int K>
struct GatherRings {
  ReadRings<K> read;
  SlotExchange::Rows row; // of edges
  DeviceView<double **> fetched;
  double a, b;
  Tractions d;

  KOKKOS_FUNCTION void operator()(const LO f) const
  {
    FacetShare<K> sum;
    double x[3][3], centre[3], z[SpaceSizes<K>::per_facet];
    read.place_of(f, x, centre);
    if constexpr (!on_gpu) {
      const LO later = f + 6 < read.modes.in.facets.size() ? f + 6 : f;
      for (int e = 0; e < 3; ++e) {
        const LO ring = read.modes.in.facets.ring(later, e);
        if (ring >= 0)
          soon(read.answer.data() + read.modes.first(ring) + read.modes.place(read.modes.in.facets.place(later, e), 6));
      }
    }
    for (int e = 0; e < 3; ++e) {
      const LO there = row(f, e);
      if (there < 0) {
        read(f, e, x, centre, sum);
        continue;
      }
      for (int i = 0; i < 3; ++i) {
        sum.force[i] += fetched(there, i);
        sum.moment[i] += fetched(there, 3 + i);
      }
      for (int m = 0; m < FacetShare<K>::own; ++m) sum.rest[m] += fetched(there, 6 + m);
    }
    FacetModes<K>(read.modes, f).expand(sum, z);
    const std::size_t at = static_cast<std::size_t>(f) * SpaceSizes<K>::per_facet;
    for (int q = 0; q < SpaceSizes<K>::per_facet; ++q) d(at + q) = a * d(at + q) + b * z[q];
  }
};

} // namespace

template <class Function>
void RingSolves::for_order(const Function &f) const
{
  if (in_.reference.degree == 1)
    f(std::integral_constant<int, 1>{});
  else
    f(std::integral_constant<int, 2>{});
}

RingSolves::RingSolves(const SpaceInput &in, const BoundaryTractions &boundary, const SpaceForms &forms,
                       const SpaceExchanges &exchanges)
    : in_(in), exchanges_(exchanges), free_(free_components(in, boundary, exchanges.of_facets))
{
  const Kinds kinds = ring_kinds(in, free_);
  kind_ = kinds.kind;
  lower_ = forms.lower;
  const int per_facet = in.reference.tractions / 4, own = per_facet - 6;
  const auto count = to_host(in.facets.num_ring_facets);
  const auto example = to_host(kinds.example);
  const LO num_kinds = static_cast<LO>(example.extent(0));
  first_ = DeviceView<std::size_t *>("rpc::bound::first", num_kinds);
  const DeviceView<std::size_t *> first_matrix("rpc::bound::first_matrix", num_kinds);
  const auto first = Kokkos::create_mirror_view(first_), matrix = Kokkos::create_mirror_view(first_matrix);
  std::size_t total = 0, of_matrices = 0, most = 0;
  for (LO k = 0; k < num_kinds; ++k) {
    const std::size_t n = 6 + own * count(example(k));
    first(k) = total;
    matrix(k) = of_matrices;
    total += lower_ ? row_of_triangle(n) : n * n;
    of_matrices += n * n;
    most = std::max(most, n);
  }
  Kokkos::deep_copy(first_, first);
  Kokkos::deep_copy(first_matrix, matrix);
  inverse_ = DeviceView<float *>(Kokkos::view_alloc("rpc::bound::inverse", Kokkos::WithoutInitializing), total);
  const std::size_t of_rings =
      6 * static_cast<std::size_t>(in.facets.num_rings()) + own * in.facets.ring_facet.extent(0);
  size_ = static_cast<std::size_t>(in.facets.size()) * per_facet;
  answer_ = DeviceView<float *>("rpc::bound::answer", std::max(of_rings, size_));
  if (most > SolveRings<1>::usual) large_ = DeviceView<float *>("rpc::bound::large", of_rings);
  constexpr LO batch = on_gpu ? 16384 : 128; // kinds at once: what bounds the work space, and what keeps a GPU busy
  for (LO from = 0; from < num_kinds; from += batch) {
    const LO to = std::min(num_kinds, from + batch);
    const DeviceView<double *> work(Kokkos::view_alloc("rpc::bound::work", Kokkos::WithoutInitializing),
                                    (to < num_kinds ? matrix(to) : of_matrices) - matrix(from));
    for_order([&](const auto order) {
      Kokkos::parallel_for(
          "rpc::bound::invert_rings", device_range(to - from),
          InvertRings<order.value>{{in, free_}, forms, kinds.example, first_, inverse_, work, first_matrix, from});
    });
    Kokkos::fence();
  }
}

template <class Derivative>
void RingSolves::add_shares(const double a, const Derivative &g, const DeviceView<float *> &shares) const
{
  for_order([&](const auto order) {
    constexpr int k = order.value;
    Kokkos::parallel_for("rpc::bound::reduce_at_facets", device_range(in_.facets.size()),
                         ReduceAtFacets<k, Derivative>{{in_, free_}, a, g, shares});
  });
  Kokkos::fence();
}
template void RingSolves::add_shares(double, const DeviceView<float *> &, const DeviceView<float *> &) const;

double RingSolves::solve(const DeviceView<float *> &shares) const
{
  double work = 0;
  for_order([&](const auto order) {
    constexpr int k = order.value;
    Kokkos::parallel_reduce("rpc::bound::solve_rings", device_range(in_.facets.num_rings()),
                            SolveRings<k>{{in_, free_}, kind_, first_, inverse_, answer_, shares, large_, lower_},
                            work);
  });
  return work;
}

void RingSolves::combine(const double a, const Tractions &d, const double b) const
{
  const SlotExchange &edges = exchanges_.of_edges;
  const LO count = static_cast<LO>(edges.served().extent(0));
  for_order([&](const auto order) {
    constexpr int k = order.value;
    const ReadRings<k> read{{in_, free_}, answer_};
    const DeviceView<double **> served("rpc::bound::served_rings", count, FacetShare<k>::size);
    Kokkos::parallel_for("rpc::bound::serve_rings", device_range(count), ServeRings<k>{read, edges.served(), served});
    Kokkos::parallel_for("rpc::bound::gather_rings", device_range(in_.facets.size()),
                         GatherRings<k>{read, edges.rows(), edges.fetched(served), a, b, d});
  });
  Kokkos::fence();
}

void RingSolves::apply(const Tractions &g, const Tractions &z) const
{
  const DeviceView<float *> shares("rpc::bound::shares", z.extent(0));
  add_shares(1, g, shares);
  solve(shares);
  combine(0, z, 1);
}

} // namespace rpc::bound
