#pragma once

#include "rpc/algebra/convex_functional.hpp"
#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/contact_state.hpp"

namespace rpc::contact
{

/// How many contact nodes are in each state, over all ranks; nodes with a prescribed normal displacement are not
/// counted.
struct StateCounts {
  GO open = 0, closed = 0, yielding = 0;
};

/// Energies of (u, lambda) at the contact nodes, over all ranks.
struct ContactEnergy {
  double dissipated =
      0; ///< sum_i w_i (lambda_i - H_i d_i / 2) d_i, d = (v - c lambda)+ [J]; where the law holds the work that new dents
         ///< have taken up; perfectly plastic: lambda_i v_i+                                                     (3.14)
  double duality_gap =
      0; ///< sum_i w_i (psi_i(v_i) + psi_i*(lambda_i) - lambda_i v_i) [J], each term >= 0: what the contact
         ///< law misses, with twice the largest multiplier in place of any higher xi               (5.5)
};

/// The next active set of the primal-dual active-set iteration, and the pressures that it was chosen by.
struct ActiveSetChoice {
  DeviceView<State *> state;     ///< (contact nodes)
  DeviceView<double *> pressure; ///< (contact nodes) [Pa]
  GO changes = 0;                ///< points on all ranks whose state is to change
  bool confirmed = false; ///< no changes: u and the pressures obey the contact law, up to what the penalty leaves
  std::uint64_t fingerprint = 0; ///< of all states on all ranks: equal for equal ones
};

/// The functional along a line t -> u + t d: piecewise quadratic.                                       doc/theory.md (4.3)
///
///     slope(t) = slope(0) + curvature t + sum_i w_i dv_i (Psi_i'(v_i + t dv_i) - Psi_i'(v_i))
///
/// The difference form keeps its digits when slope(0) is small against its parts.
class LineModel : public LineFunction
{
public:
  LineModel(RCP<const Comm> comm, double slope_at_0, double elastic_curvature, const ContactNodes &contact,
            DeviceView<double *> v, DeviceView<double *> dv, DeviceView<double *> lambda);

  /// Slope and curvature in [J].
  Value at(double t) const override;

private:
  RCP<const Comm> comm_;
  double slope_at_0_, elastic_curvature_;
  ContactNodes contact_;
  DeviceView<double *> v_, dv_, lambda_;
};

/// The functional on u + sum_k a_k d_k: piecewise quadratic.                                             doc/theory.md (4.4a)
///
///     gradient_k(a) = gradient_k(0) + sum_l A_kl a_l + sum_i w_i dv_ik (Psi_i'(v_i + sum_l dv_il a_l) - Psi_i'(v_i))
///
/// with A_kl = d_k.K d_l, in the difference form of LineModel.
class SubspaceModel : public SubspaceFunction
{
public:
  /// @param at_0     (directions) gradient [J]
  /// @param elastic  (directions x directions) A [J]
  /// @param v        (points) [m]
  /// @param dv       (points, directions) [m]
  SubspaceModel(RCP<const Comm> comm, std::vector<double> at_0, std::vector<double> elastic,
                const ContactNodes &contact, DeviceView<double *> v, DeviceView<double **> dv,
                DeviceView<double *> lambda);

