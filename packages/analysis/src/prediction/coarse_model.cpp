// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/coarse_model.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/core/memory.hpp"
#include "rpc/solver/exact_line_search.hpp"
#include "rpc/solver/rules.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace rpc::analysis
{

using contact::State;

namespace
{

double dot(const std::vector<double> &a, const std::vector<double> &b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
}

void add(const double factor, const std::vector<double> &x, std::vector<double> &y)
{
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * x[i];
}

/// The entries of the lower half, in the order of rows, then of columns.
solver::SymmetricEntries sorted(const solver::SymmetricEntries &entries)
{
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < entries.row.size(); ++k)
    if (entries.column[k] <= entries.row[k]) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) {
    return std::pair(entries.row[a], entries.column[a]) < std::pair(entries.row[b], entries.column[b]);
  });
  solver::SymmetricEntries lower;
  for (const std::size_t k : order) {
    lower.row.push_back(entries.row[k]);
    lower.column.push_back(entries.column[k]);
    lower.value.push_back(entries.value[k]);
  }
  return lower;
}

/// act(k, l) for each pair of a column's entries, each once, k's row not above l's.
template <class Act>
void for_pairs(const solver::SparseColumns &columns, const int i, const Act &act)
{
  for (int k = columns.begin[i]; k < columns.begin[i + 1]; ++k)
    for (int l = columns.begin[i]; l < columns.begin[i + 1]; ++l)
      if (columns.row[l] <= columns.row[k]) act(k, l);
}

std::size_t count_pairs(const solver::SparseColumns &columns)
{
  std::size_t pairs = 0;
  for (int i = 0; i < columns.count(); ++i) {
    const std::size_t n = columns.begin[i + 1] - columns.begin[i];
    pairs += n * (n + 1) / 2;
  }
  return pairs;
}

} // namespace

CoarseModel::CoarseModel(const int size, const solver::SymmetricEntries &K, solver::SparseColumns points,
                         std::vector<ModelPoint> data)
    : size_(size), K_(sorted(K)), matrix_(K_.value), points_(std::move(points)), data_(std::move(data)), first_{0}
{
  if (static_cast<double>(count_pairs(points_) * sizeof(int)) > solver::linear_rules.kept_of_free * memory_left())
    return;
  std::vector<std::size_t> row(size_ + 1); // where its entries begin
  for (int i = 0; i <= size_; ++i) row[i] = std::lower_bound(K_.row.begin(), K_.row.end(), i) - K_.row.begin();
  bool all_found = true; // the unknowns of a point are those of one cell
  for (int i = 0; i < points_.count(); ++i) {
    for_pairs(points_, i, [&](const int k, const int l) {
      const auto begin = K_.column.begin(), from = begin + static_cast<std::ptrdiff_t>(row[points_.row[k]]),
                 to = begin + static_cast<std::ptrdiff_t>(row[points_.row[k] + 1]);
      const auto at = std::lower_bound(from, to, points_.row[l]);
      all_found = all_found && at != to && *at == points_.row[l];
      entry_.push_back(static_cast<int>(at - begin));
    });
    first_.push_back(entry_.size());
  }
  if (!all_found) return;
  factor_ = solver::SparseFactor::analyse(rcp(new Teuchos::SerialComm<int>), size_, K_, 1);
}

bool CoarseModel::is_cheap(const double solve_seconds) const
{
  return factor_ && factor_->cost().seconds < choice_rules.model_solves * solve_seconds;
}

void CoarseModel::Unknowns::move(const double t, const Unknowns &d)
{
  add(t, d.y, y);
  add(t, d.part, part);
}

/// (points) By how much the unknowns move the points.
std::vector<double> CoarseModel::points_moved(const Unknowns &x) const
{
  std::vector<double> moved(data_.size(), 0.);
  for (std::size_t i = 0; i < moved.size(); ++i)
    for (int k = points_.begin[i]; k < points_.begin[i + 1]; ++k) moved[i] += points_.value[k] * x.y[points_.row[k]];
  for (std::size_t j = 0; j < x.part.size(); ++j) add(x.part[j], learnt_[j], moved);
  return moved;
}

/// P^T W p.
std::vector<double> CoarseModel::nodal_forces(const std::vector<double> &p) const
{
  std::vector<double> forces(size_, 0.);
  for (std::size_t i = 0; i < p.size(); ++i)
    for (int k = points_.begin[i]; k < points_.begin[i + 1]; ++k)
      forces[points_.row[k]] += points_.value[k] * data_[i].weight * p[i];
  return forces;
}

