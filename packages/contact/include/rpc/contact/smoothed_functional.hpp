#pragma once

#include "rpc/contact/contact_stiffness.hpp"
#include "rpc/contact/foundation_law.hpp"

#include <cstdint>

namespace rpc::contact
{

/// How many contact nodes are in each state, over all ranks; nodes with a prescribed normal displacement are not
/// counted.
struct StateCounts {
  GO open = 0, stuck = 0, yielded = 0;
};

/// Energies of (u, lambda) at the contact nodes, over all ranks.
struct ContactEnergy {
  double dissipated = 0; ///< sum_i w_i lambda_i v_i+ [J]
  double gap = 0; ///< sum_i w_i (xi_i v_i+ - lambda_i v_i) [J], each term >= 0: what the contact law misses, with
                  ///< twice the largest multiplier in place of any higher xi                             (5.12)
};

/// States to go on with, and the pressures of the piece that they were read from.
struct StateChoice {
  DeviceView<State *> state;     ///< (contact nodes)
  DeviceView<double *> pressure; ///< (contact nodes) [Pa]
  GO changes = 0;                ///< points on all ranks whose state is to change
  bool confirmed = false; ///< no changes: u and the pressures obey the contact law, up to what the penalty leaves
  std::uint64_t fingerprint = 0; ///< of all states on all ranks: equal for equal ones
};

/// The functional along a line t -> u + t d, as far as its slope goes: convex, piecewise quadratic. doc/theory.md (4.3)
///
///     slope(t) = slope(0) + curvature t + sum_i w_i dv_i (Psi_i'(v_i + t dv_i) - Psi_i'(v_i))
///
/// The difference form keeps its digits when slope(0) is small against its parts.
class LineModel
{
public:
  LineModel(RCP<const Comm> comm, double slope_at_0, double elastic_curvature, const ContactNodes &contact,
            DeviceView<double *> v, DeviceView<double *> dv, DeviceView<double *> lambda);

  struct Value {
    double slope;     ///< d/dt [J]
    double curvature; ///< of the piece that t lies on, >= 0 [J]
  };
  /// Collective.
  Value at(double t) const;

private:
  RCP<const Comm> comm_;
  double slope_at_0_, elastic_curvature_;
  ContactNodes contact_;
  DeviceView<double *> v_, dv_, lambda_;
};

/// What the generalized Newton iteration minimizes for given multipliers, its gradient and its generalized Hessian.
///
///     M(u) = u.Ku/2 - b.u + sum_i w_i Psi_i(v_i(u))                                                doc/theory.md (4.1)
///     F(u) = Ku - b + sum_i w_i Psi_i'(v_i) m_i,     H(u) = K + sum over stuck i of r_i w_i m_i m_i^T      (4.2)
///
/// with m_i the node's direction. Contact terms touch only contact rows. All vectors are on owned dofs; all members are
/// collective.
///
/// Penalties that the contact nodes leave open are chosen here, as a multiple of the node's own stiffness over its
/// weight; none exceeds what double precision bears. doc/theory.md (5.8)
///
/// Where the iteration goes on, `u` is the displacement from an origin, at first 0, and penetrations are kept to digits of
/// their own: r v would make r eps |u| of the rounding of u. (5.9)
class SmoothedFunctional
{
public:
  SmoothedFunctional(RCP<const Comm> comm, fem::ElasticProblem problem, ContactNodes contact);

