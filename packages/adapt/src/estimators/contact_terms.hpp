// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/estimators/recovered.hpp"
#include "rpc/contact/law/friction.hpp"
#include "rpc/contact/law/interpolated.hpp"
#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/law/states.hpp"
#include "rpc/core/math.hpp"
#include "rpc/fem/facet_area.hpp"

#include <utility>

/// What the contact law contributes to the estimate on the facets of a side.                   doc/theory.md (10.3), (10.4)
namespace rpc::adapt
{

using ReadColumns = decltype(std::declval<const MultiVector &>().getLocalViewDevice(Tpetra::Access::ReadOnly));

// Columns of the values that a side's facets read at their nodes; `traction` and later ones only where there is friction.
enum Column {
  pressure,
  penetration,
  law,
  gap = law + contact::law_columns, // to the dents that there are
  dent,
  pressed, // how deep the foundation gives way, with the dents that there are
  normal,
  traction = normal + 3,
  slip = traction + 3,
  bound = slip + 3,
  bearable, // what friction bears at most at the largest pressure of the sides
  num_columns
};

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

  // A gap that grows as at the end of a smooth contact stays below this factor times the strain at the peak times the size of a facet: its
  // faces in space are longer than the root of their area, and their vertices have no weight.
  static constexpr double smooth_gap = 1, smooth_gap_in_space = 4;

  KOKKOS_FUNCTION double area(const LO f) const
  {
    return fem::facet_area(measure, static_cast<int>(value.extent(0)), f);
  }

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

  /// Whether the foundation gives way by as much as a layer of the body that is as deep as the facet is long: then pressures are bounded.
  KOKKOS_FUNCTION bool on_springs(const LO f, const std::size_t a) const
  {
    const int of = block(cell(f));
    return contact::resting_penetration(lame(of, 0) + 2 * lame(of, 1), law_at(f, a)) >= size(f);
  }

  /// By how much more the foundation gives way for each pressure, at a node that yields or does not [m/Pa]; infinite where it yields at once.
  KOKKOS_FUNCTION double softness(const LO f, const std::size_t a, const bool yields) const
  {
    constexpr double rigid = 1e200; // a penalty without give
    const contact::State state = yields ? contact::State::yielding : contact::State::closed;
    return 1 / contact::branch_stiffness(state, rigid, law_at(f, a));
  }

  /// How much of the pressure that a kink of the gap adds over a factor e of the distance is open where the foundation gives way: it ends the
  /// growth at the length l over which the body is as soft, and facets are shorter or not.                  (10.8b)
  KOKKOS_FUNCTION double unresolved(const LO f, const std::size_t a, const bool yields) const
  {
    const int of = block(cell(f));
    const double l = softness(f, a, yields) * (lame(of, 0) + 2 * lame(of, 1)), share = size(f) / l;
    return share < 1 ? share * math::sqrt(share) : 1; // (h/l)^2 (1 + log(l/h)) is at most 1.21 of it
  }

  /// E/(1 - nu^2), in plane stress E: of what the surface gives way under a pressure [Pa].
  KOKKOS_FUNCTION double surface_modulus(const LO f) const
  {
    const double lambda = lame(block(cell(f)), 0), mu = lame(block(cell(f)), 1);
    return 4 * mu * (lambda + mu) / (lambda + 2 * mu);
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

} // namespace rpc::adapt
