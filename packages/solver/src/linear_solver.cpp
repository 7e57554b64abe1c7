// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/linear_solver.hpp"

#include "krylov/convergence.hpp"
#include "krylov/iteration_cost.hpp"
#include "krylov/krylov.hpp"
#include "preconditioner/algebraic.hpp"
#include "preconditioner/factor.hpp"
#include "preconditioner/meshes.hpp"
#include "preconditioner/mixed.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/message.hpp"
#include "rpc/solver/rules.hpp"

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

/// How a linear solve went that was not good.
enum class Outcome {
  failed, ///< it stopped before it converged
  broken, ///< the set-up or the Krylov method broke down: the matrix may be singular
  dear    ///< it was given up, for a sparse factor takes less time than the iterations that were left
};

/// Nothing where the result is good.
std::optional<Outcome> outcome_of(const LinearSolver::Result &result, const bool given_up)
{
  if (result.interrupted) return std::nullopt;
  if (given_up) return Outcome::dear;
  if (result.broken) return Outcome::broken;
  if (!result.converged) return Outcome::failed;
  return std::nullopt;
}

} // namespace

/// The candidates in order: the first one that applies is used. A sparse factor stands first, and waits until the iterations of the others
/// would take longer than it. Where a solve fails, breaks down or is given up, goes_on() puts the next one in use for the same solve.
struct LinearSolver::Impl {
  enum class Kind { sparse, mixed, meshes, algebraic };
  enum class State {
    waits, ///< until it takes less time than the others
    open,  ///< may be used
    rests, ///< in this solve
    left   ///< for good
  };
  struct Candidate {
    Kind kind;
    std::unique_ptr<Preconditioner> B;
    State state = State::open;

    bool applies() const { return state == State::open; }
    bool is_on_meshes() const { return kind == Kind::mixed || kind == Kind::meshes; }
  };
  LinearSolverOptions options;
  RCP<UpdatedOperator> H;
  Body body;
  LinearSolverCounts counts;
  std::vector<Candidate> candidates;
  Factor *sparse;               // the first of them
  const Mixed *mixed = nullptr; // null: the deck, the mesh or the body rules it out
  Algebraic *algebraic;         // the last of them
  Krylov krylov;
  int solves_to_come = 1;               // about
  bool may_be_sparse;                   // the deck leaves the preconditioner open, and memory may do
  double lost_iterations = 0;           // of CG, in all solves, beyond what is fair
  const IterationSeconds seconds_of_cg; // of an iteration with multigrid
  bool given_up = false;                // the last solve, in favour of a sparse factor
  bool met_singular = false;            // a matrix that the meshes and what took their place broke down on
  Candidate *stands_in_for = nullptr;   // the meshes, where another one took their place in the present solve
  Candidate *used = nullptr;            // in the last solve

  Impl(LinearSolverOptions given, const RCP<UpdatedOperator> &of, Body of_body, MakeMeshLevels levels,
       MakeMixedForm mixed_form);
  template <class B, class... Arguments>
  B *consider(Kind kind, State state, Arguments &&...arguments);
  Candidate &first(); ///< that applies; the algebraic hierarchy always does
  CandidateCounts &row(const Candidate &candidate) { return counts.candidates[&candidate - candidates.data()]; }
  void reopen(Candidate &candidate)
  {
    candidate.state = State::open;
    row(candidate).left.clear();
  }
  bool is_sparse() const { return candidates.front().applies(); }
  void prepare();
  void count(Candidate &candidate);
  void count_solve(int iterations, double seconds);
  Result attempt(const Vector &b, Vector &x, const Accuracy &wanted);
  const Factor::Prospect *prospect();
  bool sparse_pays(double iterations_in_all, double fair_ones);
  bool sparse_pays_now(const Convergence &seen, double tolerance);
  void choose_before_the_first_solve();
  bool goes_on(Outcome outcome, const std::string &reason);
  bool take_sparse(const std::string &reason);
  void come_back(Candidate &candidate);
  bool leave(Candidate &candidate, State state, const std::string &reason);
  void put_out(Candidate &candidate, State state, const std::string &reason);
  void record(const Candidate &candidate, const std::string &reason);
};

