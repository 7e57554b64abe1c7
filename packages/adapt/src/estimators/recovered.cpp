#include "rpc/adapt/estimators/recovered.hpp"

#include "rpc/contact/law/friction.hpp"
#include "rpc/contact/law/interpolated.hpp"
#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/law/states.hpp"
#include "rpc/core/math.hpp"
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

using ReadColumns = decltype(std::declval<const MultiVector &>().getLocalViewDevice(Tpetra::Access::ReadOnly));

// Columns of what a side's facets read at their nodes; those from the traction along the side on only where there is friction.
enum Column {
  pressure,
  penetration,
  law,
  normal = law + contact::law_columns,
  traction = normal + 3,
  slip = traction + 3,
  bound = slip + 3,
  num_columns
};

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
  const auto p = result.pressure, v = result.penetration;
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
          for (int j = 0; j < c.dim; ++j) to(node, normal + j) = c.normal(i, j);
        });
    Kokkos::fence();
    if (c.friction.anywhere) add_friction_fields(c, result, side, accuracy, to);
  }
  return fem::nodes_on_overlap(d, owned);
}

/// The contact terms of one side.
struct ContactTerms {
  DeviceView<LO **> facets;         // (facets, facet nodes)                    in
  DeviceView<LO *> cell;            // (facets)                                 in
  DeviceView<double **> value;      // (points, facet nodes)                    in
  DeviceView<double *> measure;     // (facets * points)           [m^(dim-1)]  in, axisymmetric: m^2
  DeviceView<double *> size;        // (facets)                           [m]  in
  DeviceView<double ***> recovered; // (facets, points, dim), tractions  [Pa]  in
  DeviceView<double ***> applied;   // (facets, points, dim)              [Pa]  in
  DeviceView<int *> block;          // (cells)                                  in
  DeviceView<double **> lame;       // (blocks; lambda, mu)               [Pa]  in
  ReadColumns field;                // (overlap nodes; Column)                  in
  LO num_owned_cells;
  bool friction;                // in
  double highest;               // pressure                     [Pa]      in
  DeviceView<double *> squared; // (facets), of owned cells    [J]       out

  // A gap that grows as at the end of a smooth contact stays below so many times the strain at the peak times the size of a facet: its
  // faces in space are longer than the root of their area, and their vertices have no weight.
  static constexpr double smooth_gap = 1, smooth_gap_in_space = 4;

  /// How far the nodes of a facet may lie clear of the foundation at the end of a smooth contact [m].              (10.4a)
  KOKKOS_FUNCTION double smooth_opening(const LO f) const
  {
    const int of = block(cell(f));
    const double modulus = lame(of, 0) + 2 * lame(of, 1);
    return (recovered.extent(2) == 2 ? smooth_gap : smooth_gap_in_space) * highest * size(f) / modulus;
  }

  /// The penetration of a facet at a point, of which open nodes tell no more than a smooth contact can open: past a jump of the gap
  /// there is nothing to read from how far they lie, and interpolants between them would rise above them all.    (10.4a)
  KOKKOS_FUNCTION double penetration_at(const LO f, const int q) const
  {
    const double least = -smooth_opening(f);
    bool jumps = false;
    double v = 0, most = least;
    for (std::size_t a = 0; a < facets.extent(1); ++a) {
      double at_node = field(facets(f, a), int(penetration));
      if (at_node < least && !(field(facets(f, a), int(pressure)) > 0)) {
        jumps = true;
        at_node = least;
      }
      most = math::fmax(most, at_node);
      v += shape(q, a, true) * at_node;
    }
    return jumps ? math::fmin(v, most) : v;
  }

  /// The law at a node of a facet.
  KOKKOS_FUNCTION contact::Foundation law_at(const LO f, const std::size_t a) const
  {
    double column[contact::law_columns];
    for (int k = 0; k < contact::law_columns; ++k) column[k] = field(facets(f, a), law + k);
    return contact::from_columns(column);
  }

  /// The state of the contact law at the nodes of a facet, or mixed: then the state between the nodes is not known.
  enum class FacetState { open = 1, closed = 2, yielding = 4, mixed };
  KOKKOS_FUNCTION FacetState state_of(const LO f) const
  {
    constexpr double jump = 0.1; // of the yield stress, over the lower one: its quadratic interpolant would be far off
    int state = 0;
    double least = contact::yield_limit(law_at(f, 0)), most = least;
    for (std::size_t a = 0; a < facets.extent(1); ++a) {
      const contact::Foundation at_node = law_at(f, a);
      const contact::State s = contact::state_of_pressure(field(facets(f, a), int(pressure)), at_node);
      const double xi = contact::yield_limit(at_node);
      state |= int(s == contact::State::yielding ? FacetState::yielding
                   : s == contact::State::closed ? FacetState::closed
                                                 : FacetState::open);
      least = math::fmin(least, xi);
      most = math::fmax(most, xi);
    }
    if (state != int(FacetState::open) && most > (1 + jump) * least) return FacetState::mixed;
    return state == 1 || state == 2 || state == 4 ? FacetState(state) : FacetState::mixed;
  }

