// SPDX-License-Identifier: BSD-3-Clause
#include "space_cells.hpp"

#include <algorithm>

namespace rpc::bound
{
namespace
{

/// The moments at the facets of a node's star from the balance of its cells. They are as near as can be to the mean of both sides: a change
/// is what two cells, or one and the outside, exchange through their facet, and what cells send out solves a graph Laplacian.
struct BalanceStarsInSpace {
  SpaceInput in;
  BoundaryTractions boundary;
  DeviceView<double ***> Q; // inout: then what cells send out at their nodes
  Tractions mean;           // (facets * nodes of one * 3)
  DeviceView<double ***> known;
  fem::NodeToCells around;
  DeviceView<std::size_t *>
      first;                   // (nodes + 1) where the matrix of a star begins, and behind it what its cells send out
  LO from;                     // the first node of a batch
  DeviceView<double *> matrix; // of a batch
  DeviceView<double *> area;   // (facets) what is in one relation to it; a moment's square counts by one over that

  KOKKOS_FUNCTION std::size_t at(const LO f, const int a) const
  {
    return (static_cast<std::size_t>(f) * in.facets.node.extent(1) + a) * 3;
  }

  KOKKOS_FUNCTION int node_of_cell(const LO c, const LO node) const
  {
    for (int a = 0; a < static_cast<int>(in.cells.extent(1)); ++a)
      if (in.cells(c, a) == node) return a;
    return -1;
  }
  KOKKOS_FUNCTION int node_of_facet(const LO f, const LO node) const
  {
    for (int a = 0; a < static_cast<int>(in.facets.node.extent(1)); ++a)
      if (in.facets.node(f, a) == node) return a;
    return -1;
  }
  KOKKOS_FUNCTION bool is_known(const LO f, const int i) const
  {
    return in.facets.on_boundary(f) && boundary.known(f, i);
  }
  KOKKOS_FUNCTION bool same_as_before(const LO node, const int i) const
  {
    if (i == 0) return false;
    for (std::size_t k = around.row(node); k < around.row(node + 1); ++k)
      for (int s = 0; s < 4; ++s) {
        const LO f = in.facets.of_cell(around.cell(k), s);
        if (in.facets.on_boundary(f) && boundary.known(f, i) != boundary.known(f, i - 1)) return false;
      }
    return true;
  }

  /// Cholesky factor of the matrix of a component; a pivot that vanishes is that of even changes, which nothing determines.
  /// @return whether there is one
  KOKKOS_FUNCTION bool factor(const LO node, const int i, double *L) const
  {
    const std::size_t begin = around.row(node);
    const int n = static_cast<int>(around.row(node + 1) - begin);
    for (int k = 0; k < n * n; ++k) L[k] = 0;
    for (int k = 0; k < n; ++k) {
      const LO c = around.cell(begin + k);
      for (int s = 0; s < 4; ++s) {
        const LO f = in.facets.of_cell(c, s);
        if (node_of_facet(f, node) < 0 || is_known(f, i)) continue;
        const double w = area(f);
        L[k * n + k] += w;
        if (in.facets.on_boundary(f)) continue;
        const LO other = in.facets.cell(f, 0) == c ? in.facets.cell(f, 1) : in.facets.cell(f, 0);
        for (int l = 0; l < k; ++l)
          if (around.cell(begin + l) == other) L[k * n + l] -= w;
      }
    }
    bool singular = false;
    for (int j = 0; j < n; ++j) {
      const double own = L[j * n + j];
      for (int k = 0; k < j; ++k) {
        const double by = L[j * n + k];
        for (int r = j; by != 0 && r < n; ++r) L[r * n + j] -= L[r * n + k] * by;
      }
      if (!(L[j * n + j] > 1e-10 * own)) {
        singular = true;
        for (int r = j; r < n; ++r) L[r * n + j] = 0;
        continue;
      }
      const double pivot = math::sqrt(L[j * n + j]);
      for (int r = j; r < n; ++r) L[r * n + j] /= pivot;
    }
    return singular;
  }

