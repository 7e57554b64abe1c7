#include "rpc/solver/linear_solver.hpp"

#include "gathered_solver.hpp"
#include "local_correction.hpp"
#include "muelu_parameters.hpp"
#include "multigrid.hpp"
#include "rpc/algebra/bounded_update.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/muelu.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/solver/mesh_multigrid.hpp"

#include <BelosSolverFactory.hpp>
#include <BelosTpetraAdapter.hpp>
#include <Teuchos_StackedTimer.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

namespace rpc::solver
{
namespace
{

// CG iterations after which a stronger preconditioner takes over, and up to how many unknowns that is a factorization.
constexpr int patience = 150;
constexpr GO most_direct_rows = 100000;

// Rows up to which a preconditioner is made anew whenever contact changes: a factor, where it takes no more multiplications than this,
// and else multigrid that is nearly one.
constexpr GO most_rows_set_up_anew = 2500;
constexpr double most_work_of_factor = 1e7;
// Rows up to which even MueLu's hierarchy is a direct solver: coarser meshes would save little there, and CG would leave a rest.
constexpr GO few_rows = 1000;
// Multigrid is made for closed nodes of at most so many times their own stiffness: with all of the penalty, coarse functions
// could not move near them, and CG would take a third more iterations. The rest is left to the correction.   (4.9)
constexpr double most_stiffness = 5;
// Corrections have worn out where they cost a solve of so many digits more CG iterations than a set-up takes the time of. Solves
// of few digits tell little.
constexpr double full_digits = 8, few_digits = 2, setup_in_iterations = 12;
// Set-ups for changed states; then corrections go on until CG runs out of patience.
constexpr int most_setups_for_states = 1;
// CG that breaks down with less of the error left, in energy, has met rounding, not a singular matrix: there most of it is left.
constexpr double small_error = 1e-4;

using LinearProblem = Belos::LinearProblem<double, MultiVector, Operator>;
using SolverManager = Belos::SolverManager<double, MultiVector, Operator>;

/// Thrown through Belos on all ranks; no std::exception, of which Belos would tell the console.
struct Interrupted {
};

/// A multigrid cycle, corrected where contact has changed since it was set up. Now and then it looks whether the run is to
/// stop: the solves of a big scene take minutes.
class Preconditioner : public Operator
{
public:
  explicit Preconditioner(RCP<const Map> map) : map_(std::move(map)) {}

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  /// y <- B x, for x that are 0 on the correction's patch, if there is one; Belos asks for no more.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const override
  {
    constexpr int applications_between = 8; // a sum over all ranks each time
    if (++applications_ % applications_between == 0 && interrupted(*map_->getComm())) throw Interrupted();
    // Belos' CG preconditions a residual before it looks whether the residual is small enough to stop.
    if (enough > 0 && x.getNumVectors() == 1 && x.getVector(0)->norm2() <= enough) return y.assign(x);
    if (!correction) return plain(x, y);
    for (std::size_t k = 0; k < x.getNumVectors(); ++k)
      correction->apply_off_patch(*multigrid, *x.getVector(k), *y.getVectorNonConst(k));
  }
  /// The same for any x, to its end.
  void cycle(const MultiVector &x, MultiVector &y) const
  {
    if (!correction) return plain(x, y);
    for (std::size_t k = 0; k < x.getNumVectors(); ++k)
      correction->apply(*multigrid, *x.getVector(k), *y.getVectorNonConst(k));
  }

  /// Whether there is one that needs no coarser meshes.
  bool is_made() const { return direct || !multigrid.is_null(); }
  /// To be made anew from nothing.
  void forget()
  {
    direct.reset();
    multigrid = Teuchos::null;
  }

  RCP<MeshMultigrid> on_meshes;              ///< null: not used, or to be made
  std::unique_ptr<CoarsestSolver> direct;    ///< of few unknowns; null: not used, or to be made anew
  RCP<Multigrid> multigrid;                  ///< algebraic; null: not used, or to be made anew
  std::optional<LocalCorrection> correction; // of the algebraic one
  double enough = 0; // CG stops at residuals of this norm, which need no preconditioner; 0: not known

private:
  void plain(const MultiVector &x, MultiVector &y) const
  {
    if (!on_meshes.is_null()) return on_meshes->apply(x, y);
    if (!direct) return multigrid->apply(x, y);
    for (std::size_t k = 0; k < x.getNumVectors(); ++k) direct->apply(*x.getVector(k), *y.getVectorNonConst(k));
  }

