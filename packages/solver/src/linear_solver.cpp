// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/linear_solver.hpp"

#include "convergence.hpp"
#include "iteration_cost.hpp"
#include "krylov.hpp"
#include "muelu_defaults.hpp"
#include "policy.hpp"
#include "preconditioner/algebraic.hpp"
#include "preconditioner/factor.hpp"
#include "preconditioner/meshes.hpp"
#include "preconditioner/mixed.hpp"
#include "preconditioner/sparse.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/message.hpp"
#include "rpc/solver/rules.hpp"

#include <Teuchos_StackedTimer.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace rpc::solver
{
namespace
{

double fair(const double tolerance)
{
  return linear_rules.fair_iterations * std::min(1., std::log(tolerance) / std::log(linear_rules.full_tolerance));
}

/// What is to be done about a result; nothing where it is good.
std::optional<Outcome> outcome_of(const LinearSolver::Result &result, const bool given_up)
{
  if (result.interrupted) return std::nullopt;
  if (given_up) return dear;
  if (result.broken) return broken;
  if (!result.converged) return failed;
  if (result.iterations > linear_rules.slow) return slow;
  return std::nullopt;
}

} // namespace

std::string solver_path(const LinearSolverCounts &counts)
{
  std::string text;
  for (const std::string &taken : counts.path) text += (text.empty() ? "" : " -> ") + taken;
  return text;
}

std::string chosen_solver(const LinearSolverCounts &counts)
{
  return counts.description + (counts.path.size() > 1 ? " (" + solver_path(counts) + ")" : "");
}

/// The preconditioners, each with its own state, and which of them is in use.
struct LinearSolver::Impl {
  LinearSolverOptions options;
  RCP<UpdatedOperator> H;
  Body body;
  LinearSolverCounts counts;
  std::optional<Meshes> meshes; // nothing: the deck or the mesh rules it out
  std::optional<Mixed> mixed;   // nothing: the same, or the body is not nearly incompressible
  std::optional<Factor> factor; // nothing: there are many unknowns, the deck rules it out, or it was too weak
  Algebraic algebraic;
  Sparse sparse;
  Krylov krylov;
  bool on_meshes;                                    // or on one of the others
  bool on_mixed = false;                             // until it fails
  bool mixed_again = false;                          // in the next solve: a matrix was met that may be singular
  bool on_sparse = false;                            // from some solve on
  int solves_to_come = 1;                            // about
  bool may_be_sparse;                                // the deck leaves the preconditioner open, and memory may do
  double lost_iterations = 0;                        // of CG, in all solves, beyond what is fair
  std::optional<IterationSeconds> iteration_seconds; // nothing: not asked for yet
  bool given_up = false;                             // the last solve, in favour of a sparse factor
  bool met_singular = false;                         // a matrix that neither hierarchy can solve for
  bool stands_in = false;                            // since the meshes failed in the present solve
  Preconditioner *used = nullptr;                    // in the last solve

  Impl(LinearSolverOptions given, const RCP<UpdatedOperator> &of, Body of_body, MakeMeshLevels levels,
       MakeMixedForm mixed_form);
  Preconditioner *chosen();
  void prepare(double tolerance);
  bool counted(Preconditioner &B, double tolerance);
  Result attempt(const Vector &b, Vector &x, const Accuracy &wanted);
  Used used_for_policy() const;
  const IterationSeconds &seconds_of_cg();
  const Sparse::Prospect *prospect();
  bool sparse_pays(double iterations_in_all, double tolerance);
  bool sparse_pays_now(const Convergence &seen, double tolerance);
  void choose_before_the_first_solve();
  bool take(Next next, const std::string &reason);
  void record(const Preconditioner &B, const std::string &reason);
};

LinearSolver::Impl::Impl(LinearSolverOptions given, const RCP<UpdatedOperator> &of, Body of_body, MakeMeshLevels levels,
                         MakeMixedForm mixed_form)
    : options(std::move(given)), H(of), body(std::move(of_body)),
      algebraic(H, body, options,
                static_cast<GO>(H->getDomainMap()->getGlobalNumElements()) <= linear_rules.most_rows_for_each_state),
      sparse(H), krylov(options, H)
{
  const GO unknowns = static_cast<GO>(H->getDomainMap()->getGlobalNumElements());
  const bool automatic = options.multigrid == "auto" && options.muelu.numParams() == 0;
  const bool want_meshes = options.multigrid == "mesh" || (automatic && unknowns > linear_rules.few_rows);
  if (levels && want_meshes) meshes.emplace(H, std::move(levels), options);
  if (automatic && unknowns <= linear_rules.most_rows_for_each_state) factor.emplace(H);
  on_meshes = meshes.has_value();
  if (mixed_form && want_meshes) mixed.emplace(H, std::move(mixed_form), options);
  on_mixed = mixed.has_value();
  may_be_sparse = automatic && unknowns <= linear_rules.most_sparse_rows;
  if (sum_all(*H->getDomainMap()->getComm(), static_cast<GO>(H->nodes().extent(0))) > 0)
    solves_to_come = linear_rules.solves_with_contact;
}

/// Of an iteration of CG with multigrid; collective.
const IterationSeconds &LinearSolver::Impl::seconds_of_cg()
{
  if (!iteration_seconds) iteration_seconds = seconds_of_iteration(H->base());
  return *iteration_seconds;
}

/// What a sparse factor takes; null where it cannot be had. Collective.
const Sparse::Prospect *LinearSolver::Impl::prospect()
{
  if (!may_be_sparse) return nullptr;
  const auto &found = sparse.prospect();
  if (found.obstacle.empty()) return &found;
  may_be_sparse = false;
  sparse.forget();
  record(sparse, "not made: " + found.obstacle);
  return nullptr;
}

/// Whether the iterations that CG has lost, and will lose in this solve and those to come if each takes so many, take longer than a sparse
/// factor.                                                                                                        (4.10)
bool LinearSolver::Impl::sparse_pays(const double iterations_in_all, const double tolerance)
{
  if (!may_be_sparse) return false;
  const double lost =
      seconds_of_cg().counted * (lost_iterations + solves_to_come * std::max(iterations_in_all - fair(tolerance), 0.));
  if (lost < cost_model.analysis_of_row * static_cast<double>(H->getDomainMap()->getGlobalNumElements())) return false;
  const auto *const found = prospect();
  return found && found->cost.seconds < lost;
}

/// The same at the present rate of a solve, and where it would end at CG's limit by far: the factor takes over then anyway.
bool LinearSolver::Impl::sparse_pays_now(const Convergence &seen, const double tolerance)
{
  if (seen.iterations() < options.first_iterations) return false;
  const double limit = options.max_iterations, by_far = linear_rules.far_beyond * limit;
  if (seen.iterations() >= limit / linear_rules.far_beyond && seen.iterations_in_all(tolerance, by_far) >= by_far &&
      prospect())
    return true;
  return sparse_pays(seen.iterations_in_all(tolerance, limit), tolerance) &&
         seen.iterations() * seconds_of_cg().measured >= linear_rules.part_to_tell * sparse.prospect().cost.seconds;
}

/// By the form of the body, and by the iterations that it lets expect. Where these are more than CG may take, a factor would follow anyway.
void LinearSolver::Impl::choose_before_the_first_solve()
{
  if (on_sparse || !counts.iterations.empty()) return;
  const bool is_open = may_be_sparse && chosen();
  const Map &unknowns = *H->getDomainMap();
  const bool narrow = is_open && body.band_width > 0 &&
                      is_narrow(static_cast<double>(unknowns.getGlobalNumElements()), body.band_width, seconds_of_cg(),
                                unknowns.getComm()->getSize());
  if (narrow) sparse.take_band();
  if (narrow && take(Next::sparse, "it takes no longer than a few iterations")) return;
  if (is_open && body.is_thin && take(Next::sparse, "the body is one thin layer of cells")) return;
  const double expected = options.expected_iterations;
  if (!(expected > 0)) return;
  if (expected > options.max_iterations ? !prospect() : !sparse_pays(expected, linear_rules.full_tolerance)) return;
  take(Next::sparse, "about " + std::to_string(static_cast<int>(expected)) + " CG iterations expected");
}

/// Brings a preconditioner to H, and counts what that took. @return whether it can be used
bool LinearSolver::Impl::counted(Preconditioner &B, const double tolerance)
{
  used = &B;
  const double start = Teuchos::Time::wallTime();
  const auto done = B.prepare(tolerance);
  counts.preconditioner_setups += done == Preconditioner::Prepared::made;
  counts.local_corrections += done == Preconditioner::Prepared::updated;
  if (done != Preconditioner::Prepared::unchanged) counts.setup_seconds += Teuchos::Time::wallTime() - start;
  return done != Preconditioner::Prepared::refused;
}

/// What is in use; null: the factor of few unknowns or the algebraic hierarchy.
Preconditioner *LinearSolver::Impl::chosen()
{
  if (on_sparse) return &sparse;
  if (on_mixed) return &*mixed;
  return on_meshes ? &*meshes : nullptr;
}

/// `used` <- the preconditioner that is in use, for the present H.
void LinearSolver::Impl::prepare(const double tolerance)
{
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::preconditioner"));
  if (Preconditioner *const B = chosen()) {
    counted(*B, tolerance);
    return;
  }
  if (factor && counted(*factor, tolerance)) return;
  try {
    counted(algebraic, tolerance);
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) {
    pass_on_out_of_memory(failure);
    if (options.muelu.numParams() == 0 || counts.preconditioner_setups > 0) throw;
    throw Error(ExitCode::bad_input, "deck: \"Linear Solver->MueLu\": " + one_line(failure.what()));
  }
  if (factor) record(algebraic, "a factor is refused");
}

void LinearSolver::Impl::record(const Preconditioner &B, const std::string &reason)
{
  const std::string entry = B.name() + (reason.empty() ? "" : ": " + reason);
  if (std::find(counts.path.begin(), counts.path.end(), entry) == counts.path.end()) counts.path.push_back(entry);
}

/// One solve with what is in use.
LinearSolver::Result LinearSolver::Impl::attempt(const Vector &b, Vector &x, const Accuracy &wanted)
{
  Result result;
  given_up = false;
  try {
    if (interrupted(*H->getDomainMap()->getComm())) throw Interrupted();
    const double least = std::max(wanted.residual, options.tolerance);
    prepare(least);
    const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::krylov"));
    const double start = Teuchos::Time::wallTime();
    Convergence seen;
    const auto gives_up = [&](const int iterations, const double residual) {
      if (iterations > seen.iterations()) seen.add(residual);
      if (!on_sparse) return sparse_pays_now(seen, least);
      return seen.iterations() >= linear_rules.first_iterations_of_factor &&
             sparse.renewal_pays(seen.iterations_in_all(least, options.max_iterations) - seen.iterations());
    };
    const GivesUp asked = may_be_sparse ? GivesUp(gives_up) : GivesUp();
    const KrylovResult done =
        on_mixed ? mixed->solve(b, x, wanted, asked) : krylov.solve(*used, H->is_symmetric(), b, x, wanted, asked);
    given_up = done.given_up;
    lost_iterations += std::max(0., done.iterations - fair(least));
    if (used == &algebraic) algebraic.learn(done.iterations, done.residual);
    if (on_mixed)
      mixed->learn(done.iterations, seconds_of_cg().counted);
    else if (on_meshes)
      meshes->learn(done.iterations, seconds_of_cg().counted);
    result = {done.converged, done.broken, false, done.iterations, done.energy, done.reason};
    counts.iterations.push_back(result.iterations);
    counts.solve_seconds += Teuchos::Time::wallTime() - start;
    counts.description = used->description();
    if (!result.broken && !std::isfinite(x.norm2())) {
      result.converged = false;
      result.broken = true;
      result.reason = describe_not_finite("the solution of linear solve " + std::to_string(counts.iterations.size()), x,
                                          *body.coordinates());
    }
  } catch (const Interrupted &) {
    result = {};
    result.broken = result.interrupted = true;
    result.reason = interruption();
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) { // of a set-up, such as a singular matrix; the same on all ranks
    pass_on_out_of_memory(failure);
    counts.iterations.push_back(0);
    result.broken = true;
    result.reason = "the linear solver broke down: " + one_line(failure.what());
  }
  return result;
}

Used LinearSolver::Impl::used_for_policy() const
{
  if (on_sparse) return sparse.is_from_scratch() ? Used::sparse_fresh : Used::sparse;
  if (on_mixed) return Used::mixed;
  if (on_meshes) return met_singular ? Used::meshes_again : Used::meshes;
  if (stands_in) return Used::stand_in;
  if (factor && used == &*factor) return Used::factor;
  return algebraic.is_from_scratch() ? Used::from_scratch : Used::algebraic;
}

/// Puts into use what the policy wants next. @return whether there is something new to use
bool LinearSolver::Impl::take(const Next next, const std::string &reason)
{
  switch (next) {
  case Next::nothing:
    return false;
  case Next::stand_in:
    meshes->forget();
    on_meshes = false;
    stands_in = true;
    counts.fallback = reason;
    record(factor ? static_cast<const Preconditioner &>(*factor) : algebraic, reason);
    return true;
  case Next::anew:
    if (on_sparse) {
      sparse.renew();
    } else {
      algebraic.forget();
      record(algebraic, "anew");
    }
    return true;
  case Next::sparse:
    if (!prospect()) return false;
    if (on_mixed) mixed->forget();
    on_mixed = false;
    if (on_meshes) {
      meshes->forget();
      counts.fallback = reason;
    }
    algebraic.forget();
    factor.reset();
    on_meshes = false;
    on_sparse = true;
    record(sparse, reason);
    return true;
  case Next::whole:
  case Next::whole_once:
    mixed->forget();
    on_mixed = false;
    mixed_again = next == Next::whole_once;
    if (!mixed_again) options.first_iterations = LinearSolverOptions().first_iterations;
    record(meshes ? static_cast<const Preconditioner &>(*meshes) : algebraic, reason);
    return true;
  case Next::stronger:
    if (!algebraic.strengthen()) return false;
    factor.reset();
    record(algebraic, reason);
    return true;
  case Next::meshes_back:
    algebraic.forget();
    if (factor) factor->forget();
    on_meshes = met_singular = true;
    counts.fallback.clear();
    record(*meshes, "the matrix is singular");
    return false;
  }
  return false;
}

LinearSolver::LinearSolver(LinearSolverOptions options, const RCP<UpdatedOperator> &H, Body body, MakeMeshLevels levels,
                           MakeMixedForm mixed)
    : impl_(std::make_unique<Impl>(std::move(options), H, std::move(body), std::move(levels), std::move(mixed)))
{
}

LinearSolver::~LinearSolver() = default;

const LinearSolverCounts &LinearSolver::counts() const
{
  return impl_->counts;
}

double LinearSolver::seconds_of_last_solve() const
{
  Impl &now = *impl_;
  if (now.counts.iterations.empty()) return 0;
  const double cycle = now.on_sparse ? now.sparse.prospect().cost.seconds_of_solve : now.seconds_of_cg().measured;
  return (now.counts.iterations.back() + 1) * cycle;
}

const Body &LinearSolver::body() const
{
  return impl_->body;
}

LinearSolver::Result LinearSolver::solve(const Vector &b, Vector &x, const Accuracy &asked)
{
  Accuracy wanted = asked;
  if (wanted.error > 0) {
    wanted.residual *= impl_->options.rough_part;
    wanted.error *= impl_->options.rough_part;
  }
  if (b.norm2() == 0) {
    x.putScalar(0);
    Result nothing_to_do;
    nothing_to_do.converged = true;
    return nothing_to_do;
  }
  impl_->stands_in = false;
  impl_->on_mixed = impl_->on_mixed || (std::exchange(impl_->mixed_again, false) && !impl_->on_sparse);
  impl_->choose_before_the_first_solve();
  for (;;) {
    const Result result = impl_->attempt(b, x, wanted);
    if (impl_->counts.path.empty() && impl_->used) impl_->record(*impl_->used, "");
    const auto outcome = outcome_of(result, impl_->given_up);
    if (!outcome) return result;
    const PolicyRow &rule = rule_for(impl_->used_for_policy(), *outcome);
    const std::string reason = result.converged ? std::to_string(result.iterations) + " iterations" : result.reason;
    const bool other = impl_->take(rule.next, reason) || impl_->take(rule.otherwise, reason);
    if (!other || *outcome == slow) return result;
  }
}

double LinearSolver::inverse_energy(const Vector &F)
{
  if (!(F.norm2() > 0)) return 0;
  try {
    impl_->prepare(1);
    return solver::inverse_energy(*impl_->used, F);
  } catch (const Interrupted &) { // the next solve tells
    return std::numeric_limits<double>::quiet_NaN();
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) { // a breakdown, such as a singular coarse matrix; the same on all ranks
    pass_on_out_of_memory(failure);
    return std::numeric_limits<double>::quiet_NaN();
  }
}

} // namespace rpc::solver