/// Ky/s, and the factors of the c_j, which have a stiffness of 1.
CoarseModel::Unknowns CoarseModel::elastic_forces(const Unknowns &x) const
{
  Unknowns forces{std::vector<double>(size_, 0.), x.part};
  for (std::size_t k = 0; k < K_.row.size(); ++k) {
    const int i = K_.row[k], j = K_.column[k];
    const double stiffness = K_.value[k] / scale_;
    forces.y[i] += stiffness * x.y[j];
    if (i != j) forces.y[j] += stiffness * x.y[i];
  }
  return forces;
}

/// Psi_i'(v_i + moved) with the last pressure for the multiplier and the node's own stiffness for the penalty: 1/k is the local part of C.
double CoarseModel::pressure(const std::size_t i, const double moved) const
{
  return contact::pressure(v_[i] + moved, p_[i], data_[i].stiffness, data_[i].law);
}

State CoarseModel::state(const std::size_t i, const double moved) const
{
  return contact::state(v_[i] + moved, p_[i], data_[i].stiffness, data_[i].law);
}

/// Of K/s + P^T W diag(stiffness) P. @param stiffness  (points) [Pa/m]; empty: 0
bool CoarseModel::factorize(const std::vector<double> &stiffness)
{
  is_elastic_ = stiffness.empty();
  for (std::size_t k = 0; k < matrix_.size(); ++k) matrix_[k] = K_.value[k] / scale_;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    if (stiffness[i] == 0) continue;
    std::size_t pair = first_[i];
    for_pairs(points_, static_cast<int>(i), [&](const int k, const int l) {
      matrix_[entry_[pair++]] += data_[i].weight * stiffness[i] * points_.value[k] * points_.value[l];
    });
  }
  return factor_->make(matrix_);
}

void CoarseModel::learn(std::vector<double> v, std::vector<double> p)
{
  std::swap(v, v_);
  std::swap(p, p_);
  if (p.empty()) return; // there was none before
  Change change{p, v, {}};
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] = p_[i] - p[i];
    change.forces[i] = data_[i].weight * p[i];
    change.moved[i] -= v_[i] + p[i] / data_[i].stiffness;
  }
  if (!is_elastic_ && !factorize({})) return;
  Unknowns coarse{nodal_forces(p), {}};
  factor_->solve(coarse.y.data());
  for (double &y : coarse.y) y /= scale_;
  change.coarse = points_moved(coarse);
  changes_.push_back(std::move(change));
  update();
}

/// s and the c_j by all changes that were seen.                                                               (5.8d)
void CoarseModel::update()
{
  double least = std::numeric_limits<double>::infinity(); // by how much the coarse mesh is too stiff
  for (const Change &change : changes_) {
    const double coarse = dot(change.forces, change.coarse);
    if (coarse > 0) least = std::min(least, dot(change.forces, change.moved) / coarse);
  }
  const double scale = std::isfinite(least) ? std::max(1., choice_rules.part_of_scale * least) : 1;
  is_elastic_ = is_elastic_ && scale == scale_;
  scale_ = scale;
  learnt_.clear();
  for (const Change &change : changes_) {
    std::vector<double> missing = change.moved;
    add(-scale_, change.coarse, missing);
    for (const auto &c : learnt_) add(-dot(c, change.forces), c, missing);
    const double missed = dot(missing, change.forces);
    if (!(missed > choice_rules.coarse_error * std::abs(dot(change.moved, change.forces)))) continue;
    for (double &c : missing) c /= std::sqrt(missed);
    learnt_.push_back(std::move(missing));
  }
}

/// Of the model's functional. @param elastic  elastic_forces()   @param pressure  (points) [Pa]
CoarseModel::Unknowns CoarseModel::gradient(const Unknowns &elastic, std::vector<double> pressure) const
{
  for (std::size_t i = 0; i < pressure.size(); ++i) pressure[i] -= p_[i];
  Unknowns gradient = elastic;
  add(1, nodal_forces(pressure), gradient.y);
  for (std::size_t i = 0; i < pressure.size(); ++i) pressure[i] *= data_[i].weight;
  for (std::size_t j = 0; j < learnt_.size(); ++j) gradient.part[j] += dot(learnt_[j], pressure);
  return gradient;
}

