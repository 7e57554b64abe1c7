// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/adapt/estimators/recovered.hpp"

#include "contact_ends.hpp"
#include "gap_slopes.hpp"
#include "highest_order.hpp"
#include "jumps.hpp"
#include "rpc/fem/rounding.hpp"
#include "rpc/fem/stress.hpp"
#include "rpc/fem/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::adapt
{
namespace
{

/// The columns of a node's law, for kernels.
template <class Columns>
struct LawAt {
  const Columns &columns;
  LO node;
  KOKKOS_INLINE_FUNCTION double &operator()(const int k) const { return columns(node, law + k); }
};

/// The columns of friction at the owned nodes of one side.
/// @param accuracy  slip of a node that sticks, times its scaling, that is left by a solve [Pa]
template <class Columns>
void add_friction_fields(const contact::ContactNodes &c, const contact::ContactResult &result, const int side,
                         const double accuracy, const Columns &to)
{
  const LO begin = c.first(side);
  const double highest = result.total.max_pressure;
  const auto p = result.pressure;
  const auto q = result.traction, e = result.slip;
  const auto state = result.slip_state;
  Kokkos::parallel_for(
      "rpc::adapt::friction_fields", device_range(c.first(side + 1) - begin), KOKKOS_LAMBDA(const LO k) {
        const LO i = begin + k, node = c.node(i);
        double size = 0;
        for (int j = 0; j < c.dim; ++j) size += e(i, j) * e(i, j);
        const bool sticks = state(i) == 1 + int(contact::Slip::stick) && c.scaling(i) * math::sqrt(size) <= accuracy;
        for (int j = 0; j < c.dim; ++j) {
          to(node, traction + j) = q(i, j);
          to(node, slip + j) = sticks ? 0 : e(i, j);
        }
        to(node, int(bound)) = contact::friction_bound(p(i), c.friction(i));
        to(node, int(bearable)) = contact::friction_bound(highest, c.friction(i));
      });
  Kokkos::fence();
}

/// What the contact nodes of one side know, at the nodes of its facets (overlap nodes; columns).
RCP<const MultiVector> at_overlap_nodes(const fem::Discretization &d, const contact::ContactNodes &c,
                                        const contact::ContactResult &result, const int side)
{
  // A yield stress out of reach, maybe infinite, gives way to one that no pressure reaches either.
  const double highest_yield = 2 * std::max(result.total.max_pressure, 1e-300);
  // Nodes that neither are open nor yield have v = c p. What a solve leaves there, some 1e-8 of the largest pressure,
  // would count with p |v|, which is of first order, and differ between numbers of ranks.
  const double accuracy = 1e-7 * result.total.max_pressure;
  const auto owned = rcp(new MultiVector(d.mesh->owned_nodes, c.friction.anywhere ? int(num_columns) : normal + c.dim));
  const LO begin = c.first(side);
  const auto p = result.pressure, v = result.penetration, dents = result.dent;
  {
    const auto to = owned->getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for( // a node that misses the obstacle is open: no pressure, no normal
        "rpc::adapt::rigid_elsewhere", device_range(static_cast<LO>(to.extent(0))), KOKKOS_LAMBDA(const LO node) {
          contact::to_columns_of_rigid(highest_yield, LawAt<decltype(to)>{to, node});
        });
    Kokkos::parallel_for(
        "rpc::adapt::contact_fields", device_range(c.first(side + 1) - begin), KOKKOS_LAMBDA(const LO k) {
          const LO i = begin + k, node = c.node(i);
          to(node, int(pressure)) = p(i);
          const contact::Foundation f = c.law(i);
          const bool closed = contact::state_of_pressure(p(i), f) == contact::State::closed;
          const double now = v(i) - c.dent(i), elastic = contact::resting_penetration(p(i), f);
          const double miss = now < elastic ? elastic - now : now - elastic;
          to(node, int(penetration)) = closed && c.scaling(i) * miss <= accuracy ? elastic : now;
          contact::to_columns(f, highest_yield, LawAt<decltype(to)>{to, node});
          to(node, int(gap)) = c.gap(i) + c.dent(i);
          to(node, int(dent)) = c.dent(i);
          to(node, int(pressed)) = dents(i) + elastic;
          for (int j = 0; j < c.dim; ++j) to(node, normal + j) = c.normal(i, j);
        });
    Kokkos::fence();
    if (c.friction.anywhere) add_friction_fields(c, result, side, accuracy, to);
  }
  return fem::nodes_on_overlap(d, owned);
}

/// Adds the parts of facets to their cells, in ascending order: a cell may have several facets, and sums have one order.
void add_to_cells(const mesh::Side &side, const DeviceView<double *> &of_facet, const DeviceView<double *> &squared)
{
  const auto cell = side.cell;
  const LO num_facets = static_cast<LO>(cell.extent(0)), num_owned_cells = static_cast<LO>(squared.extent(0));
  Kokkos::parallel_for(
      "rpc::adapt::add_to_cells", device_range(1), KOKKOS_LAMBDA(const LO) {
        for (LO f = 0; f < num_facets; ++f)
          if (cell(f) < num_owned_cells) squared(cell(f)) += of_facet(f);
      });
  Kokkos::fence();
}

/// Half of the smallest width among the facets of each cell, where there is one.
void take_half_of_least(const mesh::Side &side, const DeviceView<double *> &width, const DeviceView<double *> &half)
{
  const auto cell = side.cell;
  const LO num_facets = static_cast<LO>(cell.extent(0)), num_owned_cells = static_cast<LO>(half.extent(0));
  Kokkos::parallel_for(
      "rpc::adapt::take_half_of_least", device_range(1), KOKKOS_LAMBDA(const LO) {
        for (LO f = 0; f < num_facets; ++f)
          if (cell(f) < num_owned_cells && width(f) > 0 && !(half(cell(f)) > 0 && half(cell(f)) <= width(f) / 2))
            half(cell(f)) = width(f) / 2;
      });
  Kokkos::fence();
}

/// How far the multiplier's pressure and that of the recovered stress lie apart where the former is near its largest value.
struct PeakDifference {
  ContactTerms terms; // in
  double highest = 0; // pressure  [Pa]  in
  static constexpr double share = 0.9;

  /// @param spread         max of the differences between the nodes of a facet that yields and has the largest pressure  [Pa]
  /// @param most           max of the absolute difference at other points                                                [Pa]
  /// @param squared, area  += integrals of its square and of 1 over owned facets                     [Pa^2 m^(dim-1)], [m^(dim-1)]
  KOKKOS_FUNCTION void operator()(const LO f, double &spread, double &most, double &squared, double &area) const
  {
    // The pressure is the yield stress, known at the nodes.
    if (terms.state_of(f) == ContactTerms::FacetState::yielding && !contact::hardens(terms.law_at(f, 0))) {
      double high = 0, low = highest;
      for (std::size_t a = 0; a < terms.facets.extent(1); ++a) {
        const double p = terms.field(terms.facets(f, a), int(pressure));
        high = math::fmax(high, p);
        low = math::fmin(low, p);
      }
      if (high >= highest) spread = math::fmax(spread, high - low);
      return;
    }
    for (int q = 0; q < static_cast<int>(terms.value.extent(0)); ++q) {
      const auto x = terms.point(f, q, false);
      const double p = x.at[pressure];
      if (!(p > 0 && p >= share * highest)) continue;
      const double difference = p - contact::admissible(x.recovered, contact::from_columns(x.at + law));
      most = math::fmax(most, difference < 0 ? -difference : difference);
      if (terms.cell(f) >= terms.num_owned_cells) continue;
      const double part = terms.measure(f * static_cast<int>(terms.value.extent(0)) + q);
      squared += part * difference * difference;
      area += part;
    }
  }
};

/// What the nodes of the facets tell of the largest pressure and of the ends of contact.                          (10.8)
struct NodalPressures {
  ContactTerms terms; // in
  GapSlopes slopes;   // in
  ReadColumns around; // see gap_slopes()  in
  double highest = 0; // pressure  [Pa]  in
  static constexpr double near_peak = 0.98;
  static constexpr double jump = 0.1; // of the yield stress between nodes of a facet, over the lower one

  KOKKOS_FUNCTION double at(const LO f, const int a, const int column) const
  {
    return terms.field(terms.facets(f, a), column);
  }

  /// @param drop   max of (highest - lowest) / peak over facets at the peak     @param yield_jumps, gap_jumps, dented_jumps  numbers
  /// @param ends   += half of the facets that are partly open [m^(dim-1)]
  KOKKOS_FUNCTION void operator()(const LO f, double &drop, double &yield_jumps, double &gap_jumps,
                                  double &dented_jumps, double &ends) const
  {
    if (terms.cell(f) >= terms.num_owned_cells || !(highest > 0)) return;
    const int nodes = static_cast<int>(terms.facets.extent(1));
    const double area = terms.area(f), smooth = terms.smooth_opening(f);
    const bool at_once = rises_at_once(slopes, around, f, smooth);
    double most = at(f, 0, pressure), least = most;
    for (int a = 0; a < nodes; ++a) {
      const double p = at(f, a, pressure), xi = contact::yield_limit(terms.law_at(f, a));
      most = math::fmax(most, p);
      least = math::fmin(least, p);
      for (int b = 0; b < nodes; ++b) {
        const double other = at(f, b, pressure), other_xi = contact::yield_limit(terms.law_at(f, b));
        if (p >= xi && other < other_xi && other_xi > highest && other_xi > (1 + jump) * xi) yield_jumps += 1;
        const bool jumps = other == 0 && -at(f, b, penetration) > smooth && at_once;
        if (jumps && p > 0 && xi > highest && !terms.on_springs(f, a)) gap_jumps += 1;
        if (jumps && at(f, a, dent) > smooth) dented_jumps += 1;
      }
    }
    if (most >= near_peak * highest) drop = math::fmax(drop, (most - least) / highest);
    if (most > 0 && !(least > 0)) ends += area / 2;
  }
};

using PressureBounds = Kokkos::MinMax<double>;

/// Of the points of all contact sides: from which pressure the foundation may give way, and what no pressure can exceed, maybe infinite;
/// collective.
PressureBounds::value_type pressure_bounds(const Comm &comm, const contact::ContactNodes &c)
{
  const contact::ContactNodes points = c;
  PressureBounds::value_type bounds;
  Kokkos::parallel_reduce(
      "rpc::adapt::pressure_bounds", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, PressureBounds::value_type &of) {
        of.min_val = math::fmin(of.min_val, contact::gives_way_from(points.law(i)));
        of.max_val = math::fmax(of.max_val, contact::largest_bearable(points.law(i)));
      },
      PressureBounds(bounds));
  // Kokkos' minimum of infinities, or over no points, is DBL_MAX, its maximum over no points -DBL_MAX.
  bounds = {min_all(comm, bounds.min_val), max_all(comm, std::max(0., bounds.max_val))};
  if (bounds.min_val == std::numeric_limits<double>::max()) bounds.min_val = std::numeric_limits<double>::infinity();
  return bounds;
}

} // namespace