  KOKKOS_FUNCTION void operator()(const LO of_batch) const
  {
    const LO node = from + of_batch;
    double *const L = matrix.data() + (first(node) - first(from));
    if (same_as_before(node, 1) && same_as_before(node, 2)) {
      solve<3>(node, 0, factor(node, 0, L), L);
      return;
    }
    bool singular = false;
    for (int i = 0; i < 3; ++i) {
      if (!same_as_before(node, i)) singular = factor(node, i, L);
      solve<1>(node, i, singular, L);
    }
  }
  /// Some components, from one on, with one factor: no addition waits for another component's.
  template <int Count>
  KOKKOS_FUNCTION void solve(const LO node, const int begin_with, const bool singular, double *const L) const
  {
    const std::size_t begin = around.row(node);
    const int n = static_cast<int>(around.row(node + 1) - begin);
    double *const sent = L + n * n; // (cells, Count)
    double rest[Count] = {};
    for (int k = 0; k < n; ++k) { // what lacks
      const LO c = around.cell(begin + k);
      double r[Count];
      const int own = node_of_cell(c, node);
      for (int i = 0; i < Count; ++i) r[i] = Q(c, own, begin_with + i);
      for (int s = 0; s < 4; ++s) {
        const LO f = in.facets.of_cell(c, s);
        const int a = node_of_facet(f, node);
        if (a < 0) continue;
        const double sign = in.facets.sign(c, s);
        for (int i = 0; i < Count; ++i)
          r[i] -= sign * (is_known(f, begin_with + i) ? known(f, a, begin_with + i) : mean(at(f, a) + begin_with + i));
      }
      for (int i = 0; i < Count; ++i) {
        sent[k * Count + i] = r[i];
        rest[i] += r[i];
      }
    }
    for (int k = 0; singular && k < n; ++k) // what a solve has left of the balance of the star is shared by its cells
      for (int i = 0; i < Count; ++i) sent[k * Count + i] -= rest[i] / n;
    for (int j = 0; j < n; ++j) {
      double x[Count];
      for (int i = 0; i < Count; ++i) x[i] = sent[j * Count + i];
      for (int k = 0; k < j; ++k)
        for (int i = 0; i < Count; ++i) x[i] -= L[j * n + k] * sent[k * Count + i];
      for (int i = 0; i < Count; ++i) sent[j * Count + i] = L[j * n + j] > 0 ? x[i] / L[j * n + j] : 0;
    }
    for (int j = n - 1; j >= 0; --j) {
      double x[Count];
      for (int i = 0; i < Count; ++i) x[i] = sent[j * Count + i];
      for (int k = j + 1; k < n; ++k)
        for (int i = 0; i < Count; ++i) x[i] -= L[k * n + j] * sent[k * Count + i];
      for (int i = 0; i < Count; ++i) sent[j * Count + i] = L[j * n + j] > 0 ? x[i] / L[j * n + j] : 0;
    }
    for (int k = 0; k < n; ++k) {
      const LO c = around.cell(begin + k);
      const int own = node_of_cell(c, node);
      for (int i = 0; i < Count; ++i) Q(c, own, begin_with + i) = sent[k * Count + i];
    }
  }

