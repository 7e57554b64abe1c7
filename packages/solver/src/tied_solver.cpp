// SPDX-License-Identifier: BSD-3-Clause
#include "tied_solver.hpp"

#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rpc::solver
{
namespace
{

constexpr double first_accuracy = 0.1; // of Y, as the residual over C, where the first solve asks for it
constexpr double no_stiffness = 1e-13; // of D: what is less of D - C^T Y is none

/// x <- S^-1 b for a small S. @return whether S is regular
bool solve_dense(std::vector<double> S, std::vector<double> &b)
{
  const int n = static_cast<int>(b.size());
  std::vector<int> pivots(n);
  int info = 0;
  Teuchos::LAPACK<int, double>().GESV(n, 1, S.data(), n, pivots.data(), b.data(), n, &info);
  return info == 0 && std::all_of(b.begin(), b.end(), [](const double each) { return std::isfinite(each); });
}

} // namespace

TiedSolver::TiedSolver(RCP<const TiedStiffness> stiffness, RCP<const UpdatedOperator> H)
    : stiffness_(std::move(stiffness)), H_(std::move(H))
{
  for (int j = 0; j < stiffness_->tied().size(); ++j) response_.push_back(rcp(new Vector(H_->getDomainMap())));
}

/// b, 0 at members.
Vector TiedSolver::without_members(const Vector &b) const
{
  Vector held(b, Teuchos::Copy);
  set_members(stiffness_->tied(), std::vector<double>(stiffness_->tied().size(), 0.), held);
  return held;
}

/// C - H Y of a group.
RCP<Vector> TiedSolver::rest(const int group) const
{
  auto left = rcp(new Vector(stiffness_->force(group), Teuchos::Copy));
  H_->apply(*response_[group], *left, Teuchos::NO_TRANS, -1., 1.);
  return left;
}

/// (groups x groups) D - C^T Y, columns one after another.
std::vector<double> TiedSolver::complement() const
{
  const int n = stiffness_->tied().size();
  std::vector<double> S;
  for (int k = 0; k < n; ++k) {
    const auto forces = stiffness_->forces_of(*response_[k]);
    for (int j = 0; j < n; ++j) S.push_back(stiffness_->stiffness(j, k) - forces[j]);
  }
  return S;
}

LinearSolver::Result TiedSolver::solve(const Held &held, const Vector &b, Vector &x, const Accuracy &wanted)
{
  const TiedUnknowns &tied = stiffness_->tied();
  const int n = tied.size();
  const Vector b_F = without_members(b);
  const double target = wanted.residual * b.norm2(), size = b_F.norm2();
  LinearSolver::Result result;
  result.converged = true;
  if (size > 0) {
    Accuracy of_held = wanted;
    of_held.residual = std::min(1., target / (2 * size));
    result = held(b_F, x, of_held);
    if (result.broken) return result;
  } else {
    x.putScalar(0);
  }
  std::vector<double> given = means(tied, b), value;
  const auto from_x = stiffness_->forces_of(x);
  for (int j = 0; j < n; ++j) given[j] = given[j] * static_cast<double>(tied.count[j]) - from_x[j];
  std::vector<double> accuracy(n, first_accuracy); // |C - H Y| / |C|, wanted
  constexpr int most_rounds = 4;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<double> left(n);
    for (int j = 0; j < n; ++j) {
      const double whole = stiffness_->force(j).norm2();
      auto residual = rest(j);
      left[j] = residual->norm2();
      if (!(left[j] > accuracy[j] * whole)) continue;
      Vector change(residual->getMap());
      const auto solved = held(*residual, change, Accuracy(std::min(0.5, accuracy[j] * whole / left[j])));
      result.iterations += solved.iterations;
      if (solved.broken) return solved;
      response_[j]->update(1., change, 1.);
      left[j] = rest(j)->norm2();
    }
    const std::vector<double> S = complement();
    bool regular = true;
    for (int j = 0; j < n; ++j) regular = regular && S[j * n + j] > no_stiffness * stiffness_->stiffness(j, j);
    value = given;
    if (!regular || !solve_dense(S, value)) {
      result.converged = false;
      result.broken = true;
      result.reason = "nothing holds a side that a force moves: no contact point of the active set is closed";
      return result;
    }
    bool enough = true;
    for (int j = 0; j < n; ++j) {
      const double most = target / (2 * n * std::max(std::abs(value[j]), std::numeric_limits<double>::min()));
      enough = enough && left[j] <= most;
      accuracy[j] = std::min(accuracy[j], most / (2 * stiffness_->force(j).norm2()));
    }
    if (enough) break;
  }
  for (int j = 0; j < n; ++j) x.update(-value[j], *response_[j], 1.);
  set_members(tied, value, x);
  if (wanted.error > 0) result.energy = b.dot(x);
  return result;
}

double TiedSolver::inverse_energy(const std::function<double(const Vector &)> &held, const Vector &F) const
{
  const TiedUnknowns &tied = stiffness_->tied();
  const int n = tied.size();
  const Vector F_F = without_members(F);
  std::vector<double> given = means(tied, F);
  for (int j = 0; j < n; ++j) given[j] = given[j] * static_cast<double>(tied.count[j]) - response_[j]->dot(F_F);
  std::vector<double> value = given;
  double energy = held(F_F);
  if (solve_dense(complement(), value))
    for (int j = 0; j < n; ++j) energy += value[j] * given[j];
  return energy;
}

void LinearSolver::move_as_one(const RCP<const TiedStiffness> &stiffness, const RCP<const UpdatedOperator> &H)
{
  tied_ = std::make_shared<TiedSolver>(stiffness, H);
}

LinearSolver::Result LinearSolver::solve(const Vector &b, Vector &x, const Accuracy &wanted)
{
  if (!tied_) return solve_held(b, x, wanted);
  return tied_->solve(
      [this](const Vector &held, Vector &at, const Accuracy &asked) { return solve_held(held, at, asked); }, b, x,
      wanted);
}

double LinearSolver::inverse_energy(const Vector &F)
{
  if (!tied_) return inverse_energy_held(F);
  return tied_->inverse_energy([this](const Vector &held) { return inverse_energy_held(held); }, F);
}

} // namespace rpc::solver
