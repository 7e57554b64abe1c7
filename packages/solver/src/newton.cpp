#include "rpc/solver/newton.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/message.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/solver/exact_line_search.hpp"
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

// So many steps are ordinary. Each direction takes a vector, and a product with K for each step after that. With five a slender
// body takes 75 steps instead of 53; twenty add nothing.
constexpr int most_earlier_directions = 9;

/// The stopping test of the paper's section 4, |full Newton step| / |u| < tolerance. The full step, not the one that the line search
/// shortened: a short step is no sign of convergence.
class StepTest : public NOX::StatusTest::Generic
{
public:
  StepTest(RCP<NewtonContext> context, const double tolerance) : context_(std::move(context)), tolerance_(tolerance) {}

  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType) override
  {
    status_ = NOX::StatusTest::Unconverged;
    if (solver.getNumIterations() > 0) {
      ratio_ = context_->direction_norm / context_->functional.size(tpetra(solver.getSolutionGroup().getX()));
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

/// Stops where rounding ends Newton's progress: two more full steps on the same piece, and the residual does not fall.
class StagnationTest : public NOX::StatusTest::Generic
{
public:
  explicit StagnationTest(RCP<NewtonContext> context) : context_(std::move(context)) {}

  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType) override
  {
    const auto &group = solver.getSolutionGroup();
    const auto piece = context_->functional.piece(tpetra(group.getX()));
    const bool falls = solver.getNumIterations() == 0 || group.getNormF() < 0.9 * least_residual_;
    const bool same = piece == piece_ && context_->step_length > 0.5;
    idle_steps_ = same && !falls ? idle_steps_ + 1 : 0;
    status_ = idle_steps_ >= 2 ? NOX::StatusTest::Failed : NOX::StatusTest::Unconverged;
    least_residual_ = falls || !same ? group.getNormF() : std::min(least_residual_, group.getNormF());
    piece_ = piece;
    if (status_ == NOX::StatusTest::Failed && context_->failure.empty())
      context_->failure = "the residual stagnates: the scene is too ill-conditioned for this accuracy";
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &out, const int indent) const override
  {
    return out << std::string(indent, ' ') << status_ << "residual falls, or the piece changes\n";
  }

private:
  RCP<NewtonContext> context_;
  double least_residual_ = 0; // since the piece last changed
  std::uint64_t piece_ = 0;
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
  Reporter(RCP<NewtonContext> context, const double scale, NewtonReport report)
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
    report_(step, tpetra(group.getX()));
  }

  RCP<NewtonContext> context_;
  double scale_;
  NewtonReport report_;
};

/// "Direction" -> "Method" of the deck's list for NOX.
std::string direction_method(const Teuchos::ParameterList &nox)
{
  if (!nox.isSublist("Direction")) return "Active Set";
  const Teuchos::ParameterList &direction = nox.sublist("Direction");
  if (!direction.isParameter("Method")) return "Active Set";
  return direction.isType<std::string>("Method") ? direction.get<std::string>("Method") : "";
}

