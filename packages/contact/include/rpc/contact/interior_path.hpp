// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"
#include "rpc/contact/active_set.hpp"
#include "rpc/contact/law/interior.hpp"

namespace rpc::contact
{

/// An interior-point method for the contact law: points and their pressures follow the rounded law (5.15) while mu falls to 0. Its
/// steps are as many on thin bodies as on others, for no point changes its state at once.  doc/theory.md (5.15) to (5.20)
///
/// A step has two solves with one matrix (Mehrotra): that of linearize() for mu = 0; correct() takes from it the mu that can be reached and the products that the linear equations leave out; then d for these. advance() takes as much of it as keeps all points inside.
/// All members are collective.
class InteriorPath
{
public:
  /// Starts at a displacement, on the path.                                                                       (5.16)
  /// @param functional  with the law's points; it may see displacements from another origin later, and outlives the path
  /// @param hessian     of linearize()
  /// @param load        over the contact area [Pa]; 0: nothing presses the body but where it has penetrated
  InteriorPath(const SmoothedFunctional &functional, RCP<UpdatedOperator> hessian, const Vector &u, double load);

  /// Predictor: brings the Hessian to the linearized law, K + sum_i w_i m_i m_i^T/(D_i + 1/r_i), and F to its right side. Where steps
  /// stay short, the path begins anew with a hundred times the pressure.                                      (5.16), (5.18)
  void linearize(const Vector &u, Vector &F);
  /// F <- Ku - b + sum_i w_i m_i (p_i + e_i/(D_i + 1/r_i)) for the present targets, which are 0 after a step     (5.18)
  void gradient(const Vector &u, Vector &F) const;
  /// Corrector: targets for the mu that the predictor step `d` reaches, less the products that it leaves out.      (5.19)
  /// @param F  gradient() for the targets before; then for the new ones
  void correct(const Vector &u, const Vector &d, Vector &F);
  /// Takes a step of the points along a displacement, as long as they stay inside, at most 1. @return its length    (5.19)
  double advance(const Vector &u, const Vector &d);

  /// Complementarity gap: sum_i w_i (p_i s_i + q_i d_i) / sum_i w_i p_i over the size of displacements; 0 where the law holds.
  double gap() const { return gap_; }
  /// The last two steps lead to the same states.
  bool settled() const { return settled_; }
  /// The states that the points tend to, and their pressures.                                                    (5.20)
  ActiveSetChoice choice() const;

private:
  void join(const Vector &u);

  const SmoothedFunctional &functional_;
  RCP<UpdatedOperator> hessian_;
  DeviceView<InteriorPoint *> at_;   // (points)
  DeviceView<InteriorTarget *> aim_; // (points) of the next step
  DeviceView<State *> state_;        // (points) that they tend to
  double pressure_ = 0;              // that points start with [Pa]
  double length_ = 0;                // size of displacements [m]
  double mu_ = 0;                    // mean of p s and q d [J/m^2]
  double gap_ = 1;
  bool settled_ = false;
  int short_steps_ = 0; // on end
};

} // namespace rpc::contact