ErrorEstimate recovered_estimate(const EstimateInput &of)
{
  const fem::Discretization &d = of.discretization;
  const fem::Materials &materials = of.materials;
  const mesh::Mesh &mesh = *d.mesh;
  const fem::RecoveredStress recovered(d, materials, of.u);
  ErrorEstimate estimate;
  estimate.squared = recovered.squared_difference();
  const auto squared = estimate.squared;
  const double highest = of.result.total.max_pressure;
  const contact::BetweenNodes &unseen = of.result.between;
  estimate.unseen_squared = DeviceView<double *>("rpc::adapt::unseen_squared", squared.extent(0));
  estimate.seen_from = DeviceView<double *>("rpc::adapt::seen_from", squared.extent(0));
  const auto bounds = pressure_bounds(mesh.comm(), of.contact);
  estimate.peak.at_bound = highest >= (1 - 1e-12) * bounds.max_val;
  estimate.peak.lowest_bound = bounds.min_val;
  constexpr int num_sums = 17;
  double sums[num_sums] = {}, peak = 0, spread = 0, drop = 0, kink = 0, rounded = 0, rounded_depth = 0,
         deepest = 0; // Kokkos' maximum over no facets is -DBL_MAX
  Kokkos::parallel_reduce(
      "rpc::adapt::recovery", device_range(mesh.num_owned_cells),
      KOKKOS_LAMBDA(const LO cell, double &sum) { sum += squared(cell); }, sums[0]);
  for (std::size_t k = 0; k < of.sides.size(); ++k) {
    const mesh::Side &side = *of.sides[k];
    const auto fields = at_overlap_nodes(d, of.contact, of.result, static_cast<int>(k));
    const ContactTerms terms{side.facets,
                             side.cell,
                             d.reference.facet.value,
                             fem::facet_measure(d, side),
                             fem::facet_size(d, side),
                             recovered.tractions(side),
                             fem::tractions_on(d, side, of.loads),
                             mesh.block,
                             fem::lame_table(d, materials),
                             fields->getLocalViewDevice(Tpetra::Access::ReadOnly),
                             mesh.num_owned_cells,
                             of.contact.friction.anywhere,
                             highest,
                             DeviceView<double *>("rpc::adapt::contact_terms", side.facets.extent(0))};
    double of_side[num_sums - 1] = {}, peak_of_side = 0, spread_of_side = 0, drop_of_side = 0;
    const auto facets = device_range(static_cast<LO>(side.facets.extent(0)));
    Kokkos::parallel_reduce("rpc::adapt::contact_terms", facets, terms, of_side[0], of_side[1], of_side[2]);
    add_to_cells(side, terms.squared, squared);
    if (!unseen.unseen_squared.empty()) {
      add_to_cells(side, unseen.unseen_squared[k], squared);
      add_to_cells(side, unseen.unseen_squared[k], estimate.unseen_squared);
      take_half_of_least(side, unseen.unseen_width[k], estimate.seen_from);
    }
    const GapSlopes slopes{
        terms, mesh.coords, mesh.element.facet().num_vertices(),
        DeviceView<double **>("rpc::adapt::steepest_gap", terms.field.extent(0), int(GapSlopes::num_around))};
    const auto around = gap_slopes(d, slopes);
    const NodalPressures nodal{terms, slopes, around->getLocalViewDevice(Tpetra::Access::ReadOnly), highest};
    Kokkos::parallel_reduce("rpc::adapt::nodal_pressures", facets, nodal, Kokkos::Max<double>(drop_of_side), of_side[3],
                            of_side[4], of_side[12], of_side[5]);
    drop = std::max(drop, drop_of_side);
    const SingularNodes singular = singular_nodes(d, terms);
    kink = std::max(kink, singular.kink);
    rounded = std::max(rounded, singular.rounded);
    rounded_depth = std::max(rounded_depth, singular.rounded_depth);
    double depth = 0, most = 0;
    Kokkos::parallel_reduce("rpc::adapt::highest_order", facets,
                            HighestOrder{terms, mesh.element.facet().num_vertices()}, Kokkos::Max<double>(depth),
                            Kokkos::Max<double>(most));
    deepest = std::max(deepest, depth);
    rounded = std::max(rounded, most - highest);
    of_side[11] = singular.edges;
    Kokkos::parallel_reduce("rpc::adapt::contact_ends", facets, ContactEnds{terms, mesh.element.order}, of_side[13],
                            of_side[14], of_side[15]);
    Kokkos::parallel_reduce("rpc::adapt::jumps", facets, Jumps{terms}, of_side[8], of_side[9], of_side[10]);
    if (!estimate.peak.at_bound) {
      Kokkos::parallel_reduce("rpc::adapt::peak_difference", facets, PeakDifference{terms, highest},
                              Kokkos::Max<double>(spread_of_side), Kokkos::Max<double>(peak_of_side), of_side[6],
                              of_side[7]);
      peak = std::max(peak, peak_of_side);
      spread = std::max(spread, spread_of_side);
    }
    for (int m = 1; m < num_sums; ++m) sums[m] += of_side[m - 1];
  }
  double all[num_sums];
  Teuchos::reduceAll(mesh.comm(), Teuchos::REDUCE_SUM, num_sums, sums, all);
  estimate.parts = {{"recovery", all[0]},
                    {"contact_equilibrium", all[1]},
                    {"contact_complementarity", all[2]},
                    {ErrorEstimate::unseen_contact, 2 * of.result.total.unseen_energy}};
  estimate.hidden = 2 * unseen.hidden_energy;
  estimate.rounding = fem::rounding_energy(d, materials, of.u);
  estimate.pressure = std::sqrt(all[3]);
  // In space the recovered stress is poor at single points of unstructured meshes: the mean tells more there.
  const double difference = mesh.dim() == 2 ? max_all(mesh.comm(), peak) : all[8] > 0 ? std::sqrt(all[7] / all[8]) : 0;
  estimate.max_pressure = std::max(max_all(mesh.comm(), spread), difference);
  estimate.peak.drop = max_all(mesh.comm(), drop);
  estimate.peak.yield_jump = all[4] > 0;
  estimate.peak.gap_jump = all[5] > 0;
  estimate.peak.dented_jump = all[13] > 0;
  estimate.contact_ends = all[6] + unseen.misread_ends;
  if (all[16] > 0) {
    const double of_ends = mesh.dim() == 2 ? all[14] : std::sqrt(2 * all[15]);
    estimate.ends_force = of_ends * of.result.total.contact_length / all[16];
  }
  estimate.peak.friction_jump = all[11] > 0;
  estimate.peak.friction_edge = all[12] > 0;
  estimate.peak.kink = max_all(mesh.comm(), kink);
  estimate.peak.rounded = max_all(mesh.comm(), rounded);
  estimate.peak.rounded_depth = max_all(mesh.comm(), rounded_depth);
  estimate.jumped_force = all[9];
  estimate.jumped_energy = all[10];
  estimate.misread_force = unseen.misread_force;
  estimate.misread_energy = unseen.misread_energy;
  estimate.interpolated = std::abs(unseen.interpolation_work);
  estimate.misread_penetration = std::max(
      {unseen.misread_penetration, of.result.deepest_on_axis, max_all(mesh.comm(), deepest)}); // (3.5b), (10.8c)
  return estimate;
}

} // namespace rpc::adapt