  /// Gradient and curvature in [J].
  Value at(const std::vector<double> &a) const override;

private:
  RCP<const Comm> comm_;
  std::vector<double> at_0_, elastic_;
  ContactNodes contact_;
  DeviceView<double *> v_;
  DeviceView<double **> dv_;
  DeviceView<double *> lambda_;
};

/// What the generalized Newton iteration minimizes for given multipliers, its gradient and its generalized Hessian.
///
///     M(u) = u.Ku/2 - b.u + sum_i w_i Psi_i(v_i(u))                                                doc/theory.md (4.1)
///     F(u) = Ku - b + sum_i w_i Psi_i'(v_i) m_i,     H(u) = K + sum_i w_i Psi_i''(v_i) m_i m_i^T            (4.2)
///
/// with m_i the node's direction. Contact terms touch only contact rows. All vectors are on owned dofs; all members are
/// collective.
///
/// Penalties that the contact nodes leave open are chosen here, as a multiple of the node's own stiffness over its
/// weight; none exceeds what double precision bears. doc/theory.md (5.12)
///
/// Where the iteration goes on, `u` is the displacement from an origin, at first 0, and penetrations are kept to digits of
/// their own: r v would make r eps |u| of the rounding of u. (5.13)
class SmoothedFunctional : public ConvexFunctional
{
public:
  /// @param hessian  K with an update at the contact nodes, among others; it is this functional's from here on
  SmoothedFunctional(fem::ElasticProblem problem, ContactNodes contact, RCP<UpdatedOperator> hessian);

  /// M(u) [J], with the energy of prescribed displacements, up to a constant once the origin has moved.
  double value(const Vector &u) const override;
  /// Energy of the problem itself, J(u) = Pi(u) + sum_i w_i psi_i(v_i) [J], computed as Pi(u) + sum_i w_i (lambda_i v_i -
  /// psi_i*(lambda_i)): the two are equal where the contact law holds, but xi v+ makes much of the rounding of v at a closed
  /// node. (1.4), (5.14)
  /// @param u  displacement from 0
  double energy(const Vector &u) const;
  void gradient(const Vector &u, Vector &F) const override;
  /// G <- Ku - b, all of a gradient that takes a product with K.
  void elastic_gradient(const Vector &u, Vector &G) const;
  /// The gradient at u of the quadratic functional that the active set stands for: each point carries what the branch of its
  /// state says, whether the law admits it or not; perfectly plastic: lambda + r v, 0 or xi. (5.6)
  /// @param gradient  of the functional itself at u
  void active_set_gradient(const Vector &u, const Vector &gradient, Vector &F) const;
  /// One nonlinear sweep: each contact node moves along its direction to the minimum of a bound of M, in which nodes do not
  /// feel each other; M does not grow. All points at once: the result does not depend on an order. (4.6)
  void sweep(Vector &u) const override;
  /// Takes the states at u for the active set, and brings hessian() to it: that is H(u).
  GO update_hessian(const Vector &u) override;
  /// One choice of the active-set iteration at the minimum u for the present active set: a point goes from open to yielding, or
  /// back, only by way of closed. The first choice, before there is an active set, is made from the multipliers. (5.8)
  /// @param negligible  violations up to this part of the largest pressure change no state; dimensionless, >= 0
  ActiveSetChoice choose_active_set(const Vector &u, double negligible) const;
  /// Takes the choice's states for the active set, its pressures for multipliers as far as the states allow, and brings
  /// hessian() to it. Nodes that close are moved onto the foundation: r v would be a large residual for what is a small step.
  void take_active_set(const ActiveSetChoice &choice, Vector &u);
  /// For bodies with rigid motions that only contact can hold: keeps a weak spring at nodes that are not closed in
  /// hessian(), so that it stays positive definite, and closes all nodes in the first choice of an active set, unless
  /// multipliers were given. The functional and its gradients do not change. (9.8)
  void hold_by_contact();
  bool held_by_contact() const { return spring_ > 0; }
  /// Weakens these springs, if there are any, from the next update of hessian() on, where a step beyond 1 tells that the body
  /// bends so easily that it feels them.
  void step_taken(double length) override;
  /// Raises the penalties, as far as double precision bears it. @return whether any rose, on any rank   (5.12)
  bool raise_penalty();
  /// Moves the origin to where u is, and sets u to 0.                                                     (5.13)
  void move_origin(Vector &u);
  /// Where u is, seen from 0: what results are read from.
  Vector displacement(const Vector &u) const;
  /// Starts from a state, such as that of the step before or another mesh's: takes its multipliers, as near as the law admits them.
  /// @param[in,out] u  takes its displacement, but for what is prescribed
  void start_from(const ContactState &state, Vector &u);
  /// Back to the multipliers of the start: xi/2 where the body touches, else 0.
  void reset_multipliers();
  const RCP<UpdatedOperator> &hessian() const override { return hessian_; }
  std::unique_ptr<LineFunction> along(const Vector &u, const Vector &d, const Vector &F) const override;
  std::unique_ptr<SubspaceFunction> within(const Vector &u, const std::vector<RCP<const Vector>> &directions,
                                           const Vector &F) const override;
  StateCounts count_states(const Vector &u) const;
  /// By the number of nodes in each state.
  std::uint64_t piece(const Vector &u) const override;
  /// Of the displacement from 0.
  double size(const Vector &u) const override;