/// The factors of a system that has its stiffness. The unknowns of the c_j are eliminated.                       (5.8e)
bool CoarseModel::factorize(System &system)
{
  const std::vector<double> &stiffness = system.stiffness;
  if (!factorize(stiffness)) return false;
  const std::size_t n = learnt_.size();
  system.coupling.resize(n);
  system.solved.resize(n);
  system.S.assign(n * n, 0.);
  std::vector<double> scaled(stiffness.size());
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < scaled.size(); ++i) scaled[i] = stiffness[i] * learnt_[j][i];
    system.solved[j] = system.coupling[j] = nodal_forces(scaled);
    factor_->solve(system.solved[j].data());
    for (std::size_t i = 0; i < scaled.size(); ++i) scaled[i] *= data_[i].weight;
    for (std::size_t l = 0; l <= j; ++l)
      system.S[j * n + l] = dot(scaled, learnt_[l]) - dot(system.coupling[j], system.solved[l]);
    system.S[j * n + j] += 1;
  }
  if (n == 0) return true;
  const int size = static_cast<int>(n);
  int info = 0;
  Teuchos::LAPACK<int, double>().POTRF('U', size, system.S.data(), size, &info);
  return info == 0;
}

/// -H^-1 gradient.
CoarseModel::Unknowns CoarseModel::direction(const System &system, const Unknowns &gradient) const
{
  Unknowns d = gradient;
  factor_->solve(d.y.data());
  const int size = static_cast<int>(learnt_.size());
  for (int j = 0; j < size; ++j) d.part[j] -= dot(system.coupling[j], d.y);
  int info = 0;
  if (size > 0) Teuchos::LAPACK<int, double>().POTRS('U', size, 1, system.S.data(), size, d.part.data(), size, &info);
  for (int j = 0; j < size; ++j) add(-d.part[j], system.solved[j], d.y);
  for (double &y : d.y) y = -y;
  for (double &part : d.part) part = -part;
  return d;
}

/// The model's functional along a direction.
class CoarseModel::Line : public LineFunction
{
public:
  /// @param moved, along  (points) by how much the points have moved, and do for t = 1
  Line(const CoarseModel &model, const double slope, const double curvature, const std::vector<double> &moved,
       const std::vector<double> &along)
      : model_(model), slope_(slope), curvature_(curvature), moved_(moved), along_(along)
  {
  }
  Value at(const double t) const override
  {
    Value value{slope_ + t * curvature_, curvature_};
    for (std::size_t i = 0; i < along_.size(); ++i) {
      if (along_[i] == 0) continue;
      const ModelPoint &point = model_.data_[i];
      const double moved = moved_[i] + t * along_[i], weight = point.weight * along_[i];
      value.slope += weight * (model_.pressure(i, moved) - model_.p_[i]);
      value.curvature +=
          weight * along_[i] * contact::branch_stiffness(model_.state(i, moved), point.stiffness, point.law);
    }
    return value;
  }

private:
  const CoarseModel &model_;
  double slope_, curvature_; // of the elastic part
  const std::vector<double> &moved_, &along_;
};

/// Newton's method with exact step lengths, from no change. @return the states where it has converged; none: it has not
std::optional<ModelStates> CoarseModel::choose()
{
  Unknowns x{std::vector<double>(size_, 0.), std::vector<double>(learnt_.size(), 0.)};
  ModelStates now;
  const std::size_t n = data_.size();
  now.state.resize(n);
  now.pressure.resize(n);
  System system;
  system.stiffness.resize(n);
  for (int step = 0; step < solver::newton_rules.most_inner_steps; ++step) {
    const std::vector<double> moved = points_moved(x);
    for (std::size_t i = 0; i < n; ++i) {
      now.state[i] = state(i, moved[i]);
      now.pressure[i] = pressure(i, moved[i]);
      system.stiffness[i] = contact::branch_stiffness(now.state[i], data_[i].stiffness, data_[i].law);
    }
    const Unknowns elastic = elastic_forces(x);
    if (!factorize(system)) return {};
    const Unknowns d = direction(system, gradient(elastic, now.pressure));
    const std::vector<double> along = points_moved(d);
    bool same = true;
    for (std::size_t i = 0; i < n; ++i) {
      same = same && state(i, moved[i] + along[i]) == now.state[i];
      now.pressure[i] = pressure(i, moved[i] + along[i]);
    }
    if (same) return now;
    const Unknowns forces = elastic_forces(d);
    const double slope = dot(elastic.y, d.y) + dot(elastic.part, d.part),
                 curvature = dot(forces.y, d.y) + dot(forces.part, d.part);
    const double t = solver::exact_step(Line(*this, slope, curvature, moved, along));
    if (!(t > 0 && std::isfinite(t))) return {};
    x.move(t, d);
  }
  return {};
}

} // namespace rpc::analysis
