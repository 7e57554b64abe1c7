// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/coarse_model.hpp"
#include "rpc/analysis/problem.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/contact/iterate.hpp"
#include "rpc/core/headway.hpp"
#include "rpc/solver/rules.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace rpc::analysis
{

/// Choices of contact states by a coarser mesh of the body, see CoarseModel: on thin bodies pressures at single points tell little of the
/// states, for the body bends far under small forces. Rank 0 has the model. Without friction.
class CoarseChoice
{
public:
  /// Whether rank 0 can hold the stiffness of a mesh.
  static bool is_small(const Problem &coarse);
  /// Null where the factors of the coarse mesh's stiffness are not cheap. Collective.
  /// @param coarse  small   @param dirichlet  which unknowns of the coarse mesh are prescribed
  /// @param solve_seconds  what a linear solve of the fine mesh takes on one rank
  static std::unique_ptr<CoarseChoice> make(const Problem &coarse, const fem::DirichletDofs &dirichlet,
                                            const fem::Discretization &fine, const contact::Iterate &iterate,
                                            double solve_seconds);

  /// The next active set, at the minimum for the present one. Nothing where the model does not converge, or active sets make no progress; then
  /// it is not to be asked again. Collective.
  /// @param present  what pressures choose there, Iterate::choose_active_set
  std::optional<contact::ActiveSetChoice> choose(const contact::Iterate &iterate,
                                                 const contact::ActiveSetChoice &present, const Vector &u);

private:
  CoarseChoice(RCP<const Comm> comm, std::vector<LO> points, std::optional<CoarseModel> model);

  RCP<const Comm> comm_;
  std::vector<LO> points_;           // that take part, of this rank
  std::optional<CoarseModel> model_; // on rank 0
  Headway headway_{{1, choice_rules.most_idle_coarse, Headway::unlimited,
                    solver::newton_rules.most_inner_steps}}; // of changes by pressures
};

/// By a coarser mesh, see make(). Collective.
using MakeCoarseChoice =
    std::function<std::unique_ptr<CoarseChoice>(const contact::Iterate &iterate, double solve_seconds)>;

} // namespace rpc::analysis
