// SPDX-License-Identifier: BSD-3-Clause
#include "preconditioner/mixed.hpp"

#include "multigrid/checkerboards.hpp"
#include "multigrid/shared_rows.hpp"
#include "rpc/core/math.hpp"
#include "rpc/core/rules.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rpc::solver
{

/// Factors of the equations of pressures, one for each mode.
struct ModeWeights {
  explicit ModeWeights(const RCP<const Map> &rows)
      : of_equation(rows), softness(rows), schur(rows), inverse(rows), bulk(rows)
  {
  }

  Vector of_equation;  // w [N/m^(dim/2)]; the pressures are w q
  Vector softness;     // w^2 / s
  Vector schur;        // 1 / (w^2 (1/s + 1/wave modulus)): the inverse of what stands for Z H_0^-1 Z^T + 1/s
  Vector inverse;      // 1 / w
  Vector bulk;         // 1 / (1/s + 1/bulk modulus) [Pa]
  double stiffest = 0; // the largest s |Z_m|^2 [N/m]
};

namespace
{

/// w of a mode is what its error is worth as a force: s |Z_m|. Collective.                                         (4.14a)
ModeWeights weights_of(const StiffDilatation &dilatation)
{
  const auto &rows = dilatation.modes->getRangeMap();
  ModeWeights weights(rows);
  const auto Z = dilatation.modes->getLocalMatrixDevice();
  const auto stiffness = dilatation.stiffness, wave = dilatation.wave_modulus, volume = dilatation.bulk_modulus;
  const auto w = device_write(weights.of_equation), softness = device_write(weights.softness),
             schur = device_write(weights.schur), inverse = device_write(weights.inverse),
             bulk = device_write(weights.bulk);
  double stiffest = 0;
  Kokkos::parallel_reduce(
      "rpc::solver::weights_of_modes", device_range(num_local(*rows)),
      KOKKOS_LAMBDA(const LO m, double &largest) {
        const bool is_split = stiffness(m) > 0; // others have no equation: their pressures are 0
        double square = 0;
        for (std::size_t k = Z.graph.row_map(m); k < Z.graph.row_map(m + 1); ++k) square += Z.values(k) * Z.values(k);
        const double s = is_split ? stiffness(m) : wave(m), factor = square > 0 ? s * s * square : 1.;
        w(m) = math::sqrt(factor);
        inverse(m) = 1 / w(m);
        softness(m) = factor / s;
        schur(m) = 1 / (factor * (1 / s + (is_split ? 1 / wave(m) : 0.)));
        bulk(m) = is_split ? 1 / (1 / s + 1 / volume(m)) : 0.;
        largest = math::fmax(largest, stiffness(m) * square);
      },
      Kokkos::Max<double>(stiffest));
  Kokkos::fence();
  weights.stiffest = max_all(*rows->getComm(), std::max(stiffest, 0.));
  return weights;
}

/// The largest entry of what contact adds [N/m]; collective.
double stiffest_contact(const UpdatedOperator &H)
{
  const auto update = H.update();
  const int dim = static_cast<int>(update.extent(1));
  double stiffest = 0;
  Kokkos::parallel_reduce(
      "rpc::solver::stiffest_contact", device_range(static_cast<LO>(update.extent(0))),
      KOKKOS_LAMBDA(const LO n, double &largest) {
        for (int k = 0; k < dim; ++k) largest = math::fmax(largest, update(n, k, k));
      },
      Kokkos::Max<double>(stiffest));
  return max_all(*H.getDomainMap()->getComm(), std::max(stiffest, 0.));
}

/// For the mixed system, which is not definite: the deck's method is for H.
LinearSolverOptions for_saddle()
{
  LinearSolverOptions options;
  options.method = "BiCGStab";
  options.max_iterations = linear_rules.iterations_of_pass;
  return options;
}

} // namespace

struct Mixed::System {
  System(const UpdatedOperator &H, MixedForm made, const LinearSolverOptions &options);

  /// u <- about H_0^-1 r.
  void solve_soft(const Vector &r, Vector &u) const { meshes.apply(r, u); }
  /// q <- q + w^-1 C w^-1 of_equation
  void add_checkerboards(Vector &q) const
  {
    work.elementWiseMultiply(1., weights.inverse, of_equation, 0.);
    checkerboards->apply(work, of_equation);
    q.elementWiseMultiply(1., weights.inverse, of_equation, 1.);
  }
  /// The parts of x = (u, q).
  RCP<const Vector> displacements(const Vector &x) const { return x.offsetView(dofs, 0)->getVector(0); }
  RCP<Vector> displacements(Vector &x) const { return x.offsetViewNonConst(dofs, 0)->getVectorNonConst(0); }
  RCP<const Vector> pressures(const Vector &x) const { return x.offsetView(mode_map, num_local(*dofs))->getVector(0); }
  RCP<Vector> pressures(Vector &x) const
  {
    return x.offsetViewNonConst(mode_map, num_local(*dofs))->getVectorNonConst(0);
  }

  class Saddle;
  class Triangular;

  StiffDilatation dilatation;
  SharedRows Z;
  RCP<UpdatedOperator> H0;
  Meshes meshes; // of H_0
  RCP<const Map> dofs, mode_map, all;
  ModeWeights weights;
  std::unique_ptr<const Checkerboards> checkerboards; // null: pressures do not alternate
  mutable Vector work, of_equation;                   // (modes)
  RCP<Saddle> saddle;
  std::unique_ptr<Triangular> triangular;
  std::unique_ptr<Krylov> krylov;
};

/// y <- (H_0 u + Z^T w q, w Z u - w^2 / s q) of x = (u, q).
class Mixed::System::Saddle : public Operator
{
public:
  explicit Saddle(const System &system) : system_(system) {}
  RCP<const Map> getDomainMap() const override { return system_.all; }
  RCP<const Map> getRangeMap() const override { return system_.all; }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, const double alpha,
             const double beta) const override
  {
    if (alpha != 1 || beta != 0) {
      MultiVector product(y.getMap(), y.getNumVectors());
      apply(x, product, Teuchos::NO_TRANS, 1, 0);
      y.update(alpha, product, beta);
      return;
    }
    const System &s = system_;
    for (std::size_t k = 0; k < x.getNumVectors(); ++k) {
      const auto of_x = x.getVector(k);
      const auto of_y = y.getVectorNonConst(k);
      const auto u = s.displacements(*of_x), q = s.pressures(*of_x);
      const auto force = s.displacements(*of_y), volume = s.pressures(*of_y);
      s.H0->apply(*u, *force);
      s.work.elementWiseMultiply(1., s.weights.of_equation, *q, 0.);
      s.Z.apply_transposed(s.work, *force, 1.);
      s.Z.apply(*u, s.work);
      volume->elementWiseMultiply(1., s.weights.of_equation, s.work, 0.);
      volume->elementWiseMultiply(-1., s.weights.softness, *q, 1.);
    }
  }

private:
  const System &system_;
};