  /// Whether nodes of a facet stick where others slip, or slip to opposite sides: then q is not known between them.
  KOKKOS_FUNCTION bool friction_is_mixed(const LO f) const
  {
    if (!friction) return false;
    for (std::size_t a = 0; a < facets.extent(1); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        double aa = 0, bb = 0, ab = 0;
        for (int k = slip; k < slip + 3; ++k) {
          const double at_a = field(facets(f, a), k), at_b = field(facets(f, b), k);
          aa += at_a * at_a;
          bb += at_b * at_b;
          ab += at_a * at_b;
        }
        if ((aa > 0) != (bb > 0) || ab < 0) return true;
      }
    return false;
  }

  /// The shape function of a facet's node at a point, or the one that is linear between neighbouring nodes: quadratic ones
  /// dip to the wrong side of 0 between the nodes where a state ends, which nodal quadrature does not see.
  KOKKOS_FUNCTION double shape(const int q, const std::size_t a, const bool linear) const
  {
    constexpr std::size_t quadratic_edge = 3; // ends, middle
    if (!linear || facets.extent(1) != quadratic_edge) return value(q, a);
    const double x = value(q, 1) - value(q, 0); // the reference coordinate, in [-1, 1]
    const double at_end = a == 0 ? -x : x, middle = x < 0 ? 1 + x : 1 - x;
    return a == 2 ? middle : (at_end > 0 ? at_end : 0);
  }

  /// Fields at a point of a facet, and the pressure of the recovered stress there.
  struct Point {
    double at[num_columns] = {}, rest[3] = {}, recovered = 0; // recovered: pressure
    KOKKOS_INLINE_FUNCTION contact::Along vector(const int column) const
    {
      return {{at[column], at[column + 1], at[column + 2]}};
    }
  };
  /// @param linear  for all fields, not for the penetration only
  KOKKOS_FUNCTION Point point(const LO f, const int q, const bool linear) const
  {
    const int dim = static_cast<int>(recovered.extent(2)), columns = friction ? int(num_columns) : normal + dim;
    Point x;
    for (std::size_t a = 0; a < facets.extent(1); ++a)
      for (int k = 0; k < columns; ++k) x.at[k] += shape(q, a, linear) * field(facets(f, a), k);
    x.at[penetration] = penetration_at(f, q);
    for (int i = 0; i < dim; ++i) {
      x.rest[i] = recovered(f, q, i) - applied(f, q, i);
      x.recovered -= x.rest[i] * x.at[normal + i];
    }
    return x;
  }

  /// q at a point: that of the nodes, or where their states are mixed the admissible one that minimizes (10.3) + (12.11).
  KOKKOS_FUNCTION contact::Along along_side(const Point &x, const bool mixed, const double compliance) const
  {
    const double s = math::larger(x.at[bound], 0);
    if (!mixed) return contact::admissible_friction(x.vector(traction), s);
    contact::Along rest; // the recovered traction along the side, of the body on the foundation
    for (int k = 0; k < 3; ++k) rest.x[k] = -x.rest[k] - x.recovered * x.at[normal + k];
    return contact::admissible_friction(rest.plus(1 / compliance, x.vector(slip)), s);
  }

