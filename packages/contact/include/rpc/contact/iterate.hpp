// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"
#include "rpc/contact/active_set.hpp"
#include "rpc/contact/dual_variables.hpp"
#include "rpc/contact/interior_path.hpp"

#include <vector>

namespace rpc::contact
{

/// The variable state of a step's solve, which NOX minimizes: origin, multipliers, penalties, active set, springs and
/// Hessian, H(u) = K + sum_i w_i Psi_i''(v_i) m_i m_i^T. The formulas are those of SmoothedFunctional.       doc/theory.md (4.2)
///
/// Every u below is the displacement from the present origin, (5.13), at first 0. Results, energies and
/// residuals are computed from state(), a ContactState, whose displacement is from 0.
class Iterate : public ConvexFunctional
{
public:
  /// @param hessian  K with an update at the contact nodes; the iterate changes it from here on
  Iterate(const fem::ElasticProblem &elastic, ContactNodes points, RCP<UpdatedOperator> hessian);

  // What is minimized: see ConvexFunctional and SmoothedFunctional.
  double value(const Vector &u) const override { return functional_.value(u); }
  void gradient(const Vector &u, Vector &F) const override { functional_.gradient(u, F); }
  std::unique_ptr<LineFunction> along(const Vector &u, const Vector &d, const Vector &F) const override
  {
    return functional_.along(u, d, F);
  }
  std::unique_ptr<SubspaceFunction> within(const Vector &u, const std::vector<RCP<const Vector>> &directions,
                                           const Vector &F) const override
  {
    return functional_.within(u, directions, F);
  }
  void sweep(Vector &u) const override { functional_.sweep(coupled_, u); }
  /// By the number of nodes in each state.
  std::uint64_t piece(const Vector &u) const override;
  /// Of the displacement from 0.
  double size(const Vector &u) const override;
  const RCP<UpdatedOperator> &hessian() const override { return hessian_; }
  /// Hd <- H d, with what hessian() lacks of sides that a force moves.                                              (2.9a)
  void apply_hessian(const Vector &d, Vector &Hd) const;
  /// Takes the states at u for the active set, and brings hessian() to it: that is H(u).
  GO update_hessian(const Vector &u) override;
  /// Weakens the springs of hold_by_contact(), if there are any, from the next update of hessian() on, after a step longer
  /// than 1: the body is so soft in bending that the springs count.
  void step_taken(double length) override;

  const SmoothedFunctional &functional() const { return functional_; } ///< as seen from the present origin

  // The active set: see active_set.hpp.
  ActiveSetChoice choose_active_set(const Vector &u, double negligible) const;
  ActiveSetChoice largest_changes(const ActiveSetChoice &choice, const double part) const
  {
    return contact::largest_changes(functional_, active_, choice, part);
  }
  /// Takes an updated active set, and updates hessian() for it.
  void take_active_set(const ActiveSetChoice &choice, Vector &u);
  /// Directions of slip follow u, and hessian() does.                                                            (12.13)
  void turn_slip(const Vector &u);
  void rest_on_multipliers(Vector &u) { contact::rest_on_multipliers(functional_.points(), active_, u); }
  /// @param gradient  of the functional itself at u   (5.6)
  void active_set_gradient(const Vector &u, const Vector &gradient, Vector &F) const
  {
    functional_.active_set_gradient(active_, u, gradient, F);
  }
  double pressure_error(const Vector &u) const { return contact::pressure_error(functional_, active_, u, own_); }
  /// For bodies with rigid motions that only contact can hold: keeps a weak spring at nodes that are not closed in
  /// hessian(), so that it stays positive definite, and closes all nodes in the first active set, unless
  /// multipliers were given. The functional and its gradients do not change. (9.8)
  void hold_by_contact();

  /// The interior-point method from u on, by hessian(). It refers to this object.                                 (5.16)
  InteriorPath interior_path(const Vector &u) const;

  // Multipliers, friction's bounds and penalties.
  const DualVariables &duals() const { return duals_; }
  DualVariables &duals() { return duals_; }
  /// See DualVariables.
  double take_active_set_pressures(const Vector &u) { return duals_.take_active_set_pressures(active_, u); }
  /// Raises the penalties, and hessian() follows. @return whether any rose, on any rank                              (5.12)
  /// @param u  where the active set was taken
  bool raise_penalty(const Vector &u);

  // Origin and state.
  /// Starts from a state, such as that of the step before or another mesh's: takes its multipliers, as near as the law admits them.
  /// @param[in,out] u  takes its displacement, but for what is prescribed
  void start_from(const ContactState &state, Vector &u);
  /// Moves the origin to where u is, and sets u to 0.                                                            (5.13)
  void move_origin(Vector &u);
  /// The same with internal forces summed over the cells, which round less than K u.
  /// @param internal  (owned dofs) fem::internal_work() [N]   @param applied  load without prescribed displacements [N]
  void move_origin(Vector &u, const Vector &internal, const Vector &applied);
  /// The present state: displacement from 0, and copies of multipliers and states.
  ContactState state(const Vector &u) const;

  /// |applied load|_2 on the free unknowns; without any, |contact force|_2; where that is rounding, the norm of the forces of
  /// prescribed displacements on the free unknowns [N]; 1 if nothing acts. A rigid shift of the whole scene leaves it as it is
  /// where anything is applied or touches.
  double force_scale() const;
  /// |Ku - b + sum_i w_i lambda_i m_i|_2 over the free unknowns [N]: how far u and the multipliers are from equilibrium.
  double out_of_balance(const Vector &u) const;

  const ContactNodes &points() const { return points_; }             ///< with penetration from 0
  const DeviceView<double *> &own_stiffness() const { return own_; } ///< (points) [Pa/m]

private:
  void take_origin(Vector &u, const Vector &out_of_balance);
  RCP<Vector> from_rest(const Vector &u) const; // the displacement from 0
  GO update_stiffness(const Vector &u); // brings hessian() to the active set; number of nodes whose stiffness changed

  fem::DirichletDofs dirichlet_;
  ContactNodes points_;
  RCP<UpdatedOperator> hessian_;
  DeviceView<double *> own_, coupled_; // (points) see own_stiffness(), coupled_stiffness()
  SmoothedFunctional functional_;
  DualVariables duals_;           // of the functional
  double applied_force_;          // |applied load|_2 on free unknowns [N]
  double prescribed_force_;       // the same with the forces of prescribed displacements [N]
  RCP<Vector> origin_;            // null: 0
  RCP<const TiedStiffness> tied_; // null: no force moves a side
  ActiveSet active_;              // that hessian() belongs to
  double spring_ = 0;             // weak springs at nodes that are not closed, in units of the points' scaling
};

} // namespace rpc::contact