/// y <- (V r_u, S^-1 (w Z V r_u - r_q)) of r = (r_u, r_q), V the multigrid for H_0 and S = w^2 (1/s + 1/wave modulus).
class Mixed::System::Triangular : public Preconditioner
{
public:
  explicit Triangular(const System &system) : system_(system) {}
  RCP<const Map> getDomainMap() const override { return system_.all; }
  RCP<const Map> getRangeMap() const override { return system_.all; }
  Prepared prepare() override { return Prepared::unchanged; }
  void forget() override {}
  std::string name() const override { return "mixed"; }
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const override
  {
    const System &s = system_;
    for (std::size_t k = 0; k < x.getNumVectors(); ++k) {
      const auto of_x = x.getVector(k);
      const auto of_y = y.getVectorNonConst(k);
      const auto u = s.displacements(*of_y), q = s.pressures(*of_y);
      s.solve_soft(*s.displacements(*of_x), *u);
      s.Z.apply(*u, s.work);
      q->elementWiseMultiply(1., s.weights.of_equation, s.work, 0.);
      q->update(-1., *s.pressures(*of_x), 1.);
      s.of_equation.assign(*q);
      q->elementWiseMultiply(1., s.weights.schur, s.of_equation, 0.);
      if (s.checkerboards) s.add_checkerboards(*q);
    }
  }

private:
  const System &system_;
};

