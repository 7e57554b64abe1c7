#include "rpc/solver/newton.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/solver/exact_line_search.hpp"
#include "rpc/solver/newton_group.hpp"
#include "rpc/solver/sweep_direction.hpp"

#include <NOX.H>
#include <NOX_Abstract_PrePostOperator.H>
#include <NOX_Solver_LineSearchBased.H>
#include <NOX_StatusTest_Factory.H>
#include <Teuchos_TimeMonitor.hpp>
#include <Teuchos_oblackholestream.hpp>
#include <algorithm>
#include <sstream>

namespace rpc::solver
{
namespace
{

constexpr const char *passed_to_nox[] = {"Line Search", "Direction", "Printing", "Solver Options", "Status Tests"};

/// The paper's stopping test, |full Newton step| / |u| < tolerance. The full step, not the one that the line search
/// shortened: a short step is no sign of convergence.
class StepTest : public NOX::StatusTest::Generic
{
public:
  StepTest(RCP<NewtonContext> context, const double tolerance) : context_(std::move(context)), tolerance_(tolerance) {}

  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType) override
  {
    status_ = NOX::StatusTest::Unconverged;
    if (solver.getNumIterations() > 0) {
      const Vector u = context_->functional.displacement(tpetra(solver.getSolutionGroup().getX()));
      ratio_ = context_->direction_norm / u.norm2();
      if (ratio_ < tolerance_) status_ = NOX::StatusTest::Converged;
    }
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &out, const int indent) const override
  {
    return out << std::string(indent, ' ') << status_ << "|step|/|u| = " << ratio_ << " < " << tolerance_ << "\n";
  }

private:
  RCP<NewtonContext> context_;
  double tolerance_, ratio_ = 0;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

/// Stops where rounding ends Newton's progress: two more full steps with the same states, and the residual does not fall.
class StagnationTest : public NOX::StatusTest::Generic
{
public:
  explicit StagnationTest(RCP<NewtonContext> context) : context_(std::move(context)) {}

  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType) override
  {
    const auto &group = solver.getSolutionGroup();
    const auto states = context_->functional.count_states(tpetra(group.getX()));
    const bool falls = solver.getNumIterations() == 0 || group.getNormF() < 0.9 * least_residual_;
    const bool same = states.stuck == states_.stuck && states.open == states_.open && context_->step_length > 0.5;
    idle_steps_ = same && !falls ? idle_steps_ + 1 : 0;
    status_ = idle_steps_ >= 2 ? NOX::StatusTest::Failed : NOX::StatusTest::Unconverged;
    least_residual_ = falls || !same ? group.getNormF() : std::min(least_residual_, group.getNormF());
    states_ = states;
    if (status_ == NOX::StatusTest::Failed && context_->failure.empty())
      context_->failure = "the residual stagnates: the scene is too ill-conditioned for this accuracy";
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &out, const int indent) const override
  {
    return out << std::string(indent, ' ') << status_ << "residual falls, or states change\n";
  }

private:
  RCP<NewtonContext> context_;
  double least_residual_ = 0; // since the states last changed
  contact::StateCounts states_;
  int idle_steps_ = 0;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

/// Fails as soon as the run is to stop.
class InterruptTest : public NOX::StatusTest::Generic
{
public:
  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType) override
  {
    const auto &u = tpetra(solver.getSolutionGroup().getX());
    status_ = interrupted(*u.getMap()->getComm()) ? NOX::StatusTest::Failed : NOX::StatusTest::Unconverged;
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &out, const int indent) const override
  {
    return out << std::string(indent, ' ') << status_ << "no interrupt\n";
  }

private:
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

/// Tells the console about each step.
class Reporter : public NOX::Abstract::PrePostOperator
{
public:
  Reporter(RCP<NewtonContext> context, const double scale, std::function<void(const NewtonStep &)> report)
      : context_(std::move(context)), scale_(scale), report_(std::move(report))
  {
  }
  void runPreSolve(const NOX::Solver::Generic &solver) override { tell(solver, 0); }
  void runPostIterate(const NOX::Solver::Generic &solver) override
  {
    const auto *line = dynamic_cast<const NOX::Solver::LineSearchBased *>(&solver);
    tell(solver, line ? line->getStepSize() : 1);
  }

private:
  void tell(const NOX::Solver::Generic &solver, const double step_length) const
  {
    const auto &group = solver.getSolutionGroup();
    NewtonStep step;
    step.iteration = solver.getNumIterations();
    step.residual = group.isF() ? group.getNormF() / scale_ : 0;
    step.step_length = step_length;
    step.linear_iterations = step.iteration > 0 ? context_->linear_iterations : 0;
    step.states = context_->functional.count_states(tpetra(group.getX()));
    report_(step);
  }