  /// The moments of a facet with the function of its node a.
  KOKKOS_FUNCTION void moments(const LO f, const int a, double (&m)[3]) const
  {
    const LO node = in.facets.node(f, a);
    double change[3] = {};
    for (int side = 0; side < 2; ++side) {
      const LO c = in.facets.cell(f, side);
      if (c < 0) continue;
      const int own = node_of_cell(c, node);
      for (int i = 0; i < 3; ++i) change[i] += (side == 0 ? 1 : -1) * Q(c, own, i);
    }
    for (int i = 0; i < 3; ++i) m[i] = is_known(f, i) ? known(f, a, i) : mean(at(f, a) + i) + area(f) * change[i];
  }
};

} // namespace

namespace
{

/// (facets) In one relation to their areas.
DeviceView<double *> areas_of(const SpaceInput &in)
{
  const DeviceView<double *> areas("rpc::bound::areas", in.facets.size());
  Kokkos::parallel_for(
      "rpc::bound::areas", device_range(in.facets.size()), KOKKOS_LAMBDA(const LO f) {
        const FacetFrame frame(in, f);
        areas(f) = math::sqrt(frame.normal[0] * frame.normal[0] + frame.normal[1] * frame.normal[1] +
                              frame.normal[2] * frame.normal[2]);
      });
  Kokkos::fence();
  return areas;
}

} // namespace

DeviceView<double ***> known_moments(const SpaceInput &in, const BoundaryTractions &boundary)
{
  const int functions = static_cast<int>(in.facets.node.extent(1));
  DeviceView<double ***> m("rpc::bound::known_moments", in.facets.num_outer, functions, 3);
  const auto load = boundary.load;
  const auto moment = in.tables.moment;
  const SpaceFacets facets = in.facets;
  Kokkos::parallel_for(
      "rpc::bound::known_moments", device_range(facets.num_outer), KOKKOS_LAMBDA(const LO f) {
        if (!facets.on_boundary(f)) return;
        for (int a = 0; a < functions; ++a)
          for (int j = 0; j < functions; ++j) // the polynomials beyond have none
            for (int i = 0; i < 3; ++i) m(f, a, i) += moment(j, a) * load(f, j, i);
      });
  Kokkos::fence();
  return m;
}

Tractions equilibrated(const SpaceInput &in, const BoundaryTractions &boundary, const DeviceView<double ***> &Q,
                       const Tractions &mean, const fem::NodeToCells &around, const SpaceExchanges &exchanges)
{
  const LO nodes = static_cast<LO>(around.row.extent(0)) - 1;
  const int functions = static_cast<int>(in.facets.node.extent(1));
  DeviceView<std::size_t *> first("rpc::bound::first", nodes + 1);
  std::size_t total = 0;
  Kokkos::parallel_scan(
      "rpc::bound::sizes_of_stars", device_range(nodes),
      KOKKOS_LAMBDA(const LO node, std::size_t &before, const bool last) {
        if (last) first(node) = before;
        const std::size_t n = around.row(node + 1) - around.row(node);
        before += n * n + 3 * n;
      },
      total);
  const auto begins = to_host(first);
  constexpr LO batch = on_gpu ? 131072 : 2048; // stars at once: what bounds the work space, and what keeps a GPU busy
  const auto end_of = [&](const LO from) { return std::min(nodes, from + batch); };
  const auto begin_of = [&](const LO node) { return node < nodes ? begins(node) : total; };
  std::size_t most = 0;
  for (LO from = 0; from < nodes; from += batch) most = std::max(most, begin_of(end_of(from)) - begin_of(from));
  BalanceStarsInSpace stars{
      in,
      boundary,
      Q,
      mean,
      known_moments(in, boundary),
      around,
      first,
      0,
      DeviceView<double *>(Kokkos::view_alloc("rpc::bound::matrix", Kokkos::WithoutInitializing), most),
      areas_of(in)};
  for (; stars.from < nodes; stars.from += batch)
    Kokkos::parallel_for("rpc::bound::balance_stars", device_range(end_of(stars.from) - stars.from), stars);
  // Moments of functions at other ranks' nodes are fetched, and so are tractions of other ranks' facets.
  const auto at_nodes = exchanges.of_nodes.served(), of_facets = exchanges.of_facets.served();
  const DeviceView<double **> served("rpc::bound::served_moments", at_nodes.extent(0), 3);
  Kokkos::parallel_for(
      "rpc::bound::serve_moments", device_range(static_cast<LO>(at_nodes.extent(0))), KOKKOS_LAMBDA(const LO k) {
        double m[3];
        stars.moments(at_nodes(k, 0), at_nodes(k, 1), m);
        for (int i = 0; i < 3; ++i) served(k, i) = m[i];
      });
  const DeviceView<double **> fetched = exchanges.of_nodes.fetched(served);
  const int per_facet = 3 * functions;
  const Tractions &t = mean; // of a facet by its own moments
  const auto from = in.tables.from_moments;
  const auto load = boundary.load;
  const SpaceFacets facets = in.facets;
  const SlotExchange::Rows row = exchanges.of_nodes.rows(), row_of_facet = exchanges.of_facets.rows();
  Kokkos::parallel_for(
      "rpc::bound::tractions_from_moments", device_range(in.facets.size()), KOKKOS_LAMBDA(const LO f) {
        if (!facets.counts(f)) return; // taken below
        const std::size_t at = static_cast<std::size_t>(f) * per_facet;
        double moment[SpaceSizes<2>::functions][3];
        for (int a = 0; a < functions; ++a) {
          const LO there = row(f, a);
          if (there < 0)
            stars.moments(f, a, moment[a]);
          else
            for (int i = 0; i < 3; ++i) moment[a][i] = fetched(there, i);
        }
        for (int j = 0; j < functions; ++j)
          for (int i = 0; i < 3; ++i) {
            t(at + 3 * j + i) = 0;
            for (int a = 0; a < functions; ++a) t(at + 3 * j + i) += from(j, a) * moment[a][i];
          }
        for (int i = 0; i < 3; ++i)
          for (int j = 0; stars.is_known(f, i) && j < functions; ++j) t(at + 3 * j + i) = load(f, j, i);
      });
  const DeviceView<double **> served_tractions("rpc::bound::served_tractions", of_facets.extent(0), per_facet);
  Kokkos::parallel_for(
      "rpc::bound::serve_tractions", device_range(static_cast<LO>(of_facets.extent(0))), KOKKOS_LAMBDA(const LO k) {
        for (int q = 0; q < per_facet; ++q)
          served_tractions(k, q) = t(static_cast<std::size_t>(of_facets(k, 0)) * per_facet + q);
      });
  const DeviceView<double **> taken = exchanges.of_facets.fetched(served_tractions);
  Kokkos::parallel_for(
      "rpc::bound::take_tractions_in_space", device_range(in.facets.size()), KOKKOS_LAMBDA(const LO f) {
        const LO there = row_of_facet(f, 0);
        for (int q = 0; q < per_facet && there >= 0; ++q)
          t(static_cast<std::size_t>(f) * per_facet + q) = taken(there, q);
      });
  Kokkos::fence();
  return t;
}

} // namespace rpc::bound