  KOKKOS_FUNCTION void operator()(const LO f, double &equilibrium, double &complementarity, double &difference) const
  {
    if (cell(f) >= num_owned_cells) return;
    const int dim = static_cast<int>(recovered.extent(2)), points = static_cast<int>(value.extent(0));
    const int of = block(cell(f));
    // Stresses that balance r and fall to 0 over the depth h have the energy h/3 r^2 / (lambda + 2 mu).
    const double facet_compliance = size(f) / (3 * (lame(of, 0) + 2 * lame(of, 1)));
    const FacetState state = state_of(f);
    const bool slip_mixed = friction_is_mixed(f);
    double out_of_balance = 0, product = 0;
    for (int q = 0; q < points; ++q) {
      const Point x = point(f, q, state == FacetState::mixed || slip_mixed);
      const contact::Foundation foundation = contact::from_columns(x.at + law);
      const double v = x.at[penetration], share = measure(f * points + q);
      // On facets with several states: the admissible p that minimizes (10.3) + (10.4).
      const double p = state == FacetState::mixed ? contact::pressure(v, x.recovered, 1 / facet_compliance, foundation)
                                                  : contact::admissible(x.at[pressure], foundation);
      // By Fenchel and Young >= 0, but for rounding.
      product += share * math::fmax(0., contact::foundation_energy(v, foundation) +
                                            contact::conjugate_energy(p, foundation) - p * v);
      const contact::Along t = friction ? along_side(x, slip_mixed, facet_compliance) : contact::Along{};
      if (friction) product += share * contact::friction_gap(x.vector(slip), t, x.at[bound]);
      for (int i = 0; i < dim; ++i) {
        const double r = x.rest[i] + p * x.at[normal + i] + t(i);
        out_of_balance += facet_compliance * share * r * r;
      }
      const double other = x.at[pressure] - contact::admissible(x.recovered, foundation);
      const bool known = state == FacetState::open || (state == FacetState::yielding && !contact::hardens(foundation));
      if (!known) difference += share * other * other;
    }
    squared(f) = out_of_balance + 2 * product;
    equilibrium += out_of_balance;
    complementarity += 2 * product;
  }
};

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
  double highest = 0; // pressure  [Pa]  in
  static constexpr double near_peak = 0.98;
  static constexpr double jump = 0.1; // of the yield stress between nodes of a facet, over the lower one

  KOKKOS_FUNCTION double at(const LO f, const int a, const int column) const
  {
    return terms.field(terms.facets(f, a), column);
  }

  /// @param drop   max of (highest - lowest) / peak over facets at the peak     @param yield_jumps, gap_jumps  numbers
  /// @param ends   += half of the facets that are partly open [m^(dim-1)]
  KOKKOS_FUNCTION void operator()(const LO f, double &drop, double &yield_jumps, double &gap_jumps, double &ends) const
  {
    if (terms.cell(f) >= terms.num_owned_cells || !(highest > 0)) return;
    const int nodes = static_cast<int>(terms.facets.extent(1)), points = static_cast<int>(terms.value.extent(0));
    double area = 0;
    for (int q = 0; q < points; ++q) area += terms.measure(f * points + q);
    const double smooth = terms.smooth_opening(f);
    double most = at(f, 0, pressure), least = most;
    for (int a = 0; a < nodes; ++a) {
      const double p = at(f, a, pressure), xi = contact::yield_limit(terms.law_at(f, a));
      most = math::fmax(most, p);
      least = math::fmin(least, p);
      for (int b = 0; b < nodes; ++b) {
        const double other = at(f, b, pressure), other_xi = contact::yield_limit(terms.law_at(f, b));
        if (p >= xi && other < other_xi && other_xi > highest && other_xi > (1 + jump) * xi) yield_jumps += 1;
        if (p > 0 && xi > highest && other == 0 && -at(f, b, penetration) > smooth) gap_jumps += 1;
      }
    }
    if (most >= near_peak * highest) drop = math::fmax(drop, (most - least) / highest);
    if (most > 0 && !(least > 0)) ends += area / 2;
  }
};

/// What no pressure can exceed at the points of all contact sides, maybe infinite; collective.
double highest_bound(const Comm &comm, const contact::ContactNodes &c)
{
  const contact::ContactNodes points = c;
  double highest = 0;
  Kokkos::parallel_reduce(
      "rpc::adapt::highest_yield_stress", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) { most = math::fmax(most, contact::largest_bearable(points.law(i))); },
      Kokkos::Max<double>(highest));
  return max_all(comm, std::max(0., highest));
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
  estimate.peak.at_bound = highest >= (1 - 1e-12) * highest_bound(mesh.comm(), of.contact);
  constexpr int num_sums = 9;
  double sums[num_sums] = {}, peak = 0, spread = 0, drop = 0; // Kokkos' maximum over no facets is -DBL_MAX
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
    Kokkos::parallel_reduce("rpc::adapt::nodal_pressures", facets, NodalPressures{terms, highest},
                            Kokkos::Max<double>(drop_of_side), of_side[3], of_side[4], of_side[5]);
    drop = std::max(drop, drop_of_side);
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
  estimate.parts = {{"recovery", all[0]}, {"contact_equilibrium", all[1]}, {"contact_complementarity", all[2]}};
  estimate.rounding = fem::rounding_energy(d, materials, of.u);
  estimate.pressure = std::sqrt(all[3]);
  // In space the recovered stress is poor at single points of unstructured meshes: the mean tells more there.
  const double difference = mesh.dim() == 2 ? max_all(mesh.comm(), peak) : all[8] > 0 ? std::sqrt(all[7] / all[8]) : 0;
  estimate.max_pressure = std::max(max_all(mesh.comm(), spread), difference);
  estimate.peak.drop = max_all(mesh.comm(), drop);
  estimate.peak.yield_jump = all[4] > 0;
  estimate.peak.gap_jump = all[5] > 0;
  estimate.contact_ends = all[6];
  return estimate;
}

} // namespace rpc::adapt
