// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/newton.hpp"

#include "newton/nox_line_search.hpp"
#include "newton/status_tests.hpp"
#include "rpc/core/causes.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/message.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/solver/exact_line_search.hpp"
#include "rpc/solver/rules.hpp"
#include "rpc/solver/sweep_direction.hpp"

#include <NOX.H>
#include <NOX_Abstract_PrePostOperator.H>
#include <NOX_Solver_LineSearchBased.H>
#include <Teuchos_TimeMonitor.hpp>
#include <Teuchos_oblackholestream.hpp>
#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

namespace rpc::solver
{
namespace
{

/// Methods that a deck may choose. NOX's other directions need the transpose or the inverse of a Jacobian, or converge slowly
/// without a preconditioner; its other line searches need vectors, which no deck has.
constexpr std::array directions{"Active Set", "Sweep", "Newton"};
constexpr std::array line_searches{"Exact", "Full Step", "Backtrack", "Polynomial", "More'-Thuente", "NonlinearCG"};

constexpr const char *passed_to_nox[] = {"Line Search", "Direction", "Printing", "Solver Options", "Status Tests"};

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

/// "Method" of the deck's list `name` for NOX, as text; the first of `methods` is the default.
template <std::size_t N>
std::string method_of(const Teuchos::ParameterList &nox, const char *const name,
                      const std::array<const char *, N> &methods)
{
  if (!nox.isSublist(name) || !nox.sublist(name).isParameter("Method")) return methods[0];
  return Teuchos::toString(nox.sublist(name).getEntry("Method").getAny(false));
}

/// @throws rpc::Error (bad_input) if a method of the deck cannot be used
template <std::size_t N>
void require_method(const Teuchos::ParameterList &nox, const char *const name,
                    const std::array<const char *, N> &methods, const char *const why)
{
  const std::string method = method_of(nox, name, methods);
  if (std::find(methods.begin(), methods.end(), method) != methods.end()) return;
  std::ostringstream given;
  nox.sublist(name).getEntry("Method").leftshift(given, false);
  throw Error(ExitCode::bad_input, "deck: \"NOX->" + std::string(name) + "->Method\" must be one of " +
                                       join(std::vector<std::string>(methods.begin(), methods.end())) + ", got \"" +
                                       given.str() + "\": " + why);
}

/// What NOX is given.
struct NoxLists {
  RCP<Teuchos::ParameterList> all, line_search; ///< that is read from the latter
};

NoxLists nox_lists(const Teuchos::ParameterList &user, const RCP<NOX::Abstract::PrePostOperator> &reporter)
{
  const auto list = Teuchos::parameterList("NOX");
  list->set("Nonlinear Solver", "Line Search Based");
  list->sublist("Printing").set("Output Information", 0);
  list->sublist("Printing")
      .set<RCP<std::ostream>>("Output Stream", rcp(new Teuchos::oblackholestream)); // else it warns
  list->sublist("Line Search").set("Method", line_searches[0]);
  list->sublist("Direction").set("Method", directions[0]);
  if (user.isSublist("Printing")) list->remove("Printing");
  list->setParameters(user);
  list->remove("Status Tests", false);
  const std::string method = method_of(*list, "Direction", directions);
  const bool own_direction = method != "Newton";
  const auto read = Teuchos::parameterList(list->sublist("Line Search"));
  RCP<NOX::LineSearch::UserDefinedFactory> search = rcp(new NoxLineSearchFactory(read));
  if (method_of(*list, "Line Search", line_searches) == "Exact")
    search = rcp(new ExactLineSearchFactory(own_direction ? newton_rules.most_earlier_directions : 0));
  list->sublist("Line Search").set("Method", "User Defined");
  list->sublist("Line Search")
      .set<RCP<NOX::LineSearch::UserDefinedFactory>>("User Defined Line Search Factory", search);
  Teuchos::ParameterList &direction = list->sublist("Direction");
  if (own_direction) {
    const RCP<NOX::Direction::UserDefinedFactory> factory = rcp(new SweepDirectionFactory);
    direction.set("Method", "User Defined");
    direction.set<RCP<NOX::Direction::UserDefinedFactory>>("User Defined Direction Factory", factory);
  }
  list->sublist("Solver Options").set("User Defined Pre/Post Operator", reporter);
  list->sublist("Solver Options")
      .set<RCP<NOX::MeritFunction::Generic>>("User Defined Merit Function", rcp(new FunctionalMerit));
  return {list, read};
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

/// NOX for a group, with the tests that it has.
struct Nox {
  RCP<NOX::Solver::Generic> solver;
  RCP<NOX::StatusTest::Generic> tests;
};

/// @throws rpc::Error (bad_input) if NOX refuses the user's parameters
Nox build_solver(const RCP<NewtonGroup> &group, const NewtonOptions &options, const NoxLists &lists)
{
  std::string reason;
  try {
    const auto tests = status_tests(options);
    const auto solver = NOX::Solver::buildSolver(group, tests, lists.all);
    for (const char *name : {"Line Search", "Direction", "Printing", "Solver Options"}) {
      const bool searches = name == std::string("Line Search");
      if (options.nox.isSublist(name))
        require_read(options.nox.sublist(name), searches ? *lists.line_search : lists.all->sublist(name),
                     std::string("NOX->") + name);
    }
    return {solver, tests};
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

/// What has failed, by the table of causes.
std::string why(const NewtonContext &context, const NewtonOptions &options, const Teuchos::ParameterList &search)
{
  const std::string method = method_of(options.nox, "Line Search", line_searches);
  std::ostringstream figures;
  figures << "\"NOX->Line Search->Method\" = " << method;
  if (context.failed_searches > 0) {
    figures << ", in " << context.failed_searches << " of " << context.searches << " searches";
    const Teuchos::ParameterList none;
    const Teuchos::ParameterList &read = search.isSublist(method) ? search.sublist(method) : none;
    for (const char *const name : {"Minimum Step", "Recovery Step"})
      if (read.isType<double>(name)) figures << ", " << name << " " << read.get<double>(name);
    return because(causes::no_lower_step, figures.str());
  }
  if (method != "Exact" && context.returns > 0) {
    figures << ", " << context.returns << " returns";
    return because(causes::circles, figures.str());
  }
  if (context.stagnates) return because(causes::stagnation);
  return because(options.nox.isSublist("Status Tests") ? causes::status_tests : causes::newton_steps);
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
                   "and `Sweep` from the second step on also within the span of the last ten directions. `Full Step`, "
                   "`Backtrack`, `Polynomial`, `More'-Thuente` and `NonlinearCG` are NOX's; what they lower is the "
                   "functional. Steps of the active set are full."
             : name == std::string("Direction")
                 ? " `Method` = `Active Set` (default): steps of the primal-dual active-set iteration, then "
                   "those of `Sweep`, Newton's directions, each after a nonlinear sweep over the contact "
                   "nodes. `Newton` works as in NOX; NOX's others cannot be used."
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
  require_method(list, "Direction", directions,
                 "NOX's other methods need the transpose or the inverse of a Jacobian, or do not get far without one");
  require_method(list, "Line Search", line_searches,
                 "NOX's other line searches need a vector, which a deck cannot give");
  for (const char *name : passed_to_nox)
    if (list.isSublist(name) && list.sublist(name).numParams() > 0) options.nox.sublist(name) = list.sublist(name);
  return options;
}

bool takes_loop(const NewtonOptions &options)
{
  return method_of(options.nox, "Direction", directions) == "Active Set";
}

void check_nox_parameters(ConvexFunctional &functional, LinearSolver &linear_solver, const RCP<Vector> &u,
                          const NewtonOptions &options)
{
  if (options.nox.numParams() == 0) return;
  const auto context = rcp(new NewtonContext{functional, linear_solver});
  const auto reporter = rcp(new Reporter(context, 1, [](const NewtonStep &, const Vector &) {}));
  build_solver(rcp(new NewtonGroup(context, u)), options, nox_lists(options.nox, reporter));
}

MinimizeResult minimize(ConvexFunctional &functional, LinearSolver &linear_solver, const RCP<Vector> &u,
                        const double scale, const NewtonOptions &options, const MinimizationLoop &loop,
                        const NewtonReport &report)
{
  using Status = MinimizationSteps::Status;
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::newton"));
  const auto context = rcp(new NewtonContext{functional, linear_solver, options.residual_tolerance * scale});
  const auto reporter = rcp(new Reporter(context, scale, report));
  const auto lists = nox_lists(options.nox, reporter);
  const auto group = rcp(new NewtonGroup(context, u));

  MinimizeResult result;
  try {
    group->computeF(); // so that the start is reported with its residual
    const auto [solver, tests] = build_solver(group, options, lists);
    reporter->runPreSolve(*solver);
    MinimizationSteps steps(group, solver, newton_tests(options, context), options.max_iterations);
    auto status = MinimizationSteps::status_of(tests->checkStatus(*solver, NOX::StatusTest::Minimal));
    if (status == Status::goes_on)
      status = loop && takes_loop(options) ? loop(steps) : steps.newton_to_end(steps.newton_begins());
    if (!steps.stepped()) reporter->runPostIterate(*solver);
    u->assign(tpetra(group->getX()));
    result.steps = context->steps > 0 ? context->steps : solver->getNumIterations();
    result.converged = status == Status::converged;
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
  result.newton_steps = context->newton_steps;
  if (!result.converged) {
    std::ostringstream reason;
    reason << "Newton did not converge in " << result.steps << (result.steps == 1 ? " step" : " steps");
    for (const std::string &cause : {context->failure, result.reason, why(*context, options, *lists.line_search)})
      if (!cause.empty()) {
        reason << "; " << cause;
        break;
      }
    result.reason = reason.str();
  }
  return result;
}

} // namespace rpc::solver
