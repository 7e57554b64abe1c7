// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/solve_step.hpp"

/// An obstacle that a force or a spring moves, seen from the obstacle: there the sides that hold the body move, all by the same amount, and
/// their displacement is an unknown of the Newton system.                                                                  doc/theory.md (3.17)
namespace rpc::analysis
{

/// The contact side whose obstacle a force or a spring moves; null: there is none.
const contact::ContactOptions *pressed_by_force(const Model &model);

/// The same model, in which the held sides float along the components of the force.
/// @throws rpc::Error (bad_input) where an obstacle cannot be moved by a force
Model seen_from_obstacle(Model model);

/// What the sides that float are pressed with in place of the obstacle, along each component: all loads of the body and the force on the obstacle, the
/// other way round [N]. Collective.
/// @param now  seen at the time   @param obstacle  how far it is from where it starts [m]: so far its springs are stretched
/// @param load  (owned dofs) of the body [N]
std::array<double, 3> force_on_floating(const fem::Discretization &d, const Model &now, const Point &obstacle,
                                        const Vector &load);

/// How far the force moves the obstacle until it meets the first node of its side, or its springs stop it [m]; less than 0: back to where it meets
/// a node alone. Collective.
/// @param now  seen at the time, the obstacle where it starts
/// @throws rpc::Error (no_solution) where it passes the side by
Point approach(const fem::Discretization &d, const Model &now);

/// Work of the force on the obstacle from where it starts to where it is seen, and a way further [J], in 2D per m.   (3.17)
double work_on_obstacle(const Problem &problem, const Step &step, const Point &way);
/// What its springs have taken up there [J], in 2D per m.                                                            (3.17e)
double spring_energy_of_obstacle(const Problem &problem, const Step &step, const Point &way);
/// How far a solution's obstacle is still to go [m]: its held sides have moved the other way. Collective.
Point left_to_go(const Problem &problem, const StepSolution &s);
/// Where searches see the obstacle, one after the other.                                                              (3.17c)
class ObstaclePlaces
{
public:
  /// Where their solutions lead it to and fro between two places, halfway between them: points that begin to touch may make the force that it takes
  /// jump there.
  /// @param place  where it was seen [m]   @param way  that the solution leads it from there [m]
  Point next(const Point &place, const Point &way);

private:
  struct Led {
    Point place, way;
  };
  std::optional<Led> last_, opposed_;
};
/// Whether that is no more than a tolerance, in units of the largest displacement: the contact points were seen from where the obstacle is. Collective.
bool obstacle_rests(const Problem &problem, const StepSolution &s, double tolerance);

/// Whether a force moves an obstacle whose foundation never yields, and contact alone stops nothing but this one motion: any point that bears
/// the force is closed then, and holds it. Collective.                                                             (9.8)
bool closes_under_force(const Problem &problem, const Step &step);

/// Moves the obstacle that a force moves, seen as u is, to where the pressures that the functional has there bear the force. Collective.  (3.17f)
void settle_obstacle(const Problem &problem, const ConvexFunctional &functional, Vector &u);

/// Whether the obstacle is to be looked for elsewhere, whatever digits the solution lacks. Collective.                                (3.17c)
bool leads_on(const Problem &problem, const StepSolution &s, const Starts &starts, const StepOptions &options);

/// Sees a solution from where it leads its obstacle, if searches from there are not expected to lead it further than a tolerance. Collective. (3.17d)
/// @param before  see Starts::led_before
void rest_where_led(const Problem &problem, const Point &before, double tolerance, StepSolution &s);

/// A displacement or a state, seen from where body and obstacle are further by a shift [m].
RCP<const Vector> shifted(const Vector &u, const Point &shift, int dim);
contact::ContactState shifted(contact::ContactState state, const Point &shift, int dim);

} // namespace rpc::analysis
