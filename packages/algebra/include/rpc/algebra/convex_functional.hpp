// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rpc
{

/// A convex functional along a line t -> u + t d, as far as its slope goes.
class LineFunction
{
public:
  struct Value {
    double slope;     ///< d/dt, nondecreasing in t
    double curvature; ///< of the piece that t lies on, >= 0
  };
  virtual ~LineFunction() = default;
  /// Collective.
  virtual Value at(double t) const = 0;
};

/// A convex functional on u + sum_k a_k d_k, as far as its gradient in the coefficients a goes.
class SubspaceFunction
{
public:
  struct Value {
    std::vector<double> gradient;  ///< (directions)
    std::vector<double> curvature; ///< (directions x directions) of the piece that a lies on; symmetric, semidefinite
  };
  virtual ~SubspaceFunction() = default;
  /// Collective. @param a  (directions) the same on all ranks
  virtual Value at(const std::vector<double> &a) const = 0;
  /// The functional on u + sum_k (a_k + t direction_k) d_k. Collective. @param at_a  at(a)
  virtual std::unique_ptr<LineFunction> along(const std::vector<double> &a, const Value &at_a,
                                              const std::vector<double> &direction) const = 0;
};

/// A convex functional with a Lipschitz continuous gradient and a generalized Hessian, which a generalized Newton iteration
/// minimizes. All vectors are on the unknowns that this rank owns; all members are collective.
class ConvexFunctional
{
public:
  virtual ~ConvexFunctional() = default;

  virtual double value(const Vector &u) const = 0;
  virtual void gradient(const Vector &u, Vector &F) const = 0;
  /// Brings hessian() to an element of the generalized Hessian at u. @return number of places where it changed
  virtual GO update_hessian(const Vector &u) = 0;
  virtual const RCP<UpdatedOperator> &hessian() const = 0;
  /// @param F  gradient at u
  virtual std::unique_ptr<LineFunction> along(const Vector &u, const Vector &d, const Vector &F) const = 0;

  /// @param F  gradient at u
  virtual std::unique_ptr<SubspaceFunction> within(const Vector &u, const std::vector<RCP<const Vector>> &directions,
                                                   const Vector &F) const = 0;

  /// Lowers the value by a nonlinear smoother, where there is one: Newton's directions start from there.
  virtual void sweep(Vector &u) const { (void)u; }
  /// Called with the length of each exact step along a Newton direction: a length beyond 1 says that hessian() is too stiff.
  virtual void step_taken(const double length) { (void)length; }
  /// A cheap fingerprint of the piece of the functional at u. Different values mean different pieces; different pieces may have equal
  /// values.
  virtual std::uint64_t piece(const Vector &u) const
  {
    (void)u;
    return 0;
  }
  /// |u|_2 against which a step is small.
  virtual double size(const Vector &u) const { return u.norm2(); }
};

} // namespace rpc
