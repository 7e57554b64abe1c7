// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/active_set.hpp"
#include "rpc/contact/lagged_bounds.hpp"

namespace rpc::contact
{

/// The dual variables of a minimization: multipliers, friction's bounds and penalties, which stand in the functional.
/// All members are collective but for the copies of values.
class DualVariables
{
public:
  /// Multipliers and bounds, as they were.
  struct Values {
    Multipliers multiplier;
    DeviceView<double *> bound; ///< (points) [Pa]
  };

  /// Starts with reset().
  /// @param functional  whose dual variables these are   @param points  with penetration from 0; both outlive this object
  /// @param own         (points) see own_stiffness() [Pa/m]
  /// @param load        all forces on the free unknowns, those of prescribed displacements too [N]
  DualVariables(const SmoothedFunctional &functional, const ContactNodes &points, DeviceView<double *> own,
                const Vector &load);
  DualVariables(const DualVariables &) = delete; // those of one functional
  DualVariables &operator=(const DualVariables &) = delete;

  /// lambda_i <- Psi_i'(v_i(u)). @return |change|_2 / |lambda|_2, over free contact nodes, 0 if nothing changed   paper (11), (5.1)
  double update(const Vector &u);
  /// The same with the pressures of a confirmed active set, as near as the law admits them: the penalty r does not amplify the
  /// rounding of v at open and yielding points.
  double take_active_set_pressures(const ActiveSet &active, const Vector &u);
  /// Back to the multipliers of the start: xi/2 where the body touches, else 0.
  void reset();
  /// The multipliers of a state, as near as the law admits them.
  void start_from(const ContactState &state);
  Values values() const; ///< copies
  void take(const Values &values);
  /// Where no active set is confirmed, Tresca problems follow one another: takes the bounds of the next one, from those of the last ones and
  /// what their pressures gave.                                                                                  (12.12)
  void follow_bounds();

  /// Raises the penalties, as far as double precision bears it. @return whether any rose, on any rank             (5.12)
  bool raise_penalties();
  /// Raises those that are weaker than those of no choice of the deck's, before the first minimization. @return at how many points   (12.12b)
  GO raise_weak_penalties();
  /// Lowers them to E / diameter, before the first minimization.                                                (12.12a)
  void lower_penalties();

  const Multipliers &multipliers() const { return functional_.points().multiplier; }
  const DeviceView<double *> &penalty() const { return functional_.points().penalty; } ///< (points) [Pa/m]
  bool given() const { return given_; } ///< the multipliers are, by a start
  /// Mean pressure that the body may begin with [Pa]: of a start or by the load, whichever is more.
  double expected_pressure() const;

private:
  double replace(const DeviceView<double *> &p, const DeviceView<double **> &q);

  const SmoothedFunctional &functional_;
  const ContactNodes &points_;
  DeviceView<double *> own_;  // (points)
  double weight_;             // of the free points: their area [m^2], in 2D per m
  double pressure_bound_;     // pressure that the load will hardly reach anywhere [Pa]
  bool is_loaded_;            // else lambda = 0 is the solution
  double start_pressure_ = 0; // mean of the multipliers that a start gave [Pa]
  bool given_ = false;
  LaggedBounds lagged_;
  DeviceView<double *> bounds_before_; // (points) of the last minimization [Pa]; empty: no problem had them given
};

} // namespace rpc::contact