  RCP<const Map> map_;
  mutable int applications_ = 0;
};

/// Smoothed aggregation with a polynomial smoother, which is the same on every backend and number of ranks.
Teuchos::ParameterList muelu_defaults(const Map &dofs, const int dofs_per_node)
{
  Teuchos::ParameterList list("MueLu");
  list.set("verbosity", "none");
  list.set("problem: symmetric", true);
  list.set("multigrid algorithm", "sa");
  list.set("aggregation: deterministic",
           true); // on threads too, where it costs nothing: 13.2 colors on one thread anyway
  list.set("number of equations", dofs_per_node);
  // An aggregate of few nodes has fewer unknowns than rigid motions: the coarse matrix has rows of zeros.
  list.set("rap: fix zero diagonals", true);
  list.set("smoother: type", "CHEBYSHEV");
  Teuchos::ParameterList &smoother = list.sublist("smoother: params");
  smoother.set("chebyshev: degree", 2);
  smoother.set("chebyshev: ratio eigenvalue", 7.);
  smoother.set("chebyshev: eigenvalue max iterations", 20);
  // On several ranks there is always a level below the finest one, so that what is solved directly has gone to one rank.
  const GO rows = static_cast<GO>(dofs.getGlobalNumElements());
  const bool alone = dofs.getComm()->getSize() == 1;
  constexpr GO most = muelu::has_repartitioning ? few_rows : most_gathered_rows;
  list.set("coarse: max size",
           alone ? static_cast<int>(few_rows) : static_cast<int>(std::clamp<GO>(rows / 4, 1, most)));
  if (muelu::has_repartitioning && !alone) { // the direct coarse solvers of 13.2 are wrong on a distributed matrix
    list.set("repartition: enable", true);
    list.set("repartition: partitioner", "zoltan2");
    list.set("repartition: start level", 1);
    list.set("repartition: min rows per proc", 5000);
    list.set("repartition: max imbalance", 1.3);
    list.set("repartition: rebalance P and R", false); // what reuse of prolongators asks for
    Teuchos::ParameterList &partitioner = list.sublist("repartition: params");
    partitioner.set("algorithm", "multijagged");
  }
  return list;
}

/// MueLu's hierarchy for the order-1 matrix of a mesh that has no coarser one. It is renewed where much of contact has changed.
class AlgebraicSolver : public CoarsestSolver
{
public:
  AlgebraicSolver(const MeshLevel &level, const Teuchos::ParameterList &list)
      : now_(level.stiffness), A_(rcp(new CrsMatrix(*level.stiffness, Teuchos::Copy))), list_(list),
        residual_(rcp(new Vector(A_->getDomainMap()))), correction_(rcp(new Vector(A_->getDomainMap())))
  {
    list_.sublist("user data").set("Coordinates", level.coordinates);
    list_.sublist("user data").set("Nullspace", level.null_space);
    multigrid_ = make_multigrid(A_, list_);
  }
  void update() override
  {
    Kokkos::deep_copy(A_->getLocalMatrixDevice().values, now_->getLocalMatrixDevice().values);
    renew_multigrid(A_, *multigrid_);
  }
  double most_change() const override { return small_change; }
  /// Two cycles: the matrix is small beside that of order 2, and one cycle costs it a third more CG iterations.
  void apply(const Vector &b, Vector &x) const override
  {
    multigrid_->apply(b, x);
    residual_->assign(b);
    A_->apply(x, *residual_, Teuchos::NO_TRANS, -1., 1.);
    multigrid_->apply(*residual_, *correction_);
    x.update(1., *correction_, 1.);
  }

private:
  // By measurement: a renewal takes as long as two CG iterations. While contact has changed less, the old hierarchy costs all solves of
  // a step together about two iterations.
  static constexpr double small_change = 0.1;