  /// M(u) [J], with the energy of prescribed displacements, up to a constant once the origin has moved.
  double value(const Vector &u) const;
  /// Energy of the problem itself, J(u) = Pi(u) + sum_i w_i xi_i v_i+ [J], computed as Pi(u) + sum_i w_i lambda_i v_i:
  /// the two are equal where the contact law holds, but xi v+ makes much of the rounding of v at a stuck node. (1.4),
  /// (5.5)
  /// @param u  displacement from 0
  double energy(const Vector &u) const;
  void gradient(const Vector &u, Vector &F) const;
  /// G <- Ku - b, all of a gradient that takes a product with K.
  void elastic_gradient(const Vector &u, Vector &G) const;
  /// The gradient at u of the quadratic piece that hessian() belongs to: stuck nodes carry lambda + r v, whatever that
  /// is, open ones 0, yielded ones xi. (5.4)
  /// @param G  elastic_gradient at u
  void piece_gradient(const Vector &u, const Vector &G, Vector &F) const;
  /// One nonlinear sweep: each contact node moves along its direction to the minimum of a bound of M, in which nodes do not
  /// feel each other; M does not grow. All points at once: the result does not depend on an order. (4.7)
  void sweep(Vector &u) const;
  /// Brings hessian() to H(u). @return number of contact nodes whose stiffness in it changed, over all ranks
  GO update_hessian(const Vector &u);
  /// One choice of the active-set iteration at the minimum u of hessian()'s piece: a point goes from open to yielded, or
  /// back, only by way of stuck. The first choice, before there is a piece, is made from the multipliers. (5.7)
  /// @param negligible  violations up to this part of the largest pressure change no state; dimensionless, >= 0
  StateChoice choose_states(const Vector &u, double negligible) const;
  /// Takes the choice's pressures for multipliers, as far as its states allow, and brings hessian() to its states. Nodes
  /// that come to stick are moved onto the foundation: r v would be a large residual for what is a small step.
  void take_states(const StateChoice &choice, Vector &u);
  /// For bodies with rigid motions that only contact can hold: keeps a weak spring at nodes that do not stick in
  /// hessian(), so that it stays positive definite, and lets all nodes stick in the first choice of states, unless
  /// multipliers were given. The functional and its gradients do not change. (9.8)
  void hold_by_contact();
  bool held_by_contact() const { return spring_ > 0; }
  /// Weakens these springs, if there are any, from the next update of hessian() on: for bodies that bend so easily that
  /// they feel them.
  void weaken_springs();
  /// Raises the penalties, as far as double precision bears it. @return whether any rose, on any rank   (5.8)
  bool raise_penalty();
  /// Moves the origin to where u is, and sets u to 0.                                                     (5.9)
  void move_origin(Vector &u);
  /// Where u is, seen from 0: what results are read from.
  Vector displacement(const Vector &u) const;
  /// A guess to start from, such as another mesh's solution; brought into [0, xi].
  /// @param lambda  (contact nodes) [Pa]
  void set_multipliers(const DeviceView<double *> &lambda);
  /// Back to the multipliers of the start: xi/2 where the body touches, else 0.
  void reset_multipliers();
  const RCP<ContactStiffness> &hessian() const { return hessian_; }
  /// @param F  gradient at u
  LineModel along(const Vector &u, const Vector &d, const Vector &F) const;
  StateCounts count_states(const Vector &u) const;

  /// lambda_i <- Psi_i'(v_i(u)). @return |change|_2 / |lambda|_2, over free contact nodes, 0 if nothing changed   (5.1)
  double update_multipliers(const Vector &u);
  /// The same with the pressures of hessian()'s piece, brought into [0, xi]: where its states are confirmed, a rounding error
  /// of v at an open or yielded point does not count r times.
  double take_piece_pressures(const Vector &u);

  /// About the largest error of the pressures lambda + r v at stuck nodes, over the largest pressure: the share k/r that the
  /// penalty leaves of the last change, with k the node's own stiffness.                                       (5.15)
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

private:
  GO update_stiffness(); // brings hessian() to piece_; number of nodes whose stiffness changed

  RCP<const Comm> comm_;
  fem::ElasticProblem problem_;
  ContactNodes contact_;
  ContactNodes near_;           // the same, its free_gap less what the origin has used up
  RCP<Vector> origin_;          // null: 0
  RCP<Vector> load_;            // problem_.load less K origin
  double applied_force_ = 0;    // |applied load|_2 on free unknowns [N]
  double lifted_force_ = 0;     // the same with the forces of prescribed displacements [N]
  double reach_ = 0;            // pressure that the load will hardly reach anywhere [Pa]
  DeviceView<double *> lambda_; // (contact nodes) [Pa]
  DeviceView<State *> piece_;   // (contact nodes) states that hessian() belongs to
  RCP<ContactStiffness> hessian_;
  double spring_ = 0;         // weak springs at nodes that do not stick, in units of contact_.stiffness
  bool predicted_ = false;    // multipliers are a guess to start from
  bool piece_chosen_ = false; // else piece_ is that of K itself, and says nothing about pressures
};

} // namespace rpc::contact
