// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/convex_functional.hpp"
#include "rpc/contact/smoothed_points.hpp"

#include <memory>
#include <vector>

namespace rpc::contact
{

/// How many contact nodes are in each state, over all ranks; nodes with a prescribed normal displacement are not
/// counted.
struct StateCounts {
  GO open = 0, closed = 0, yielding = 0;
};

/// What the generalized Newton iteration minimizes for given multipliers, and its gradient: formulas alone.
///
///     M(u) = u.Ku/2 - b.u + sum_i w_i (Psi_i(v_i(u)) + Theta_i(e_i(u)))            paper, M~(v, l) after theorem 5; doc/theory.md (4.1)
///     F(u) = Ku - b + sum_i w_i (Psi_i'(v_i) m_i + Theta_i'(e_i))                                                                 (4.2)
///
/// with m_i the node's direction. Friction's Theta has bounds s_i that are given, SmoothedPoints::bound: M is convex (12.3). Contact terms touch only contact rows. All vectors are on owned dofs; all members are const and
/// collective. Multipliers and penalties are views of the iterate's: their changes are seen.
///
/// u is the displacement from where the functional's origin is: see from().
class SmoothedFunctional
{
public:
  /// @param K       the body's stiffness, prescribed unknowns eliminated   @param load  (owned dofs) b [N]
  /// @param offset  energy of prescribed displacements, (2.9) [J]
  SmoothedFunctional(RCP<const Operator> K, RCP<const Vector> load, double offset, SmoothedPoints points);

  /// M(u) [J], with the energy of prescribed displacements, up to a constant once the origin has moved.
  double value(const Vector &u) const;
  void gradient(const Vector &u, Vector &F) const;
  /// G <- Ku - b, all of a gradient that takes a product with K.
  void elastic_gradient(const Vector &u, Vector &G) const;
  /// The gradient at u of the quadratic functional that an active set stands for: each point carries what the branch of its
  /// state says, whether the law admits it or not; perfectly plastic: lambda + r v, 0 or xi. (5.6)
  /// @param gradient  of the functional itself at u
  void active_set_gradient(const ActiveSet &active, const Vector &u, const Vector &gradient, Vector &F) const;
  /// One nonlinear sweep: each contact node moves along its direction to the minimum of a bound of M, in which nodes do not
  /// feel each other; M does not grow. All points at once: the result does not depend on an order. (4.6)
  /// @param coupled  (points) see coupled_stiffness()
  void sweep(const DeviceView<double *> &coupled, Vector &u) const;

  /// @param F  gradient at u
  std::unique_ptr<LineFunction> along(const Vector &u, const Vector &d, const Vector &F) const;
  std::unique_ptr<SubspaceFunction> within(const Vector &u, const std::vector<RCP<const Vector>> &directions,
                                           const Vector &F) const;

  /// (points) Psi_i'(v_i) [Pa].
  DeviceView<double *> pressures(const Vector &u) const;
  /// (points) The pressures of an active set, whether the law admits them or not [Pa].
  DeviceView<double *> active_set_pressures(const ActiveSet &active, const Vector &u) const;
  /// The states of lambda + r v and lambda_tau + r e, but for points that take no part.
  void take_states(const Vector &u, const ActiveSet &active) const;
  /// (points, dim) Theta_i'(e_i) [Pa].                                                                          (12.3)
  DeviceView<double **> tractions(const Vector &u) const;
  StateCounts count_states(const Vector &u) const;
  /// Points on all ranks that stick. With friction only.
  GO count_sticking(const Vector &u) const;

  /// The same functional of the correction to u: the rounding of r v is then relative to the correction.           (5.13)
  /// @param out_of_balance  elastic gradient at u [N], 0 at prescribed unknowns
  SmoothedFunctional from(const Vector &u, const Vector &out_of_balance) const;

  const SmoothedPoints &points() const { return points_; }
  const Comm &comm() const { return *load_->getMap()->getComm(); }

private:
  RCP<const Operator> K_;
  RCP<const Vector> load_; // less the elastic forces at the origin
  double offset_;
  SmoothedPoints points_; // with the gap that is left from the origin
};

/// F += sum_i w_i p_i m_i.
void add_contact_force(const ContactNodes &c, const DeviceView<double *> &p, Vector &F);

} // namespace rpc::contact