  RCP<const CrsMatrix> now_; // follows the states
  RCP<CrsMatrix> A_;         // what the hierarchy was made for
  Teuchos::ParameterList list_;
  RCP<Multigrid> multigrid_;
  RCP<Vector> residual_, correction_;
};

/// Belos refuses values by itself, but passes over names that it does not know.
void check_belos(const std::string &method, const Teuchos::ParameterList &user)
{
  Belos::SolverFactory<double, MultiVector, Operator> factory;
  const auto methods = factory.supportedSolverNames(); // some come twice
  const std::set<std::string> sorted(methods.begin(), methods.end());
  RPC_REQUIRE(factory.isSupported(method), "deck: \"Linear Solver->Method\" must be one that Belos knows, got \""
                                               << method << "\". It knows: " << join({sorted.begin(), sorted.end()}));
  try {
    const auto list = Teuchos::parameterList("Linear Solver->Belos");
    list->setParameters(user);
    require_known(user, names_of(*factory.create(method, list)->getValidParameters()), "Linear Solver->Belos");
    RPC_REQUIRE(!user.isParameter("Convergence Tolerance"),
                "deck: \"Linear Solver->Belos->Convergence Tolerance\" is set by rpc for each solve; give the bound as "
                "\"Linear Solver->Tolerance\"");
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) {
    throw Error(ExitCode::bad_input, "deck: \"Linear Solver->Belos\": " + one_line(failure.what()));
  }
}

} // namespace

struct LinearSolver::Impl {
  RCP<UpdatedOperator> H;
  RCP<CrsMatrix> matrix;          // what algebraic preconditioners are made for; null: none was made yet
  DeviceView<double ***> written; // (nodes of H, dim, dim) the update in it
  RCP<MultiVector> coordinates, null_space;
  Teuchos::ParameterList muelu;
  MakeMeshLevels make_levels;       // null: the hierarchy is algebraic
  bool made_for_each_state = false; // the preconditioner of few unknowns, anew for each choice of contact states
  bool singular = false;            // a matrix was met that neither hierarchy can solve for
  RCP<Preconditioner> preconditioner;
  int revision = -1;               // of H, that the preconditioner fits
  bool renewed = false;            // of an older hierarchy some parts are left
  double usual_iterations = 0;     // per digit, right after a set-up
  double iterations_per_digit = 0; // of the last solve
  bool fresh = false;              // no states have changed since multigrid was set up
  bool worn = false;               // corrections do not suffice any more
  int setups_for_states = 0;
  bool strengthened = false;
  bool stops_by_residual = false; // Belos' CG, at |r| <= tolerance |b|
  RCP<LinearProblem> problem;
  RCP<SolverManager> manager;
};

Teuchos::ParameterList valid_linear_solver_parameters()
{
  Teuchos::ParameterList valid("Linear Solver");
  valid.set("Method", LinearSolverOptions().method,
            "Krylov method by its name in Belos; the matrix is symmetric positive definite.");
  valid.set("Tolerance", 1e-11, "|r|/|b| of a linear solve at least, in (0, 1): most need not be as good.");
  valid.set("Maximum Iterations", 500, "of a linear solve, > 0.");
  valid.set(
      "Multigrid", "auto",
      "`mesh`: on coarser meshes of the same body, where there are some: of order 1 for order 2, and coarser boxes; "
      "`algebraic`: by MueLu from the matrix; `auto`: `mesh` unless `MueLu` is given.");
  valid.set("Reuse", "tP",
            "What of an algebraic hierarchy survives a change of contact states: `none`, `tP` (aggregates and "
            "tentative prolongator), `RP` (transfer operators).");
  set_pass_through(valid, "Belos", "Handed to Belos as it is.");
  set_pass_through(
      valid, "MueLu",
      "Handed to MueLu as it is, on top of smoothed aggregation with Chebyshev smoothing. Where CG takes more "
      "than 150 iterations, a factorization takes over on one rank up to 100000 unknowns, else a stronger "
      "smoother, unless the coarse size or the smoother are given here.");
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

LinearSolver::LinearSolver(LinearSolverOptions options, const RCP<UpdatedOperator> &H,
                           const RCP<MultiVector> &coordinates, const RCP<MultiVector> &null_space,
                           MakeMeshLevels levels)
    : options_(std::move(options)), impl_(std::make_unique<Impl>())
{
  impl_->H = H;
  impl_->muelu = muelu_defaults(*H->getDomainMap(), static_cast<int>(coordinates->getNumVectors()));
  impl_->muelu.set("reuse: type", options_.reuse);
  impl_->muelu.set("sa: damping factor", options_.damping);
  if (options_.muelu.isParameter("smoother: type")) impl_->muelu.remove("smoother: params"); // of another type
  impl_->muelu.setParameters(options_.muelu);
  impl_->coordinates = coordinates;
  impl_->null_space = null_space;
  const GO unknowns = static_cast<GO>(H->getDomainMap()->getGlobalNumElements());
  impl_->made_for_each_state = unknowns <= most_rows_set_up_anew;
  const bool automatic = unknowns > few_rows && options_.muelu.numParams() == 0;
  if (options_.multigrid == "mesh" || (options_.multigrid == "auto" && automatic))
    impl_->make_levels = std::move(levels);

  const auto belos = Teuchos::parameterList("Belos");
  belos->set("Verbosity", static_cast<int>(Belos::Errors));
  belos->set("Maximum Iterations", options_.max_iterations);
  belos->setParameters(options_.belos);
  impl_->stops_by_residual = options_.belos.numParams() == 0 && options_.method == LinearSolverOptions().method;
  impl_->preconditioner = rcp(new Preconditioner(H->getDomainMap()));
  impl_->problem = rcp(new LinearProblem(H, Teuchos::null, Teuchos::null));
  impl_->problem->setRightPrec(impl_->preconditioner);
  impl_->manager = Belos::SolverFactory<double, MultiVector, Operator>().create(options_.method, belos);
  impl_->manager->setProblem(impl_->problem);
}

LinearSolver::~LinearSolver() = default;

const MultiVector &LinearSolver::coordinates() const
{
  return *impl_->coordinates;
}

void LinearSolver::set_up()
{
  RCP<Multigrid> &multigrid = impl_->preconditioner->multigrid;
  const UpdatedOperator &H = *impl_->H;
  RCP<CrsMatrix> &A = impl_->matrix;
  if (A.is_null()) A = H.base().copy();
  const auto write = [&](const DeviceView<double ***> &update) {
    impl_->written = update;
    write_update(*A, H, update);
  };
  auto &correction = impl_->preconditioner->correction;
  correction.reset();
  if (!impl_->made_for_each_state) {
    write(bounded_update(H, most_stiffness));
    correction = LocalCorrection::around(H, *A, impl_->written);
  }
  if (!correction) write(bounded_update(H));
  if (factor(A)) return;
  impl_->renewed = !multigrid.is_null() && impl_->muelu.get<std::string>("reuse: type") != "none" && renew(A);
  if (!impl_->renewed) {
    Teuchos::ParameterList list = impl_->muelu;
    list.sublist("user data").set("Coordinates", impl_->coordinates);
    list.sublist("user data").set("Nullspace", impl_->null_space);
    multigrid = Teuchos::null; // two hierarchies would take twice the memory
    try {
      multigrid = make_multigrid(A, list);
    } catch (const std::exception &failure) {
      if (options_.muelu.numParams() == 0 || counts_.preconditioner_setups > 0) throw;
      throw Error(ExitCode::bad_input, "deck: \"Linear Solver->MueLu\": " + one_line(failure.what()));
    }
  }
  made_anew();
}

void LinearSolver::made_anew()
{
  impl_->worn = false;
  impl_->fresh = true;
  ++counts_.preconditioner_setups;
}

/// Few unknowns are factored, unless the deck says how to solve for them.
/// @return whether that could be done
bool LinearSolver::factor(const RCP<CrsMatrix> &A)
{
  auto &direct = impl_->preconditioner->direct;
  direct.reset();
  const bool asked_otherwise = options_.multigrid != "auto" || options_.muelu.numParams() > 0;
  if (!impl_->made_for_each_state || asked_otherwise || impl_->strengthened) return false;
  direct = direct_solver(A, most_work_of_factor);
  if (direct) made_anew();
  return direct != nullptr;
}

/// @return whether the old hierarchy could be used again; MueLu leaves it half-cleared where it fails
bool LinearSolver::renew(const RCP<CrsMatrix> &A)
{
  RCP<Multigrid> &multigrid = impl_->preconditioner->multigrid;
  try {
    renew_multigrid(A, *multigrid);
    return true;
  } catch (const std::bad_alloc &) { // on this rank alone
    throw;
  } catch (
      const std::exception &) { // such as reused prolongators that do not fit a pattern without its zeros; on all ranks
    multigrid = Teuchos::null;
    return false;
  }
}

void LinearSolver::prepare_on_meshes()
{
  RCP<MeshMultigrid> &multigrid = impl_->preconditioner->on_meshes;
  const int revision = impl_->H->revision();
  if (!multigrid.is_null() && revision == impl_->revision) return;
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::preconditioner"));
  const double start = Teuchos::Time::wallTime();
  if (multigrid.is_null()) {
    const MeshLevels levels = impl_->make_levels();
    if (levels.level.empty()) throw std::runtime_error("multigrid: a coarser mesh would be too small for the ranks");
    impl_->H->allow_rounding(true);
    multigrid =
        rcp(new MeshMultigrid(impl_->H, levels, [&](const MeshLevel &coarsest) -> std::unique_ptr<CoarsestSolver> {
          if (levels.down_to_few) return direct_solver(coarsest.stiffness);
          Teuchos::ParameterList list = muelu_defaults(*coarsest.stiffness->getDomainMap(), impl_->H->dofs_per_node());
          list.set("reuse: type", options_.reuse == "none" ? "tP" : options_.reuse);
          list.setParameters(options_.muelu);
          return std::make_unique<AlgebraicSolver>(coarsest, list);
        }));
    ++counts_.preconditioner_setups;
  } else {
    multigrid->update();
    ++counts_.local_corrections;
  }
  impl_->revision = revision;
  counts_.setup_seconds += Teuchos::Time::wallTime() - start;
}

void LinearSolver::prepare()
{
  if (impl_->make_levels) return prepare_on_meshes();
  const int revision = impl_->H->revision();
  const bool exists = impl_->preconditioner->is_made();
  if (exists && revision == impl_->revision) return;
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::preconditioner"));
  const double start = Teuchos::Time::wallTime();
  auto &correction = impl_->preconditioner->correction;
  bool fits = false;
  if (exists && !impl_->worn && !impl_->made_for_each_state) {
    correction = LocalCorrection::around(*impl_->H, *impl_->matrix, impl_->written);
    counts_.local_corrections += correction.has_value();
    fits = correction || num_changes(*impl_->H, impl_->written) == 0;
    impl_->fresh = false;
  }
  if (!fits) {
    impl_->setups_for_states += exists;
    set_up();
  }
  impl_->revision = revision;
  counts_.setup_seconds += Teuchos::Time::wallTime() - start;
}

double LinearSolver::inverse_energy(const Vector &F)
{
  if (!(F.norm2() > 0)) return 0;
  try {
    prepare();
    Vector x(F.getMap());
    impl_->preconditioner->cycle(F, x);
    return F.dot(x);
  } catch (const Error &) {
    throw;
  } catch (const std::bad_alloc &) { // on this rank alone
    throw;
  } catch (const std::exception &) { // a breakdown, such as a singular coarse matrix; the same on all ranks
    return std::numeric_limits<double>::quiet_NaN();
  }
}

void LinearSolver::judge_preconditioner(const int iterations, const double residual)
{
  const double digits = -std::log10(residual);
  if (!(digits > few_digits)) return;
  impl_->iterations_per_digit = iterations / digits;
  if (impl_->fresh)
    impl_->usual_iterations = impl_->iterations_per_digit;
  else
    impl_->worn = impl_->setups_for_states < most_setups_for_states && excess(full_digits) > setup_in_iterations;
}

/// For nearly incompressible or badly shaped cells, where aggregation misses slow modes: at most once, and not against what
/// the deck asks for.
bool LinearSolver::strengthen()
{
  for (const char *name : {"coarse: max size", "smoother: type", "smoother: params"})
    if (options_.muelu.isParameter(name)) return false;
  if (std::exchange(impl_->strengthened, true)) return false;
  const GO rows = static_cast<GO>(impl_->H->getDomainMap()->getGlobalNumElements());
  if (impl_->H->getDomainMap()->getComm()->getSize() == 1 && rows <= most_direct_rows) {
    impl_->muelu.set("coarse: max size", static_cast<int>(rows) + 1);
    impl_->muelu.set("reuse: type", "none");
  } else {
    Teuchos::ParameterList &smoother = impl_->muelu.sublist("smoother: params");
    smoother.set("chebyshev: degree", 8);
    smoother.set("chebyshev: ratio eigenvalue", 50.);
  }
  impl_->preconditioner->forget();
  return true;
}

/// CG iterations that a solve of so many digits would save right after a set-up.
double LinearSolver::excess(const double digits) const
{
  return impl_->usual_iterations > 0 ? (impl_->iterations_per_digit - impl_->usual_iterations) * digits : 0;
}

/// Corrections that have worn out make way for a set-up where it pays for the digits that are asked for.
void LinearSolver::set_up_if_worn(const double tolerance)
{
  if (!impl_->worn) return;
  if (excess(-std::log10(std::max(tolerance, options_.tolerance))) > setup_in_iterations) impl_->revision = -1;
}

LinearSolver::Result LinearSolver::solve(const Vector &b, Vector &x, const double tolerance)
{
  return impl_->make_levels ? solve_by_meshes(b, x, tolerance) : solve_algebraically(b, x, tolerance);
}

/// Where multigrid on meshes fails, the algebraic one has a try. It takes over if it does better.
LinearSolver::Result LinearSolver::solve_by_meshes(const Vector &b, Vector &x, const double tolerance)
{
  const Result result = try_to_solve(b, x, tolerance);
  const bool good = result.converged && result.iterations <= patience;
  if (good || result.interrupted || (result.broken && impl_->singular)) return result;
  const MakeMeshLevels levels = std::exchange(impl_->make_levels, {});
  impl_->preconditioner->on_meshes = Teuchos::null;
  impl_->H->allow_rounding(false);
  impl_->revision = -1;
  counts_.fallback = result.converged ? std::to_string(result.iterations) + " CG iterations" : result.reason;
  if (result.converged) return result;
  const Result other = solve_algebraically(b, x, tolerance);
  if (other.broken && !other.interrupted) { // it is not the hierarchy: an active set leaves the body unheld
    impl_->singular = true;
    impl_->preconditioner->forget();
    impl_->preconditioner->correction.reset();
    impl_->make_levels = levels;
    impl_->revision = -1;
    counts_.fallback.clear();
  }
  return other;
}

LinearSolver::Result LinearSolver::solve_algebraically(const Vector &b, Vector &x, const double tolerance)
{
  set_up_if_worn(tolerance);
  Result result = try_to_solve(b, x, tolerance);
  const auto good = [&result] { return result.interrupted || (result.converged && result.iterations <= patience); };
  if (good()) return result;
  if (!impl_->fresh || impl_->renewed) { // a hierarchy for these states, from scratch, before anything else is blamed
    impl_->preconditioner->forget();
    if (result.converged) return result;
    result = try_to_solve(b, x, tolerance);
    if (good()) return result;
  }
  if (result.broken || !strengthen() || result.converged) return result;
  return try_to_solve(b, x, tolerance);
}

/// |x - H^-1 b|_H / |H^-1 b|_H; one cycle stands for H^-1. NaN where the cycle breaks down; collective.
/// @param residual  b - H x
double LinearSolver::energy_error(const Vector &b, const Vector &residual)
{
  return std::sqrt(inverse_energy(residual) / inverse_energy(b));
}

/// CG from x = 0. A breakdown is a result, with x as far as it came.
LinearSolver::Result LinearSolver::iterate(const Vector &b, Vector &x, const double tolerance)
{
  Result result;
  // What a solve on the patch leaves of b is 0 there, and so are all residuals that follow.                      (4.8)
  const auto &correction = impl_->preconditioner->correction;
  RCP<const Vector> rest = Teuchos::rcpFromRef(b);
  RCP<Vector> on_patch;
  double left = 1; // |rest|/|b|
  if (correction) {
    on_patch = rcp(new Vector(b.getMap()));
    const auto off_patch = rcp(new Vector(b.getMap()));
    correction->solve_on_patch(b, *on_patch, *off_patch);
    left = off_patch->norm2() / b.norm2();
    rest = off_patch;
  }
  const auto list = Teuchos::parameterList();
  list->set("Convergence Tolerance", std::min(1., std::max(tolerance, options_.tolerance) / left));
  impl_->manager->setParameters(list);
  constexpr double surely = 1 - 1e-12; // Belos divides by |rest|
  impl_->preconditioner->enough =
      impl_->stops_by_residual ? surely * list->get<double>("Convergence Tolerance") * rest->norm2() : 0;
  x.putScalar(0);
  impl_->problem->setProblem(Teuchos::rcpFromRef<MultiVector>(x), RCP<const MultiVector>(rest));
  try {
    result.converged = impl_->manager->solve() == Belos::Converged;
    result.iterations = impl_->manager->getNumIters();
    const double residual = left * impl_->manager->achievedTol();
    if (!impl_->make_levels) judge_preconditioner(result.iterations, residual);
    if (!result.converged)
      result.reason = "the linear solver stopped at |r|/|b| = " + std::to_string(residual) + " after " +
                      std::to_string(result.iterations) + " iterations";
  } catch (const std::bad_alloc &) { // on this rank alone
    throw;
  } catch (const std::exception &failure) { // such as an indefinite or singular matrix; the same on all ranks
    result.broken = true;                   // how many iterations there were is not to be had
    result.reason = "the linear solver broke down: " + one_line(failure.what());
  }
  if (correction) x.update(1., *on_patch, 1.);
  return result;
}

/// CG breaks down, too, where rounding is all that it has left to work on: of a small remainder on the patch, where its
/// preconditioner expects zeros. What is left then is solved for once more, from the residual as it is.          (4.9a)
LinearSolver::Result LinearSolver::iterate_to_the_end(const Vector &b, Vector &x, const double tolerance)
{
  Result result = iterate(b, x, tolerance);
  if (!result.broken || !std::isfinite(x.norm2())) return result;
  Vector residual(b, Teuchos::Copy);
  impl_->H->apply(x, residual, Teuchos::NO_TRANS, -1., 1.);
  if (!(energy_error(b, residual) <= small_error)) return result;
  Vector move(b.getMap());
  const Result more = iterate(residual, move, tolerance * b.norm2() / residual.norm2());
  result.broken = false;
  result.converged = more.converged;
  result.iterations += more.iterations;
  if (more.converged) {
    x.update(1., move, 1.);
    result.reason.clear();
  }
  return result;
}

LinearSolver::Result LinearSolver::try_to_solve(const Vector &b, Vector &x, const double tolerance)
{
  Result result;
  try {
    if (interrupted(*impl_->H->getDomainMap()->getComm())) throw Interrupted();
    prepare();
    const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::krylov"));
    const double start = Teuchos::Time::wallTime();
    result = iterate_to_the_end(b, x, tolerance);
    counts_.iterations.push_back(result.iterations);
    counts_.solve_seconds += Teuchos::Time::wallTime() - start;
    if (!result.broken && !std::isfinite(x.norm2())) {
      result.converged = false;
      result.broken = true;
      result.reason = describe_not_finite("the solution of linear solve " + std::to_string(counts_.iterations.size()),
                                          x, *impl_->coordinates);
    }
  } catch (const Interrupted &) {
    result.broken = result.interrupted = true;
    result.reason = interruption();
  } catch (const Error &) {
    throw;
  } catch (const std::bad_alloc &) { // on this rank alone
    throw;
  } catch (const std::exception &failure) { // of a set-up, such as a singular matrix; the same on all ranks
    counts_.iterations.push_back(0);
    result.broken = true;
    result.reason = "the linear solver broke down: " + one_line(failure.what());
  }
  return result;
}

} // namespace rpc::solver
