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

/// How well Y is known, as |C - H Y| / |C|. Solutions do not depend on it: they are held to what a solve may leave.
struct Response {
  static constexpr double first = 0.1;          ///< wanted at first
  static constexpr double next = 1e-2;          ///< over the last one, where D - C^T Y is not known
  static constexpr double told = 0.1;           ///< of D - C^T Y: what Y may leave of it where that counts as known
  static constexpr double no_stiffness = 1e-13; ///< of D: less of D - C^T Y is rounding
};

/// x <- S^-1 b for a small S. @return whether S is regular
bool solve_dense(std::vector<double> S, std::vector<double> &b)
{
  const int n = static_cast<int>(b.size());
  std::vector<int> pivots(n);
  int info = 0;
  Teuchos::LAPACK<int, double>().GESV(n, 1, S.data(), n, pivots.data(), b.data(), n, &info);
  return info == 0 && std::all_of(b.begin(), b.end(), [](const double each) { return std::isfinite(each); });
}

/// Of each value, the stiffness of S against it where the others are as they like: 1 / (S^-1)_jj. Where S is not symmetric, S_jj.
std::vector<double> own_stiffness(const std::vector<double> &S, const int n, const bool symmetric)
{
  std::vector<double> own;
  for (int j = 0; j < n; ++j) {
    own.push_back(S[j * n + j]);
    if (!symmetric || n == 1) continue;
    std::vector<double> column(n, 0.);
    column[j] = 1;
    own.back() = solve_dense(S, column) ? std::min(own.back(), 1 / column[j]) : 0;
  }
  return own;
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
    of_held.goes_on = {}; // x would lack the tied unknowns
    result = held(b_F, x, of_held);
    if (result.broken) return result;
  } else {
    x.putScalar(0);
  }
  std::vector<double> given = means(tied, b), value;
  const auto from_x = stiffness_->forces_of(x);
  for (int j = 0; j < n; ++j) given[j] = given[j] * tied.square[j] - from_x[j];
  std::vector<double> accuracy(n, Response::first); // |C - H Y| / |C|, wanted
  constexpr int most_rounds = 8;
  for (int round = 1; round <= most_rounds; ++round) {
    std::vector<double> left(n), missed(n); // |C - H Y|, and what it makes of C^T Y
    for (int j = 0; j < n; ++j) {
      const double whole = stiffness_->force(j).norm2();
      auto residual = rest(j);
      left[j] = residual->norm2();
      if (left[j] > accuracy[j] * whole) {
        Vector change(residual->getMap());
        const auto solved = held(*residual, change, Accuracy(std::min(0.5, accuracy[j] * whole / left[j])));
        result.iterations += solved.iterations;
        if (solved.broken) return solved;
        response_[j]->update(1., change, 1.);
        residual = rest(j);
        left[j] = residual->norm2();
      }
      missed[j] = std::abs(residual->dot(*response_[j]));
    }
    const std::vector<double> S = complement(), stiffness = own_stiffness(S, n, H_->is_symmetric());
    bool regular = true, enough = true;
    for (int j = 0; j < n; ++j) {
      const double own = stiffness[j], whole = stiffness_->force(j).norm2();
      if (missed[j] > Response::told * own && left[j] > Response::no_stiffness * whole) { // S is not known yet
        enough = false;
        accuracy[j] = std::min(accuracy[j], Response::next * left[j] / whole);
      }
      regular = regular && own > Response::no_stiffness * stiffness_->stiffness(j, j);
    }
    if (!enough && round < most_rounds) continue;
    value = given;
    if (!regular || !solve_dense(S, value)) {
      result.converged = false;
      result.broken = true;
      result.reason = "nothing holds a side that forces move: no contact point of the active set that would is closed";
      return result;
    }
    for (int j = 0; j < n; ++j) {
      const double most = target / (2 * n * std::max(std::abs(value[j]), std::numeric_limits<double>::min()));
      enough = enough && left[j] <= most;
      accuracy[j] = std::min(accuracy[j], most / (2 * stiffness_->force(j).norm2()));
    }
    if (enough) break;
  }
  solved_ = true;
  for (int j = 0; j < n; ++j) x.update(-value[j], *response_[j], 1.);
  set_members(tied, value, x);
  if (H_->is_symmetric()) balance(b, x);
  if (wanted.error > 0) result.energy = b.dot(x);
  return result;
}

/// A step along W = (-Y, 1), in which the sides move as one and the body follows: the softest direction there may be, in which x has an error
/// of many times its residual.
void TiedSolver::balance(const Vector &b, Vector &x) const
{
  const TiedUnknowns &tied = stiffness_->tied();
  const int n = tied.size();
  std::vector<double> value = means(tied, x), given = means(tied, b), S = complement();
  set_members(tied, std::vector<double>(n, 0.), x);
  Vector left = without_members(b);
  H_->apply(x, left, Teuchos::NO_TRANS, -1., 1.);
  const auto forces = stiffness_->forces_of(x);
  for (int k = 0; k < n; ++k) {
    left.update(-value[k], stiffness_->force(k), 1.);
    const auto residual = rest(k);
    for (int j = 0; j < n; ++j) S[k * n + j] -= response_[j]->dot(*residual);
  }
  std::vector<double> step;
  for (int j = 0; j < n; ++j) {
    double force = given[j] * tied.square[j] - forces[j];
    for (int k = 0; k < n; ++k) force -= stiffness_->stiffness(j, k) * value[k];
    step.push_back(force - response_[j]->dot(left));
  }
  if (solve_dense(S, step))
    for (int j = 0; j < n; ++j) {
      value[j] += step[j];
      x.update(-step[j], *response_[j], 1.);
    }
  set_members(tied, value, x);
}

double TiedSolver::inverse_energy(const std::function<double(const Vector &)> &held, const Vector &F) const
{
  const TiedUnknowns &tied = stiffness_->tied();
  const int n = tied.size();
  const Vector F_F = without_members(F);
  std::vector<double> given = means(tied, F);
  for (int j = 0; j < n; ++j) given[j] = given[j] * tied.square[j] - response_[j]->dot(F_F);
  std::vector<double> value = given;
  double energy = held(F_F);
  if (solve_dense(complement(), value))
    for (int j = 0; j < n; ++j) energy += value[j] * given[j];
  return energy;
}

std::vector<double> TiedSolver::softness() const
{
  if (!solved_) return {};
  const int n = stiffness_->tied().size();
  const std::vector<double> S = complement();
  std::vector<double> all;
  for (int k = 0; k < n; ++k) {
    std::vector<double> column(n, 0.);
    column[k] = 1;
    if (!solve_dense(S, column)) return {};
    all.insert(all.end(), column.begin(), column.end());
  }
  return all;
}

std::vector<double> LinearSolver::softness_of_tied() const
{
  return tied_ ? tied_->softness() : std::vector<double>();
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
