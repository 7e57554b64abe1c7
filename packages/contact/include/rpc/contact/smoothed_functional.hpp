#pragma once

#include "rpc/contact/contact_nodes.hpp"
#include "rpc/contact/foundation_law.hpp"

#include <cstdint>

namespace rpc::contact
{

/// How many contact nodes are in each state, over all ranks; nodes with a prescribed normal displacement are not
/// counted.
struct StateCounts {
  GO open = 0, stuck = 0, yielded = 0;
};

/// What a choice of states has changed, over all ranks.
struct StateChange {
  GO nodes = 0;                  ///< that have another state than before
  GO stiffness = 0;              ///< of them, those that began or ceased to stick
  std::uint64_t fingerprint = 0; ///< of all states: equal for equal ones
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
/// with m_i the node's direction. One matrix serves as K and as H: it holds K with the contact blocks of the states
/// last given to update_hessian, whose elastic values are kept aside; products with K subtract what was added. Contact
/// terms touch only contact rows. All vectors are on owned dofs; all members are collective.
class SmoothedFunctional
{
public:
  SmoothedFunctional(RCP<const Comm> comm, fem::ElasticProblem problem, ContactNodes contact);

  /// M(u) [J], with the energy of prescribed displacements.
  double value(const Vector &u) const;
  /// Energy of the problem itself, J(u) = Pi(u) + sum_i w_i xi_i v_i+ [J], computed as Pi(u) + sum_i w_i lambda_i v_i:
  /// the two are equal where the contact law holds, but xi v+ makes much of the rounding of v at a stuck node. (1.4),
  /// (5.5)
  double energy(const Vector &u) const;
  void gradient(const Vector &u, Vector &F) const;
  /// The gradient at u of the quadratic piece that hessian() belongs to: stuck nodes carry lambda + r v, whatever that
  /// is, open ones 0, yielded ones xi. (5.4)
  void piece_gradient(const Vector &u, Vector &F) const;
  /// Brings hessian() to H(u). @return number of contact nodes whose stiffness changed, over all ranks
  GO update_hessian(const Vector &u);
  /// One choice of the active-set iteration: takes the piece's pressures p for multipliers, and brings hessian() to the
  /// states of p + rho v. (5.7) Where no state changes, nothing is done.
  /// @param rho  [Pa/m]
  StateChange choose_states(const Vector &u, double rho);
  /// Back to the multipliers of the start: xi/2 where the body touches, else 0.
  void reset_multipliers();
  const RCP<CrsMatrix> &hessian() const { return problem_.stiffness; }
  /// @param F  gradient at u
  LineModel along(const Vector &u, const Vector &d, const Vector &F) const;
  StateCounts count_states(const Vector &u) const;

  /// lambda_i <- Psi_i'(v_i(u)). @return |change|_2 / |lambda|_2, over free contact nodes, 0 if nothing changed   (5.1)
  double update_multipliers(const Vector &u);

  /// |K u - b + sum_i w_i lambda_i m_i|_2 over the larger of the norms of load and contact force.              (5.2)
  double equilibrium_residual(const Vector &u) const;
  /// Largest violation of the contact law by (u, lambda), dimensionless.                                         (5.3)
  /// @param stiffness_scale  rho [Pa/m] that turns a distance into a pressure
  double contact_law_residual(const Vector &u, double stiffness_scale) const;

  /// |applied load|_2 on the free unknowns; without any, |contact force|_2; without that, what prescribed displacements do
  /// to the free unknowns [N]; 1 if nothing acts. A rigid shift of the whole scene leaves it as it is where anything is
  /// applied or touches.
  double force_scale() const;

  const ContactNodes &contact() const { return contact_; }
  const fem::ElasticProblem &problem() const { return problem_; }
  const DeviceView<double *> &multipliers() const { return lambda_; }

private:
  void apply_stiffness(const Vector &u, Vector &Ku) const;
  double potential(const Vector &u) const; // Pi(u) [J]

  RCP<const Comm> comm_;
  fem::ElasticProblem problem_;
  ContactNodes contact_;
  double applied_force_ = 0;    // |applied load|_2 on free unknowns [N]
  double lifted_force_ = 0;     // the same with the forces of prescribed displacements [N]
  DeviceView<double *> lambda_; // (contact nodes) [Pa]
  DeviceView<State *> piece_;   // (contact nodes) states that the matrix belongs to: stuck ones' blocks hold r w m m^T
  bool piece_chosen_ = false;   // else piece_ is that of K itself, and says nothing about pressures
  DeviceView<std::size_t **> block_; // (contact nodes, dim) entry where the node's own block begins in each of its rows
  DeviceView<double ***> elastic_;   // (contact nodes, dim, dim) that block of K
};

} // namespace rpc::contact
