// SPDX-License-Identifier: BSD-3-Clause
#include "krylov/krylov.hpp"

#include "krylov/belos_method.hpp"
#include "krylov/convergence.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/message.hpp"
#include "rpc/solver/rules.hpp"

#include <BelosTypes.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::solver
{
namespace
{

/// Thrown through Belos where an iteration is given up.
struct GivenUp {
};

/// The same where the error is small enough.
struct Enough {
};

/// |x - H^-1 b|_H / |H^-1 b|_H; the preconditioner stands for H^-1. NaN where it breaks down.
/// @param residual  b - H x
double energy_error(const Preconditioner &B, const Vector &b, const Vector &residual)
{
  try {
    return std::sqrt(inverse_energy(B, residual) / inverse_energy(B, b));
  } catch (const Error &) {
    throw;
  } catch (const std::exception &failure) { // such as a singular coarse matrix; the same on all ranks
    pass_on_out_of_memory(failure);
    return std::numeric_limits<double>::quiet_NaN();
  }
}

} // namespace

/// The preconditioner as Belos applies it: to residuals of CG, or to any vectors. Now and then it looks whether the run is to stop:
/// the solves of a big scene take minutes.
class Krylov::Applied : public Operator
{
public:
  explicit Applied(RCP<const Map> map) : map_(std::move(map)) {}

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const override
  {
    constexpr int applications_between = 8; // a sum over all ranks each time
    if (++applications_ % applications_between == 0 && interrupted(*map_->getComm())) throw Interrupted();
    if (x.getNumVectors() == 1 && (enough > 0 || gives_up)) {
      const double norm = x.getVector(0)->norm2();
      // Belos' CG preconditions a residual before it looks whether the residual is small enough to stop.
      if (norm <= enough) return y.assign(x);
      left = norm / norm_of_right_side;
      const bool is_good = (wanted.error > 0 && iterations > 0 && error_is_small()) || norm <= asks_at;
      if (is_good && !goes_on()) throw Enough();
      if (gives_up && gives_up(iterations, left)) throw GivenUp();
    }
    ++iterations;
    if (to_residuals)
      B->apply_to_residual(x, y);
    else
      B->apply(x, y);
  }

  const Preconditioner *B = nullptr;
  bool to_residuals = false;
  double enough = 0;             // CG stops at residuals of this norm, which need no preconditioner; 0: not known
  double asks_at = 0;            // CG asks goes_on() at residuals of this norm, too; 0: it does not
  std::function<bool()> goes_on; // whether to go on from an x that is as good as wanted
  GivesUp gives_up;              // null: never
  double norm_of_right_side = 1;
  Accuracy wanted{1};
  const Vector *solution = nullptr, *right_side = nullptr; // x as far as CG has come, from 0, and b
  double energy_of_start = 0;                              // what is to be added to x . b [J]
  mutable EnergyError error;
  mutable double left = 1; // |r|/|b| before the last iteration
  mutable int iterations = 0;

private:
  bool error_is_small() const
  {
    error.add(solution->dot(*right_side));
    return error.squared() <= wanted.error * wanted.error * (error.energy() + energy_of_start + wanted.energy);
  }

  RCP<const Map> map_;
  mutable int applications_ = 0;
};

struct Krylov::Method {
  /// @param list  on top of rpc's defaults
  Method(const std::string &name, const int max_iterations, const Teuchos::ParameterList &list,
         const RCP<const Operator> &H)
      : needs_symmetric_H(needs_symmetry(name)), is_cg(name == LinearSolverOptions().method),
        stops_by_residual(list.numParams() == 0 && is_cg), preconditioner(rcp(new Applied(H->getDomainMap())))
  {
    const auto all = Teuchos::parameterList("Belos");
    all->set("Verbosity", static_cast<int>(Belos::Errors));
    all->set("Maximum Iterations", max_iterations);
    all->setParameters(list);
    belos = belos_method(name, all, H, preconditioner);
  }

  bool needs_symmetric_H;
  bool is_cg;             // preconditions residuals
  bool stops_by_residual; // at |r| <= tolerance |b|, as Belos' CG does unless the deck says otherwise
  RCP<Applied> preconditioner;
  std::unique_ptr<BelosMethod> belos;
};

Krylov::Krylov(const LinearSolverOptions &options, const RCP<const Operator> &H)
    : options_(options), H_(H), of_deck_(std::make_unique<Method>(options.method, options.max_iterations,
                                                                  entries_for(options.method, options.belos), H))
{
}

Krylov::~Krylov() = default;

/// From the preconditioner's start, else from 0.
KrylovResult Krylov::iterate(Method &method, const bool is_symmetric, const Preconditioner &B, const Vector &b,
                             Vector &x, const Accuracy &wanted, const GivesUp &gives_up)
{
  KrylovResult result;
  const bool by_error = wanted.error > 0 && is_symmetric && method.stops_by_residual;
  const Preconditioner::Start start = is_symmetric ? B.start(b) : Preconditioner::Start();
  const RCP<const Vector> rest = start.rest.is_null() ? Teuchos::rcpFromRef(b) : RCP<const Vector>(start.rest);
  const double left = start.rest.is_null() ? 1 : rest->norm2() / b.norm2();
  const bool cg_asks = wanted.goes_on && is_symmetric && method.stops_by_residual;
  bool gmres_asks = wanted.goes_on && method.belos->tells_update();
  const double rough = std::min(1., wanted.residual / left);
  const double least = cg_asks || gmres_asks ? std::min(1., wanted.further / left) : rough;
  // Belos divides by |rest|.
  method.preconditioner->enough = method.stops_by_residual ? (1 - rounding.sum) * least * rest->norm2() : 0;
  method.preconditioner->asks_at = cg_asks ? rough * rest->norm2() : 0;
  method.preconditioner->goes_on = [&] {
    if (!cg_asks && !gmres_asks) return false;
    Vector found(x, Teuchos::Copy);
    method.belos->add_update(found);
    auto now = rcp(new Vector(found, Teuchos::Copy));
    if (!start.x.is_null()) now->update(1., *start.x, 1.);
    method.preconditioner->asks_at = method.preconditioner->wanted.error = 0;
    gmres_asks = false;
    if (wanted.goes_on(*now)) {
      result.rough = now;
      return true;
    }
    x.assign(found);
    return false;
  };
  method.preconditioner->to_residuals = is_symmetric;
  method.preconditioner->B = &B;
  method.preconditioner->gives_up = method.is_cg ? gives_up : GivesUp();
  const double norm_of_b = b.norm2();
  int asked_after = 0;
  method.belos->before_iteration = nullptr;
  if (gives_up || gmres_asks)
    method.belos->before_iteration = [&](const int iterations, const double residual) {
      asked_after = iterations;
      result.residual = residual / norm_of_b;
      if (gmres_asks && residual <= rough * rest->norm2() && !method.preconditioner->goes_on()) throw Enough();
      if (gives_up && gives_up(iterations, residual / norm_of_b)) throw GivenUp();
    };
  method.preconditioner->norm_of_right_side = norm_of_b;
  method.preconditioner->iterations = 0;
  method.preconditioner->wanted = by_error ? wanted : Accuracy(wanted.residual);
  method.preconditioner->solution = &x;
  method.preconditioner->right_side = rest.get();
  method.preconditioner->energy_of_start = by_error && !start.x.is_null() ? start.x->dot(b) : 0;
  method.preconditioner->error = EnergyError(wanted.energy > 0 ? rate_ : 1);
  try {
    result.converged = method.belos->solve(least, *rest, x);
    result.iterations = method.belos->iterations();
    result.residual = left * method.belos->achieved();
    if (!result.converged)
      result.reason = "the linear solver stopped at |r|/|b| = " + std::to_string(result.residual) + " after " +
                      std::to_string(result.iterations) + " iterations";
  } catch (const Enough &) {
    result.converged = true;
    result.iterations = method.is_cg ? method.preconditioner->iterations : asked_after;
    if (method.is_cg) result.residual = method.preconditioner->left;
  } catch (const GivenUp &) {
    result.given_up = true;
    result.iterations = method.is_cg ? method.preconditioner->iterations : asked_after;
    result.reason =
        "given up after " + std::to_string(result.iterations) + (is_symmetric ? " CG" : " GMRES") + " iterations";
  } catch (const std::exception &failure) { // such as an indefinite or singular matrix; the same on all ranks
    pass_on_out_of_memory(failure);
    result.broken = true;
    result.residual = std::numeric_limits<double>::quiet_NaN();
    result.reason = "the linear solver broke down: " + one_line(failure.what());
  }
  if (!start.x.is_null()) x.update(1., *start.x, 1.);
  if (by_error && !result.broken) {
    result.energy = x.dot(b);
    rate_ = method.preconditioner->error.rate();
  }
  return result;
}

// CG breaks down, too, where the residual is at rounding level: of a small remainder on the patch, where its
// preconditioner expects zeros. Then CG starts once more, from the residual as it is.                           (4.9a)
KrylovResult Krylov::solve(const Preconditioner &B, const bool is_symmetric, const Vector &b, Vector &x,
                           const Accuracy &wanted, const GivesUp &gives_up)
{
  KrylovResult result = solve_once_more(B, is_symmetric, b, x, wanted, gives_up);
  if (result.rough.is_null() || result.converged || result.given_up) return result;
  x.assign(*result.rough); // which was good enough
  result.converged = true;
  result.broken = false;
  return result;
}

KrylovResult Krylov::solve_once_more(const Preconditioner &B, const bool is_symmetric, const Vector &b, Vector &x,
                                     const Accuracy &wanted, const GivesUp &gives_up)
{
  if (is_symmetric && wanted.error >= linear_rules.large_error && B.is_exact()) {
    B.apply(b, x);
    KrylovResult result;
    result.converged = true;
    result.iterations = 1;
    result.energy = x.dot(b);
    return result;
  }
  Method &method = is_symmetric ? *of_deck_ : for_any_matrix();
  Accuracy possible = wanted;
  possible.residual = std::max(wanted.residual, options_.tolerance);
  possible.further = std::max(wanted.further, options_.tolerance);
  KrylovResult result = iterate(method, is_symmetric, B, b, x, possible, gives_up);
  if (!result.broken || !is_symmetric || !std::isfinite(x.norm2())) return result;
  Vector residual(b, Teuchos::Copy);
  H_->apply(x, residual, Teuchos::NO_TRANS, -1., 1.);
  if (!(energy_error(B, b, residual) <= linear_rules.large_error)) return result;
  Vector move(b.getMap());
  const double left = result.rough.is_null() ? wanted.residual : wanted.further;
  const double rest = std::max(left * b.norm2() / residual.norm2(), options_.tolerance);
  KrylovResult more = iterate(method, is_symmetric, B, residual, move, rest, {});
  if (more.converged)
    x.update(1., move, 1.);
  else
    more.reason = result.reason;
  more.broken = false;
  more.rough = result.rough;
  return more;
}

Krylov::Method &Krylov::for_any_matrix()
{
  if (!of_deck_->needs_symmetric_H) return *of_deck_;
  if (gmres_) return *gmres_;
  Teuchos::ParameterList list = gmres_defaults(options_.max_iterations);
  const Teuchos::ParameterList own = entries_for(gmres, options_.belos);
  if (own.isParameter("Explicit Residual Test"))
    list.set("Flexible Gmres", false); // whose test would precondition updates twice
  list.setParameters(own);
  gmres_ = std::make_unique<Method>(gmres, options_.max_iterations, list, H_);
  return *gmres_;
}

} // namespace rpc::solver