  /// lambda_i <- Psi_i'(v_i(u)). @return |change|_2 / |lambda|_2, over free contact nodes, 0 if nothing changed   (5.1)
  double update_multipliers(const Vector &u);
  /// The same with the pressures of the active set, as near as the law admits them: where it is confirmed, a rounding error of v at an open
  /// or yielding point does not count r times.
  double take_active_set_pressures(const Vector &u);

  /// About the largest error of the pressures at nodes that are not open, over the largest pressure: the share k/r that the
  /// penalty leaves of the last change, with k the node's own stiffness.                                       (5.10)
  double pressure_error(const Vector &u) const;

  /// Largest violation of the contact law by (u, lambda), dimensionless.                                         (5.3)
  /// @param u  displacement from 0
  double contact_law_residual(const Vector &u) const;
  /// @param u  displacement from 0
  ContactEnergy contact_energy(const Vector &u) const;
  /// sum_i w_i lambda_i m_i, what contact takes off the load (owned dofs, [N]).
  Vector multiplier_forces() const;

  /// |applied load|_2 on the free unknowns; without any, |contact force|_2; without that, what prescribed displacements do
  /// to the free unknowns [N]; 1 if nothing acts. A rigid shift of the whole scene leaves it as it is where anything is
  /// applied or touches.
  double force_scale() const;

  const ContactNodes &contact() const { return contact_; } ///< with penetration from 0
  const fem::ElasticProblem &problem() const { return problem_; }
  const DeviceView<double *> &multipliers() const { return lambda_; }
  /// The present state: the displacement that is given, and copies of multipliers and states.
  /// @param u  displacement from 0
  ContactState current(const RCP<const Vector> &u) const;

private:
  GO update_stiffness(); // brings hessian() to the active set; number of nodes whose stiffness changed

  RCP<const Comm> comm_;
  fem::ElasticProblem problem_;
  ContactNodes contact_;
  ContactNodes shifted_;           // the same, its free_gap less what the origin has used up
  RCP<Vector> origin_;             // null: 0
  RCP<Vector> load_;               // problem_.load less K origin
  double applied_force_ = 0;       // |applied load|_2 on free unknowns [N]
  double prescribed_force_ = 0;    // the same with the forces of prescribed displacements [N]
  double pressure_bound_ = 0;      // pressure that the load will hardly reach anywhere [Pa]
  DeviceView<double *> lambda_;    // (contact nodes) [Pa]
  DeviceView<State *> active_set_; // (contact nodes) states that hessian() belongs to
  RCP<UpdatedOperator> hessian_;
  DeviceView<double *> own_;     // (contact nodes) stiffness of the node alone [Pa/m]
  DeviceView<double *> coupled_; // (contact nodes) bound of the stiffness of moves of all of them (4.6)
  double spring_ = 0;            // weak springs at nodes that are not closed, in units of contact_.scaling
  bool warm_start_ = false;      // multipliers are a guess to start from
  bool has_active_set_ = false;  // else active_set_ is that of K itself, and says nothing about pressures
};

} // namespace rpc::contact