LinearSolver::Impl::Impl(LinearSolverOptions given, const RCP<UpdatedOperator> &of, Body of_body, MakeMeshLevels levels,
                         MakeMixedForm mixed_form)
    : options(std::move(given)), H(of), body(std::move(of_body)), krylov(options, H),
      seconds_of_cg(seconds_of_iteration(H->base()))
{
  const GO unknowns = static_cast<GO>(H->getDomainMap()->getGlobalNumElements());
  const bool automatic = options.multigrid == "auto" && options.muelu.numParams() == 0;
  const bool want_meshes = options.multigrid == "mesh" || (automatic && unknowns > linear_rules.few_rows);
  sparse = consider<Factor>(Kind::sparse, State::waits, H);
  if (mixed_form && want_meshes) mixed = consider<Mixed>(Kind::mixed, State::open, H, std::move(mixed_form), options);
  if (levels && want_meshes) consider<Meshes>(Kind::meshes, State::open, H, std::move(levels), options);
  algebraic = consider<Algebraic>(Kind::algebraic, State::open, H, body, options);
  may_be_sparse = automatic && unknowns <= linear_rules.most_sparse_rows;
  if (sum_all(*H->getDomainMap()->getComm(), static_cast<GO>(H->nodes().extent(0))) > 0)
    solves_to_come = linear_rules.solves_with_contact;
}

template <class B, class... Arguments>
B *LinearSolver::Impl::consider(const Kind kind, const State state, Arguments &&...arguments)
{
  auto made = std::make_unique<B>(std::forward<Arguments>(arguments)...);
  B *const raw = made.get();
  candidates.push_back({kind, std::move(made), state});
  counts.candidates.emplace_back().name = raw->name();
  return raw;
}

/// What a sparse factor takes; null where it cannot be had. Collective.
const Factor::Prospect *LinearSolver::Impl::prospect()
{
  if (!may_be_sparse) return nullptr;
  const auto &found = sparse->prospect();
  if (found.obstacle.empty()) return &found;
  may_be_sparse = false;
  row(candidates.front()).left = found.obstacle;
  sparse->forget();
  record(candidates.front(), "not made: " + found.obstacle);
  return nullptr;
}

/// Whether the iterations that CG has lost, and will lose in this solve and those to come if each takes so many, take longer than a sparse
/// factor.                                                                                                        (4.10)
bool LinearSolver::Impl::sparse_pays(const double iterations_in_all, const double fair_ones)
{
  if (!may_be_sparse) return false;
  const double lost =
      seconds_of_cg.counted * (lost_iterations + solves_to_come * std::max(iterations_in_all - fair_ones, 0.));
  if (lost < cost_model.analysis_of_row * static_cast<double>(H->getDomainMap()->getGlobalNumElements())) return false;
  const auto *const found = prospect();
  return found && found->cost.seconds < lost;
}

/// The same at the present rate of a solve.
bool LinearSolver::Impl::sparse_pays_now(const Convergence &seen, const double tolerance)
{
  if (seen.iterations() < linear_rules.first_iterations) return false;
  return sparse_pays(seen.iterations_in_all(tolerance, options.max_iterations), fair(tolerance)) &&
         seen.iterations() * seconds_of_cg.measured >= linear_rules.part_to_tell * sparse->prospect().cost.seconds;
}

/// By the number of unknowns, the form of the body, and the iterations that it lets expect. Where these are more than CG may take, a factor would follow anyway.
void LinearSolver::Impl::choose_before_the_first_solve()
{
  if (is_sparse() || !counts.iterations.empty()) return;
  const Map &unknowns = *H->getDomainMap();
  const bool are_few = static_cast<GO>(unknowns.getGlobalNumElements()) <= linear_rules.few_rows;
  if (are_few && take_sparse("few unknowns")) return;
  const bool is_open = may_be_sparse && first().is_on_meshes();
  const bool narrow = is_open && body.band_width > 0 &&
                      is_narrow(static_cast<double>(unknowns.getGlobalNumElements()), body.band_width, seconds_of_cg);
  if (narrow) sparse->take_band();
  if (narrow && take_sparse("it takes no longer than a few iterations")) return;
  if (is_open && body.is_thin && take_sparse("the body is one thin layer of cells")) return;
  const double expected = options.expected_iterations;
  if (!(expected > 0)) return;
  if (expected > options.max_iterations ? !prospect() : !sparse_pays(expected, linear_rules.fair_iterations)) return;
  take_sparse("about " + std::to_string(static_cast<int>(expected)) + " CG iterations expected");
}

