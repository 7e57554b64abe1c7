// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cells.hpp"

#include <functional>

namespace rpc::bound
{

/// One step of the method of conjugate gradients after the other, which lowers the energy of the tractions. Tractions stay in balance.
class Descent
{
public:
  /// y <- the derivative of the energy by x, or with linear = false its part that is linear in x.
  using Derivative = std::function<void(const Tractions &x, bool linear, const Tractions &y)>;
  /// z <- the answer of self-equilibrated tractions to a derivative g.
  using Answer = std::function<void(const Tractions &g, const Tractions &z)>;
  /// The inner product of tractions, over all ranks.
  using Product = std::function<double(const Tractions &x, const Tractions &y)>;

  Descent(Derivative derivative, Answer answer, Product product, const Tractions &t);
  /// @return by how much the energy falls [J]
  double step();

private:
  Derivative derivative_;
  Answer answer_;
  Product product_;
  Tractions t_, g_, z_, d_;
  double rho_ = 0;
};

} // namespace rpc::bound
