// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <Teuchos_ParameterList.hpp>
#include <functional>
#include <memory>
#include <string>

namespace rpc::solver
{

/// A Krylov method of Belos for one operator, with a preconditioner on the right; its solver manager is made once. GMRES, by
/// the names that is_gmres() knows, works with KrylovVectors, other methods with Tpetra's. All members are collective.
class BelosMethod
{
public:
  virtual ~BelosMethod() = default;
  /// x <- approximately H^-1 b, from 0, until |r| <= tolerance |b|.
  /// @return whether that was reached
  /// @throws what Belos, the operators and `before_iteration` throw
  virtual bool solve(double tolerance, const Vector &b, Vector &x) = 0;
  virtual int iterations() const = 0;  ///< of the last solve
  virtual double achieved() const = 0; ///< |r|/|b| after it, by the method's own account

  /// Called before each iteration with the number of those before it and |r|, by GMRES alone. Null: never.
  std::function<void(int iterations, double residual)> before_iteration;
  /// Whether add_update() can be had.
  virtual bool tells_update() const = 0;
  /// x += what GMRES has found since its last restart; in before_iteration alone.
  virtual void add_update(Vector &x) const = 0;
};

/// @param name  of Belos' solver factory   @param list  on top of Belos' defaults
std::unique_ptr<BelosMethod> belos_method(const std::string &name, const RCP<Teuchos::ParameterList> &list,
                                          const RCP<const Operator> &H, const RCP<const Operator> &preconditioner);

/// Of Belos' names: methods that break down, or go wrong, where H is not symmetric.
bool needs_symmetry(const std::string &method);

/// What takes their place, with its list on top of Belos' defaults: it keeps its preconditioned vectors, too, and so applies the
/// preconditioner once an iteration, and to nothing else.
constexpr const char *gmres = "Block GMRES";
Teuchos::ParameterList gmres_defaults(int max_iterations);

/// The parameters that a method of Belos knows, with their defaults.
RCP<const Teuchos::ParameterList> belos_parameters(const std::string &method);

/// Those entries of a deck's list that a method of Belos knows.
Teuchos::ParameterList entries_for(const std::string &method, const Teuchos::ParameterList &deck);

} // namespace rpc::solver
