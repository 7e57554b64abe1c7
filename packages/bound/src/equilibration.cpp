// SPDX-License-Identifier: BSD-3-Clause
#include "equilibration.hpp"

namespace rpc::bound
{
namespace
{

/// Moments with the three functions of a facet of order 2 or the two of order 1 from Legendre coefficients, and back.
KOKKOS_INLINE_FUNCTION void moments_of(const int order, const double (&t)[3], double (&m)[3])
{
  if (order == 1) {
    m[0] = t[0] / 2 - t[1] / 6;
    m[1] = t[0] / 2 + t[1] / 6;
    m[2] = 0;
    return;
  }
  m[0] = t[0] / 6 - t[1] / 6 + t[2] / 15;
  m[1] = t[0] / 6 + t[1] / 6 + t[2] / 15;
  m[2] = 2 * t[0] / 3 - 2 * t[2] / 15;
}

KOKKOS_INLINE_FUNCTION void tractions_from(const int order, const double (&m)[3], double (&t)[3])
{
  t[0] = m[0] + m[1] + (order == 1 ? 0 : m[2]);
  t[1] = 3 * (m[1] - m[0]);
  t[2] = order == 1 ? 0 : 7.5 * (m[0] + m[1] - t[0] / 3);
}

/// The moments at the spokes of a star from the balance of its cells: each spoke's differs from the one before by what the cell between
/// them asks for, and the first one is known, or brings all as near as can be to the mean of both sides.
struct BalanceStars {
  CellInput in;
  BoundaryTractions boundary;
  DeviceView<double ***> Q, mean, known; // in
  DeviceView<double ***> moment;         // (facets, 3, 2) out

  KOKKOS_FUNCTION int end_of(const LO node, const LO f) const { return in.facets.node(f, 0) == node ? 0 : 1; }
  /// Its moment as seen by the cell behind the spoke.
  KOKKOS_FUNCTION double seen(const DeviceView<double ***> &table, const LO node, const int k, const int i) const
  {
    const std::size_t at = in.facets.first_spoke(node) + k;
    const LO f = in.facets.spoke(at);
    return in.facets.toward(at) * table(f, end_of(node, f), i);
  }
  KOKKOS_FUNCTION double square_weight(const LO node, const int k) const
  {
    const LO f = in.facets.spoke(in.facets.first_spoke(node) + k);
    const double x = in.coords(in.facets.node(f, 1), 0) - in.coords(in.facets.node(f, 0), 0);
    const double y = in.coords(in.facets.node(f, 1), 1) - in.coords(in.facets.node(f, 0), 1);
    return 1 / math::sqrt(x * x + y * y);
  }
  KOKKOS_FUNCTION double asked(const LO node, const int k, const int i) const
  {
    const std::size_t at = in.facets.first(node) + k;
    return Q(in.facets.star_cell(at), in.facets.star_corner(at), i);
  }
  KOKKOS_FUNCTION bool is_known(const LO node, const int k, const int i) const
  {
    const LO f = in.facets.spoke(in.facets.first_spoke(node) + k);
    return in.facets.on_boundary(f) && boundary.known(f, i);
  }

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    const int spokes = in.facets.num_spokes(node), cells = spokes == 0 ? 0 : in.facets.num_cells(node);
    for (int i = 0; i < 2 && spokes > 0; ++i) {
      const bool closed = spokes == cells, from = !closed && is_known(node, 0, i),
                 to = !closed && is_known(node, cells, i);
      // What a solve has left of the balance of the star is shared by its cells.
      double rest = 0, sum = 0, weights = 0, m = 0;
      for (int k = 0; k < cells; ++k) rest += asked(node, k, i);
      if (from && to) rest -= seen(known, node, 0, i) - seen(known, node, cells, i);
      rest = closed || (from && to) ? rest / cells : 0;
      for (int k = 0; k < spokes; ++k) {
        const double w = square_weight(node, k);
        sum += w * (seen(mean, node, k, i) - m);
        weights += w;
        if (k < cells) m -= asked(node, k, i) - rest;
      }
      if (from)
        m = seen(known, node, 0, i);
      else if (to) {
        m = seen(known, node, cells, i);
        for (int k = 0; k < cells; ++k) m += asked(node, k, i);
      } else
        m = sum / weights;
      for (int k = 0; k < spokes; ++k) {
        const std::size_t at = in.facets.first_spoke(node) + k;
        const LO f = in.facets.spoke(at);
        moment(f, end_of(node, f), i) = in.facets.toward(at) * m;
        if (k < cells) m -= asked(node, k, i) - rest;
      }
    }
  }
};

/// Values at ends whose vertices other ranks own.
void take_fetched(const FacetExchange &exchange, const DeviceView<double ***> &values, const std::vector<double> &flip)
{
  const auto fetched = exchange.fetch(values, flip);
  const auto row = exchange.row();
  const int width = static_cast<int>(flip.size());
  Kokkos::parallel_for(
      "rpc::bound::take_fetched", device_range(static_cast<LO>(row.extent(0))), KOKKOS_LAMBDA(const LO f) {
        for (int end = 0; end < 2; ++end)
          for (int q = 0; q < width && row(f, end) >= 0; ++q) values(f, end, q) = fetched(row(f, end), q);
      });
  Kokkos::fence();
}

} // namespace