  RCP<NewtonContext> context_;
  double scale_;
  std::function<void(const NewtonStep &)> report_;
};

RCP<Teuchos::ParameterList> nox_list(const Teuchos::ParameterList &user,
                                     const RCP<NOX::Abstract::PrePostOperator> &reporter)
{
  const auto list = Teuchos::parameterList("NOX");
  list->set("Nonlinear Solver", "Line Search Based");
  list->sublist("Printing").set("Output Information", 0);
  list->sublist("Printing")
      .set<RCP<std::ostream>>("Output Stream", rcp(new Teuchos::oblackholestream)); // else it warns
  list->sublist("Line Search").set("Method", "Exact");
  list->sublist("Direction").set("Method", "Sweep");
  if (user.isSublist("Printing")) list->remove("Printing");
  list->setParameters(user);
  list->remove("Status Tests", false);
  Teuchos::ParameterList &search = list->sublist("Line Search");
  if (search.isType<std::string>("Method") && search.get<std::string>("Method") == "Exact") {
    search.set("Method", "User Defined");
    search.set<RCP<NOX::LineSearch::UserDefinedFactory>>("User Defined Line Search Factory",
                                                         rcp(new ExactLineSearchFactory));
  }
  Teuchos::ParameterList &direction = list->sublist("Direction");
  if (direction.isType<std::string>("Method") && direction.get<std::string>("Method") == "Sweep") {
    direction.set("Method", "User Defined");
    direction.set<RCP<NOX::Direction::UserDefinedFactory>>("User Defined Direction Factory",
                                                           rcp(new SweepDirectionFactory));
  }
  list->sublist("Solver Options").set("User Defined Pre/Post Operator", reporter);
  return list;
}

RCP<NOX::StatusTest::Generic> status_tests(const NewtonOptions &options, const RCP<NewtonContext> &context)
{
  using namespace NOX::StatusTest;
  const RCP<Combo> tests = rcp(new Combo(Combo::OR));
  tests->addStatusTest(rcp(new FiniteValue));
  tests->addStatusTest(rcp(new InterruptTest));
  if (options.nox.isSublist("Status Tests")) { // the user's, instead of ours
    Teuchos::ParameterList list = options.nox.sublist("Status Tests");
    tests->addStatusTest(buildStatusTests(list, NOX::Utils()));
    return tests;
  }
  tests->addStatusTest(rcp(new NormF(context->target_residual, NOX::Abstract::Vector::TwoNorm, NormF::Unscaled)));
  tests->addStatusTest(rcp(new StepTest(context, options.step_tolerance)));
  tests->addStatusTest(rcp(new StagnationTest(context)));
  tests->addStatusTest(rcp(new MaxIters(options.max_iterations)));
  return tests;
}

/// Goes to the minimum of the piece that the last solve ended on, as far as the functional falls on the way there.
/// doc/theory.md (5.4)
/// @return number of steps done, 0 or 1
int predict(NewtonContext &context, Vector &u)
{
  Vector G(u.getMap()), F(u.getMap()), d(u.getMap());
  context.functional.elastic_gradient(u, G);
  context.functional.piece_gradient(u, G, F);
  const auto solved = context.linear_solver.solve(F, d, std::min(0.1, 0.1 * context.target_residual / F.norm2()));
  context.linear_iterations = solved.iterations;
  d.scale(-1.);
  context.functional.gradient(u, F);
  const double step = solved.converged ? exact_step(context.functional.along(u, d, F)) : 0;
  u.update(step, d, 1.);
  return step > 0 ? 1 : 0;
}

/// NOX passes over names that it does not know: they stay unread.
/// @param given  the user's parameters, of which `read` holds copies
void require_read(const Teuchos::ParameterList &given, const Teuchos::ParameterList &read, const std::string &path)
{
  for (auto it = given.begin(); it != given.end(); ++it) {
    const std::string &name = given.name(it);
    if (given.isSublist(name))
      require_read(given.sublist(name), read.sublist(name), path + "->" + name);
    else
      RPC_REQUIRE(read.getEntry(name).isUsed(), "deck: NOX does not know the parameter \""
                                                    << path << "->" << name
                                                    << "\", or does not read it with these settings");
  }
}

/// @throws rpc::Error (bad_input) if NOX refuses the user's parameters
RCP<NOX::Solver::Generic> build_solver(const RCP<NewtonGroup> &group, const NewtonOptions &options,
                                       const RCP<NewtonContext> &context, const RCP<Teuchos::ParameterList> &list)
{
  std::string reason;
  try {
    const auto solver = NOX::Solver::buildSolver(group, status_tests(options, context), list);
    for (const char *name : {"Line Search", "Direction", "Printing", "Solver Options"})
      if (options.nox.isSublist(name))
        require_read(options.nox.sublist(name), list->sublist(name), std::string("NOX->") + name);
    return solver;
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) {
    reason = one_line(failure.what());
  } catch (const char *failure) { // some of NOX's errors are bare strings
    reason = failure;
  }
  throw Error(ExitCode::bad_input, "deck: \"NOX\": " + reason);
}

} // namespace

Teuchos::ParameterList valid_newton_parameters()
{
  Teuchos::ParameterList valid("NOX");
  valid.set("Step Tolerance", 1e-10, "Newton stops at |step|_2/|u|_2 below this, > 0: the paper's test.");
  valid.set("Residual Tolerance", 1e-11, "Newton also stops at |F|_2/|load|_2 below this, > 0.");
  valid.set("Active Set Start", true,
            "Whether an active-set iteration looks for the contact states before the first Newton iteration.");
  valid.set("Maximum Iterations", 200, "Newton steps per Uzawa iteration at most, > 0.");
  for (const char *name : passed_to_nox)
    set_pass_through(valid, name,
                     std::string("Handed to NOX as it is.") +
                         (name == std::string("Line Search")
                              ? " `Method` = `Exact` (default) minimizes the functional along the step exactly; `Full "
                                "Step` and NOX's others work as in NOX."
                          : name == std::string("Direction")
                              ? " `Method` = `Sweep` (default) starts each Newton step with a nonlinear sweep over the "
                                "contact nodes; `Newton` and NOX's others work as in NOX."
                              : ""));
  return valid;
}

NewtonOptions newton_options(const Teuchos::ParameterList &list)
{
  NewtonOptions options;
  options.step_tolerance = list.get<double>("Step Tolerance");
  options.residual_tolerance = list.get<double>("Residual Tolerance");
  // Newton's default is near what rounding leaves; who asks for more gets it.
  const double given = options.residual_tolerance;
  options.start_tolerance = given < 1e-11 ? given : std::max(given, options.start_tolerance);
  options.max_iterations = list.get<int>("Maximum Iterations");
  options.active_set_start = list.get<bool>("Active Set Start");
  RPC_REQUIRE(options.step_tolerance > 0, "deck: \"NOX->Step Tolerance\" must be > 0, got " << options.step_tolerance);
  RPC_REQUIRE(options.residual_tolerance > 0,
              "deck: \"NOX->Residual Tolerance\" must be > 0, got " << options.residual_tolerance);
  RPC_REQUIRE(options.max_iterations > 0,
              "deck: \"NOX->Maximum Iterations\" must be > 0, got " << options.max_iterations);
  for (const char *name : passed_to_nox)
    if (list.isSublist(name) && list.sublist(name).numParams() > 0) options.nox.sublist(name) = list.sublist(name);
  return options;
}

void check_nox_parameters(contact::SmoothedFunctional &functional, LinearSolver &linear_solver, const RCP<Vector> &u,
                          const NewtonOptions &options)
{
  if (options.nox.numParams() == 0) return;
  const auto context = rcp(new NewtonContext{functional, linear_solver});
  const auto reporter = rcp(new Reporter(context, 1, [](const NewtonStep &) {}));
  build_solver(rcp(new NewtonGroup(context, u)), options, context, nox_list(options.nox, reporter));
}

contact::MinimizeResult minimize(contact::SmoothedFunctional &functional, LinearSolver &linear_solver,
                                 const RCP<Vector> &u, const NewtonOptions &options, const bool same_states,
                                 const std::function<void(const NewtonStep &)> &report)
{
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::newton"));
  const double scale = functional.force_scale();
  const auto context = rcp(new NewtonContext{functional, linear_solver, options.residual_tolerance * scale});
  const auto reporter = rcp(new Reporter(context, scale, report));
  const auto list = nox_list(options.nox, reporter);
  const auto group = rcp(new NewtonGroup(context, u));

  contact::MinimizeResult result;
  try {
    group->computeF(); // so that the start is reported with its residual
    if (same_states && group->getNormF() > context->target_residual) {
      result.newton_iterations += predict(*context, *u);
      group->setX(NoxVector(u));
      group->computeF();
    }
    const auto solver = build_solver(group, options, context, list);
    const auto status = solver->solve();
    u->assign(tpetra(solver->getSolutionGroup().getX()));
    result.newton_iterations += solver->getNumIterations();
    result.converged = status == NOX::StatusTest::Converged;
  } catch (const Error &) { // a mistake in the deck
    throw;
  } catch (const std::bad_alloc &) { // on this rank alone
    throw;
  } catch (const std::exception &failure) { // NOX throws when a direction cannot be had; the same on all ranks
    result.reason = one_line(failure.what());
  } catch (const char *failure) { // some of NOX's errors are bare strings
    result.reason = failure;
  }
  if (!result.converged) {
    std::ostringstream reason;
    reason << "Newton did not converge in " << result.newton_iterations
           << (result.newton_iterations == 1 ? " step" : " steps");
    if (!context->failure.empty())
      reason << "; " << context->failure;
    else if (!result.reason.empty())
      reason << "; " << result.reason;
    result.reason = reason.str();
  }
  return result;
}

} // namespace rpc::solver