RCP<Teuchos::ParameterList> nox_list(const Teuchos::ParameterList &user,
                                     const RCP<NOX::Abstract::PrePostOperator> &reporter)
{
  const auto list = Teuchos::parameterList("NOX");
  list->set("Nonlinear Solver", "Line Search Based");
  list->sublist("Printing").set("Output Information", 0);
  list->sublist("Printing")
      .set<RCP<std::ostream>>("Output Stream", rcp(new Teuchos::oblackholestream)); // else it warns
  list->sublist("Line Search").set("Method", "Exact");
  list->sublist("Direction").set("Method", "Active Set");
  if (user.isSublist("Printing")) list->remove("Printing");
  list->setParameters(user);
  list->remove("Status Tests", false);
  const std::string method = direction_method(*list);
  const bool own_direction = method == "Active Set" || method == "Sweep";
  Teuchos::ParameterList &search = list->sublist("Line Search");
  if (search.isType<std::string>("Method") && search.get<std::string>("Method") == "Exact") {
    search.set("Method", "User Defined");
    search.set<RCP<NOX::LineSearch::UserDefinedFactory>>(
        "User Defined Line Search Factory",
        rcp(new ExactLineSearchFactory(own_direction ? most_earlier_directions : 0)));
  }
  Teuchos::ParameterList &direction = list->sublist("Direction");
  RCP<NOX::Direction::UserDefinedFactory> factory;
  if (method == "Active Set") factory = rcp(new StagedDirectionFactory);
  if (method == "Sweep") factory = rcp(new SweepDirectionFactory);
  if (!factory.is_null()) {
    direction.set("Method", "User Defined");
    direction.set<RCP<NOX::Direction::UserDefinedFactory>>("User Defined Direction Factory", factory);
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
  const RCP<Combo> newton = rcp(new Combo(Combo::OR));
  newton->addStatusTest(rcp(new NormF(context->target_residual, NOX::Abstract::Vector::TwoNorm, NormF::Unscaled)));
  newton->addStatusTest(rcp(new StepTest(context, options.step_tolerance)));
  newton->addStatusTest(rcp(new StagnationTest(context)));
  tests->addStatusTest(rcp(new StagedTest(context, newton)));
  tests->addStatusTest(rcp(new MaxIters(options.max_iterations)));
  return tests;
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
    pass_on_out_of_memory(failure);
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
  valid.set("Maximum Iterations", 200, "Newton steps per Uzawa iteration at most, > 0.");
  for (const char *name : passed_to_nox)
    set_pass_through(
        valid, name,
        std::string("Handed to NOX as it is.") +
            (name == std::string("Line Search")
                 ? " `Method` = `Exact` (default) minimizes the functional along the step exactly, with `Active Set` "
                   "and `Sweep` from the second step on also within the span of the last ten directions; `Full Step` "
                   "and NOX's others work as in NOX."
             : name == std::string("Direction")
                 ? " `Method` = `Active Set` (default): steps of the primal-dual active-set iteration, then "
                   "those of `Sweep`, Newton's directions, each after a nonlinear sweep over the contact "
                   "nodes. `Newton` and NOX's others work as in NOX."
                 : ""));
  return valid;
}

NewtonOptions newton_options(const Teuchos::ParameterList &list)
{
  NewtonOptions options;
  options.step_tolerance = list.get<double>("Step Tolerance");
  options.residual_tolerance = list.get<double>("Residual Tolerance");
  options.max_iterations = list.get<int>("Maximum Iterations");
  RPC_REQUIRE(options.step_tolerance > 0, "deck: \"NOX->Step Tolerance\" must be > 0, got " << options.step_tolerance);
  RPC_REQUIRE(options.residual_tolerance > 0,
              "deck: \"NOX->Residual Tolerance\" must be > 0, got " << options.residual_tolerance);
  RPC_REQUIRE(options.max_iterations > 0,
              "deck: \"NOX->Maximum Iterations\" must be > 0, got " << options.max_iterations);
  for (const char *name : passed_to_nox)
    if (list.isSublist(name) && list.sublist(name).numParams() > 0) options.nox.sublist(name) = list.sublist(name);
  return options;
}

bool takes_first_stage(const NewtonOptions &options)
{
  return direction_method(options.nox) == "Active Set";
}

void check_nox_parameters(ConvexFunctional &functional, LinearSolver &linear_solver, const RCP<Vector> &u,
                          const NewtonOptions &options)
{
  if (options.nox.numParams() == 0) return;
  const auto context = rcp(new NewtonContext{functional, linear_solver});
  const auto reporter = rcp(new Reporter(context, 1, [](const NewtonStep &, const Vector &) {}));
  build_solver(rcp(new NewtonGroup(context, u)), options, context, nox_list(options.nox, reporter));
}

MinimizeResult minimize(ConvexFunctional &functional, LinearSolver &linear_solver, const RCP<Vector> &u,
                        const double scale, const NewtonOptions &options, FirstStage *const stage,
                        const NewtonReport &report)
{
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::newton"));
  const auto context = rcp(new NewtonContext{functional, linear_solver, options.residual_tolerance * scale});
  if (takes_first_stage(options)) context->stage = stage;
  const auto reporter = rcp(new Reporter(context, scale, report));
  const auto list = nox_list(options.nox, reporter);
  const auto group = rcp(new NewtonGroup(context, u));

  MinimizeResult result;
  try {
    group->computeF(); // so that the start is reported with its residual
    const auto solver = build_solver(group, options, context, list);
    const auto status = solver->solve();
    u->assign(tpetra(solver->getSolutionGroup().getX()));
    result.steps = context->steps > 0 ? context->steps : solver->getNumIterations();
    result.converged = status == NOX::StatusTest::Converged;
  } catch (const Error &) { // a mistake in the deck
    throw;
  } catch (const std::exception &failure) { // NOX throws when a direction cannot be had; the same on all ranks
    pass_on_out_of_memory(failure);
    result.steps = context->steps;
    result.reason = one_line(failure.what());
  } catch (const char *failure) { // some of NOX's errors are bare strings
    result.steps = context->steps;
    result.reason = failure;
  }
  if (!result.converged) {
    std::ostringstream reason;
    reason << "Newton did not converge in " << result.steps << (result.steps == 1 ? " step" : " steps");
    if (!context->failure.empty())
      reason << "; " << context->failure;
    else if (!result.reason.empty())
      reason << "; " << result.reason;
    result.reason = reason.str();
  }
  return result;
}

} // namespace rpc::solver