DeviceView<double ***> known_moments(const CellInput &in, const BoundaryTractions &boundary)
{
  const int order = in.reference.degree;
  DeviceView<double ***> m("rpc::bound::known_moments", in.facets.size(), 3, 2);
  const auto load = boundary.load;
  const Facets facets = in.facets;
  Kokkos::parallel_for(
      "rpc::bound::known_moments", device_range(facets.size()), KOKKOS_LAMBDA(const LO f) {
        if (!facets.on_boundary(f)) return;
        for (int i = 0; i < 2; ++i) {
          const double t[3] = {load(f, 0, i), load(f, 1, i), load(f, 2, i)};
          double moments[3];
          moments_of(order, t, moments);
          for (int a = 0; a < 3; ++a) m(f, a, i) = moments[a];
        }
      });
  Kokkos::fence();
  return m;
}

Tractions equilibrated(const CellInput &in, const BoundaryTractions &boundary, const DeviceView<double ***> &Q,
                       const DeviceView<double ***> &mean, const FacetExchange &exchange)
{
  const int order = in.reference.degree, sides = in.reference.sides, per_facet = 2 * (order + 1);
  const Facets facets = in.facets;
  DeviceView<double ***> moment("rpc::bound::moments", facets.size(), 3, 2);
  const auto known = known_moments(in, boundary);
  Kokkos::parallel_for("rpc::bound::balance_stars", device_range(static_cast<LO>(facets.num_spokes.extent(0))),
                       BalanceStars{in, boundary, Q, mean, known, moment});
  take_fetched(exchange, moment, {-1, -1});
  const Tractions t("rpc::bound::tractions", static_cast<std::size_t>(facets.size()) * per_facet);
  const auto load = boundary.load;
  const auto is_known = boundary.known;
  Kokkos::parallel_for(
      "rpc::bound::tractions_from_moments", device_range(facets.size()), KOKKOS_LAMBDA(const LO f) {
        const bool outside = facets.on_boundary(f);
        for (int i = 0; i < 2; ++i) {
          double m[3] = {moment(f, 0, i), moment(f, 1, i), 0}, x[3];
          if (order == 2) {
            m[2] = Q(facets.cell(f, 0), sides + facets.ordinal(f, 0), i);
            if (!outside) m[2] = (m[2] - Q(facets.cell(f, 1), sides + facets.ordinal(f, 1), i)) / 2;
          }
          tractions_from(order, m, x);
          for (int j = 0; j <= order; ++j)
            t(f * per_facet + 2 * j + i) = outside && is_known(f, i) ? load(f, j, i) : x[j];
        }
      });
  Kokkos::fence();
  // Facets without a vertex of this rank, which may lack a cell: the rank of one of their vertices has both.
  std::vector<double> flip;
  for (int j = 0; j <= order; ++j) flip.insert(flip.end(), 2, side_factor(-1, j));
  const DeviceView<double ***> at_ends("rpc::bound::at_ends", facets.size(), 2, per_facet);
  Kokkos::parallel_for(
      "rpc::bound::at_ends", device_range(facets.size()), KOKKOS_LAMBDA(const LO f) {
        for (int q = 0; q < per_facet; ++q) at_ends(f, 0, q) = at_ends(f, 1, q) = t(f * per_facet + q);
      });
  Kokkos::fence();
  const auto fetched = exchange.fetch(at_ends, flip);
  const auto row = exchange.row();
  Kokkos::parallel_for(
      "rpc::bound::take_tractions", device_range(facets.size()), KOKKOS_LAMBDA(const LO f) {
        if (row(f, 0) < 0 || row(f, 1) < 0) return;
        for (int q = 0; q < per_facet; ++q) t(f * per_facet + q) = fetched(row(f, 0), q);
      });
  Kokkos::fence();
  return t;
}

} // namespace rpc::bound
