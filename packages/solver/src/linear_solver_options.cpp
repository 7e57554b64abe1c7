// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/linear_solver_options.hpp"

#include "krylov/belos_method.hpp"
#include "multigrid/muelu_parameters.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/tpetra.hpp"

#include <BelosSolverFactory.hpp>
#include <BelosTpetraAdapter.hpp>
#include <set>
#include <vector>

namespace rpc::solver
{
namespace
{

constexpr const char *convergence_tolerance = "Convergence Tolerance";

/// Whether a method can be told when a solve is good enough.
bool takes_tolerance(const std::string &method)
{
  try {
    return belos_parameters(method)->isParameter(convergence_tolerance);
  } catch (const std::exception &) { // Belos names some that it has not got
    return false;
  }
}

/// The methods of Belos that can be told when a solve is good enough, for messages.
std::string usable_methods(const Belos::SolverFactory<double, MultiVector, Operator> &factory)
{
  std::set<std::string> usable; // some are named twice
  for (const std::string &method : factory.supportedSolverNames())
    if (takes_tolerance(method)) usable.insert(method);
  return join({usable.begin(), usable.end()});
}

/// Belos refuses values by itself, but passes over names that it does not know. Of a method that needs symmetry GMRES may take the place,
/// and takes what it knows of the list.
void check_belos(const std::string &method, const Teuchos::ParameterList &user)
{
  Belos::SolverFactory<double, MultiVector, Operator> factory;
  RPC_REQUIRE(factory.isSupported(method), "deck: \"Linear Solver->Method\" must be one that Belos knows, got \""
                                               << method << "\". It knows: " << usable_methods(factory));
  RPC_REQUIRE(takes_tolerance(method), "deck: \"Linear Solver->Method\" cannot be \""
                                           << method
                                           << "\": Belos gives this method no bound on the residual. It must be one of "
                                           << usable_methods(factory));
  try {
    std::vector<std::string> takers{method};
    if (needs_symmetry(method)) takers.emplace_back(gmres);
    std::set<std::string> known;
    for (const std::string &taker : takers)
      for (const std::string &name : names_of(*belos_parameters(taker))) known.insert(name);
    require_known(user, {known.begin(), known.end()}, "Linear Solver->Belos");
    for (const std::string &taker : takers) {
      const auto list = Teuchos::parameterList("Linear Solver->Belos");
      list->setParameters(entries_for(taker, user));
      factory.create(taker, list);
    }
    RPC_REQUIRE(!user.isParameter(convergence_tolerance),
                "deck: \"Linear Solver->Belos->Convergence Tolerance\" is set by rpc for each solve; give the bound as "
                "\"Linear Solver->Tolerance\"");
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) {
    throw Error(ExitCode::bad_input, "deck: \"Linear Solver->Belos\": " + one_line(failure.what()));
  }
}

} // namespace

Teuchos::ParameterList valid_linear_solver_parameters()
{
  Teuchos::ParameterList valid("Linear Solver");
  valid.set("Method", LinearSolverOptions().method,
            "Krylov method by its name in Belos; the matrix is symmetric positive definite. With friction it is not: "
            "then `Block GMRES` takes the place of methods that need that.");
  valid.set("Tolerance", 1e-11, "|r|/|b| of a linear solve at least, in (0, 1): most need not be as good.");
  valid.set("Maximum Iterations", 500, "of a linear solve, > 0.");
  set_words(
      valid, "Multigrid", {"auto", "mesh", "algebraic"},
      "`mesh`: on coarser meshes of the same body, where there are some: of order 1 for order 2, coarser boxes, "
      "and those "
      "that a mesh was refined from; "
      "`algebraic`: by MueLu from the matrix; `auto`: `mesh` unless `MueLu` is given. With `mesh` and `auto` nearly "
      "incompressible bodies of order 2, and of Q1, have pressures as unknowns of their own, and BiCGStab (theory, "
      "4.14).");
  set_words(valid, "Reuse", {"tP", "none", "RP"},
            "What of an algebraic hierarchy survives a change of contact states: `none`, `tP` (aggregates and "
            "tentative prolongator), `RP` (transfer operators).");
  set_pass_through(valid, "Belos",
                   "Handed to Belos: to `Method`, and with friction to the GMRES in its place, to each what it knows. "
                   "`Num Blocks` iterations of GMRES keep two vectors each, one with `Flexible Gmres` = `false`, which "
                   "takes two products with the preconditioner more for each solve.");
  set_pass_through(
      valid, "MueLu",
      "Handed to MueLu as it is, on top of smoothed aggregation with Chebyshev smoothing. Without it, a "
      "sparse factor takes over "
      "where that takes less time than the CG iterations that are left. Where there is none, and CG fails, "
      "the smoother becomes stronger, unless the coarse size or the smoother are given here.");
  return valid;
}

LinearSolverOptions linear_solver_options(const Teuchos::ParameterList &list)
{
  LinearSolverOptions options;
  options.method = list.get<std::string>("Method");
  options.tolerance = list.get<double>("Tolerance");
  options.max_iterations = list.get<int>("Maximum Iterations");
  options.multigrid = list.get<std::string>("Multigrid");
  options.reuse = list.get<std::string>("Reuse");
  options.belos = list.sublist("Belos");
  options.muelu = list.sublist("MueLu");
  RPC_REQUIRE(options.tolerance > 0 && options.tolerance < 1,
              "deck: \"Linear Solver->Tolerance\" must be in (0, 1), got " << options.tolerance);
  RPC_REQUIRE(options.max_iterations > 0,
              "deck: \"Linear Solver->Maximum Iterations\" must be > 0, got " << options.max_iterations);
  RPC_REQUIRE(options.multigrid == "auto" || options.multigrid == "mesh" || options.multigrid == "algebraic",
              "deck: \"Linear Solver->Multigrid\" must be one of auto, mesh, algebraic, got \"" << options.multigrid
                                                                                                << "\"");
  RPC_REQUIRE(options.reuse == "none" || options.reuse == "tP" || options.reuse == "RP",
              "deck: \"Linear Solver->Reuse\" must be one of none, tP, RP, got \"" << options.reuse << "\"");
  check_belos(options.method, options.belos);
  check_muelu_parameters(options.muelu, "Linear Solver->MueLu");
  return options;
}

} // namespace rpc::solver