/// Brings a preconditioner to H, and counts what that took.
void LinearSolver::Impl::count(Candidate &candidate)
{
  used = &candidate;
  row(candidate).tried = true;
  const double start = Teuchos::Time::wallTime();
  const auto done = candidate.B->prepare();
  counts.preconditioner_setups += done == Preconditioner::Prepared::made;
  row(candidate).setups += done == Preconditioner::Prepared::made;
  counts.local_corrections += done == Preconditioner::Prepared::updated;
  if (done != Preconditioner::Prepared::unchanged) counts.setup_seconds += Teuchos::Time::wallTime() - start;
}

LinearSolver::Impl::Candidate &LinearSolver::Impl::first()
{
  return *std::find_if(candidates.begin(), candidates.end(), [](const Candidate &c) { return c.applies(); });
}

/// `used` <- the first candidate that applies, brought to H.
void LinearSolver::Impl::prepare()
{
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::preconditioner"));
  Candidate &candidate = first();
  try {
    count(candidate);
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) {
    pass_on_out_of_memory(failure);
    if (candidate.kind != Kind::algebraic || options.muelu.numParams() == 0 || counts.preconditioner_setups > 0) throw;
    throw Error(ExitCode::bad_input, "deck: \"Linear Solver->MueLu\": " + one_line(failure.what()));
  }
}

void LinearSolver::Impl::record(const Candidate &candidate, const std::string &reason)
{
  const std::string &name = row(candidate).name = candidate.B->name();
  const std::string entry = name + (reason.empty() ? "" : ": " + reason);
  if (std::find(counts.path.begin(), counts.path.end(), entry) == counts.path.end()) counts.path.push_back(entry);
}

void LinearSolver::Impl::count_solve(const int iterations, const double seconds)
{
  counts.iterations.push_back(iterations);
  ++row(*used).solves;
  row(*used).iterations += iterations;
  counts.solve_seconds += seconds;
  counts.description = used->B->description();
}