Mixed::System::System(const UpdatedOperator &H, MixedForm made, const LinearSolverOptions &options)
    : dilatation(std::move(made.dilatation)), Z(dilatation.modes),
      H0(rcp(new UpdatedOperator(std::move(made.soft), H.nodes()))), meshes(H0, std::move(made.levels), options),
      dofs(H.getDomainMap()), mode_map(dilatation.modes->getRangeMap()),
      all(rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), num_local(*dofs) + num_local(*mode_map),
                      0, dofs->getComm()))),
      weights(weights_of(dilatation)), work(mode_map), of_equation(mode_map), saddle(rcp(new Saddle(*this))),
      triangular(std::make_unique<Triangular>(*this)), krylov(std::make_unique<Krylov>(for_saddle(), saddle))
{
  if (!dilatation.at_nodes.is_null()) checkerboards = std::make_unique<const Checkerboards>(dilatation, H0->base());
}

Mixed::Mixed(RCP<const UpdatedOperator> H, MakeMixedForm make, LinearSolverOptions options)
    : H_(std::move(H)), make_(std::move(make)), options_(std::move(options))
{
}

Mixed::~Mixed() = default;

Preconditioner::Prepared Mixed::prepare()
{
  if (!system_) system_ = std::make_unique<System>(*H_, make_(), options_);
  system_->H0->follow(*H_);
  return system_->meshes.prepare();
}

void Mixed::learn(const int iterations, const double seconds_of_iteration)
{
  if (system_) system_->meshes.learn(iterations, seconds_of_iteration);
}

void Mixed::forget()
{
  system_.reset();
}

std::string Mixed::description() const
{
  return name() + (system_ ? ": " + system_->meshes.description() : "");
}

KrylovResult Mixed::solve(const Vector &b, Vector &x, const Accuracy &wanted, const GivesUp &gives_up) const
{
  const System &s = *system_;
  const double norm = b.norm2(), enough = std::max(wanted.residual, options_.tolerance) * norm;
  const double stiffest = s.weights.stiffest + stiffest_contact(*H_);
  Vector right_side(s.all), found(s.all), rest(b, Teuchos::Copy);
  KrylovResult result;
  x.putScalar(0);
  double left = norm;
  while (!result.converged && !result.given_up && result.iterations < options_.max_iterations) {
    right_side.putScalar(0);
    s.displacements(right_side)->assign(rest);
    const KrylovResult pass = s.krylov->solve(*s.triangular, false, right_side, found,
                                              std::min<double>(enough / left, newton_rules.largest_residual));
    if (pass.broken) {
      result.broken = true;
      result.reason = pass.reason;
      return result;
    }
    x.update(1., *s.displacements(std::as_const(found)), 1.);
    rest.assign(b);
    H_->apply(x, rest, Teuchos::NO_TRANS, -1., 1.);
    const double before = std::exchange(left, rest.norm2());
    result.converged = left <= std::max(enough, rounding.product * stiffest * x.norm2());
    result.residual = left / norm;
    // BiCGStab does not tell its residuals: within a pass they are taken to fall evenly. The judgement on the last one counts.
    for (int k = 1; k <= pass.iterations && gives_up && !result.converged; ++k)
      result.given_up = gives_up(result.iterations + k,
                                 before / norm * std::pow(left / before, static_cast<double>(k) / pass.iterations));
    result.iterations += pass.iterations;
    if (!(left < headway_rules.falls * before)) break;
  }
  if (!result.converged)
    result.reason = (result.given_up ? "given up after " : "|r|/|b| = " + std::to_string(result.residual) + " after ") +
                    std::to_string(result.iterations) + " BiCGStab iterations";
  if (result.converged && wanted.error > 0) result.energy = x.dot(b);
  return result;
}

void Mixed::apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp, double, double) const
{
  const System &s = *system_;
  Vector forces(x.getMap()), correction(x.getMap()), pressure(s.mode_map);
  for (std::size_t k = 0; k < x.getNumVectors(); ++k) {
    const auto u = y.getVectorNonConst(k);
    s.solve_soft(*x.getVector(k), *u);
    s.Z.apply(*u, s.work);
    pressure.elementWiseMultiply(1., s.weights.bulk, s.work, 0.);
    s.Z.apply_transposed(pressure, forces, 0.);
    s.solve_soft(forces, correction);
    u->update(-1., correction, 1.);
  }
}

} // namespace rpc::solver
