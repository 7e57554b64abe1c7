// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/xpetra.hpp"
#include "rpc/solver/sparse_factor.hpp"

#include <MueLu_SmootherPrototype.hpp>
#include <memory>

namespace rpc::solver
{

using CoarseSolver = MueLu::SmootherPrototype<double, LO, GO, Node>;

/// MueLu's coarse solver on several ranks where there is no Zoltan2, which would bring the coarse level to one: each rank
/// factors the whole coarse matrix. (MueLu 13.2's direct solvers are wrong on a distributed matrix, and a polynomial
/// leaves the smoothest modes to CG.)
class GatheredSolver : public CoarseSolver
{
public:
  RCP<const Teuchos::ParameterList> GetValidParameterList() const override;
  void DeclareInput(MueLu::Level &level) const override;
  /// Collective. @throws on all ranks: rpc::Error (bad_input) where the level has too many rows, std::runtime_error where the
  /// matrix is not positive definite
  void Setup(MueLu::Level &level) override;
  void Apply(XpetraVectors &x, const XpetraVectors &b, bool initial_guess_is_zero) const override;
  RCP<CoarseSolver> Copy() const override;
  std::size_t getNodeSmootherComplexity() const override
  {
    return factor_ ? static_cast<std::size_t>(factor_->cost().entries) : 0;
  }

private:
  int size_ = 0;
  std::shared_ptr<const SparseFactor> factor_; // null: not set up
};

} // namespace rpc::solver