/// One solve with what is in use.
LinearSolver::Result LinearSolver::Impl::attempt(const Vector &b, Vector &x, const Accuracy &wanted)
{
  Result result;
  given_up = false;
  try {
    if (interrupted(*H->getDomainMap()->getComm())) throw Interrupted();
    double least = std::max(wanted.residual, options.tolerance);
    Accuracy to = wanted;
    if (wanted.goes_on)
      to.goes_on = [&](const Vector &rough) {
        if (!wanted.goes_on(rough)) return false;
        least = std::max(wanted.further, options.tolerance);
        return true;
      };
    prepare();
    const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::krylov"));
    const double start = Teuchos::Time::wallTime();
    Convergence seen;
    const auto gives_up = [&](const int iterations, const double residual) {
      if (iterations > seen.iterations()) seen.add(residual);
      if (!is_sparse()) return sparse_pays_now(seen, least);
      return seen.iterations() >= linear_rules.first_iterations_of_factor &&
             sparse->renewal_pays(seen.iterations_in_all(least, options.max_iterations) - seen.iterations());
    };
    const GivesUp asked = may_be_sparse ? GivesUp(gives_up) : GivesUp();
    const KrylovResult done = used->kind == Kind::mixed ? mixed->solve(b, x, to, asked)
                                                        : krylov.solve(*used->B, H->is_symmetric(), b, x, to, asked);
    given_up = done.given_up;
    lost_iterations += std::max(0., done.iterations - fair(least));
    used->B->learn(done.iterations, seconds_of_cg.counted);
    result = {done.converged, done.broken, false, done.iterations, done.energy, done.reason};
    count_solve(result.iterations, Teuchos::Time::wallTime() - start);
    if (!result.broken && !std::isfinite(x.norm2())) {
      result.converged = false;
      result.broken = true;
      result.reason = describe_not_finite("the solution of linear solve " + std::to_string(counts.iterations.size()), x,
                                          *body.coordinates());
    }
  } catch (const Interrupted &) {
    result = {false, true, true, 0, 0, interruption()};
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

/// Puts into use what is to follow a solve that was not good. @return whether there is something new to use
bool LinearSolver::Impl::goes_on(const Outcome outcome, const std::string &reason)
{
  Candidate &now = *used;
  if (outcome == Outcome::dear && !is_sparse()) return take_sparse(reason);
  if (now.B->renew()) { // what it has reused, or followed, may be to blame
    if (!is_sparse()) record(now, "anew");
    return true;
  }
  if (is_sparse()) return false; // the matrix is singular, or nearly so
  if (outcome == Outcome::broken) {
    // Either the active set leaves the body unheld, or the coarse meshes do not represent H: the next candidate tells.
    if (now.kind == Kind::mixed) return leave(now, State::rests, reason);
    if (now.kind == Kind::meshes && !met_singular) return leave(now, State::left, reason);
    if (stands_in_for) come_back(*stands_in_for);
    return false;
  }
  // The mixed form fails in cells that are too stretched for it, which multigrid for the whole matrix may be good at.
  return (now.kind != Kind::mixed && take_sparse(reason)) || leave(now, State::left, reason);
}

/// The next one is used from now on; of an algebraic hierarchy it is its stronger form. @return whether there is one
bool LinearSolver::Impl::leave(Candidate &candidate, const State state, const std::string &reason)
{
  if (candidate.kind != Kind::algebraic)
    put_out(candidate, state, reason);
  else if (!algebraic->strengthen())
    return false;
  record(first(), reason);
  return true;
}

void LinearSolver::Impl::put_out(Candidate &candidate, const State state, const std::string &reason)
{
  candidate.B->forget();
  candidate.state = state;
  row(candidate).left = reason;
  if (candidate.kind != Kind::meshes) return;
  counts.fallback = reason;
  stands_in_for = &candidate;
}

/// What took its place has broken down, too: the matrix is singular.
void LinearSolver::Impl::come_back(Candidate &candidate)
{
  for (Candidate &other : candidates)
    if (other.applies()) other.B->forget();
  reopen(candidate);
  counts.fallback.clear();
  met_singular = true;
  record(candidate, "the matrix is singular");
}

bool LinearSolver::Impl::take_sparse(const std::string &reason)
{
  if (!prospect()) return false;
  for (Candidate &other : candidates)
    if (other.applies() || other.state == State::rests) put_out(other, State::left, reason);
  candidates.front().state = State::open;
  record(candidates.front(), reason);
  return true;
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

double LinearSolver::one_rank_seconds_of_last_solve() const
{
  Impl &now = *impl_;
  if (now.counts.iterations.empty()) return 0;
  const FactorCost cost = now.is_sparse() ? now.sparse->prospect().cost : FactorCost{};
  const double cycle = now.is_sparse() ? cost.gain_of_ranks * cost.seconds_of_solve : now.seconds_of_cg.on_one_rank;
  return (now.counts.iterations.back() + 1) * cycle;
}

const Body &LinearSolver::body() const
{
  return impl_->body;
}

LinearSolver::Result LinearSolver::solve_held(const Vector &b, Vector &x, const Accuracy &asked)
{
  Accuracy wanted = asked;
  if (wanted.error > 0) {
    wanted.residual *= impl_->options.rough_part;
    wanted.error *= impl_->options.rough_part;
  }
  if (b.norm2() == 0) {
    x.putScalar(0);
    return {true, false, false, 0, 0, {}};
  }
  impl_->stands_in_for = nullptr;
  for (auto &candidate : impl_->candidates)
    if (candidate.state == Impl::State::rests) impl_->reopen(candidate);
  impl_->choose_before_the_first_solve();
  for (;;) {
    const Result result = impl_->attempt(b, x, wanted);
    if (impl_->counts.path.empty() && impl_->used) impl_->record(*impl_->used, "");
    const auto outcome = outcome_of(result, impl_->given_up);
    if (!outcome) return result;
    if (!impl_->goes_on(*outcome, result.reason)) return result;
  }
}

const Preconditioner *LinearSolver::preconditioner()
{
  const LinearSolverOptions &asked = impl_->options;
  const bool by_deck = asked.method != LinearSolverOptions().method || asked.belos.numParams() > 0;
  if (tied_ || by_deck || asked.rough_part < 1) return nullptr;
  impl_->choose_before_the_first_solve();
  if (impl_->first().kind == Impl::Kind::mixed) return nullptr;
  try {
    impl_->prepare();
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) { // the same on all ranks; the next solve() tells
    pass_on_out_of_memory(failure);
    return nullptr;
  }
  if (impl_->counts.path.empty()) impl_->record(*impl_->used, "");
  return impl_->used->B.get();
}

void LinearSolver::count(const int iterations, const double seconds)
{
  impl_->count_solve(iterations, seconds);
}

double LinearSolver::inverse_energy_held(const Vector &F)
{
  if (!(F.norm2() > 0)) return 0;
  try {
    impl_->prepare();
    return solver::inverse_energy(*impl_->used->B, F);
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
