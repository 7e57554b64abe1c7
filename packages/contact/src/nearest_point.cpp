// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/nearest_point.hpp"

#include "rpc/contact/rounding.hpp"

#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>

namespace rpc::contact
{
namespace
{

using Numbers = std::vector<double>;

double dot(const Numbers &a, const Numbers &b)
{
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}
double norm(const Numbers &a)
{
  return std::sqrt(dot(a, a));
}

/// x of least |A x - b|, the shortest of several.
Numbers least_squares(const std::vector<Numbers> &columns, const Numbers &b)
{
  const int rows = static_cast<int>(b.size()), cols = static_cast<int>(columns.size());
  if (cols == 0) return {};
  const int most = std::max(rows, cols), work_size = 64 * most;
  Numbers A, x = b, singular(most), work(work_size);
  for (const Numbers &column : columns) A.insert(A.end(), column.begin(), column.end());
  x.resize(most, 0.);
  int rank = 0, info = 0;
  Teuchos::LAPACK<int, double>().GELSS(rows, cols, 1, A.data(), rows, x.data(), most, singular.data(), Rounding::face,
                                       &rank, work.data(), work_size, &info);
  x.resize(cols);
  return x;
}

/// A face of the set: sum_j weight_j direction_j with weights >= 0 and sum_j share_j weight_j <= 1, that is < 1 where the
/// origin is one of its corners.
class Face
{
public:
  explicit Face(Numbers b) : b_(std::move(b)) {}

  bool has_origin() const { return origin_; }
  void add_origin() { origin_ = true; }
  void add(const Furthest &generator)
  {
    const double size = norm(generator.at);
    Numbers direction = generator.at;
    for (double &entry : direction) entry /= size;
    direction_.push_back(direction);
    share_.push_back(generator.endless ? 0 : 1 / size);
    weight_.push_back(0);
  }
  Numbers point() const
  {
    Numbers x(b_.size(), 0.);
    for (std::size_t j = 0; j < direction_.size(); ++j)
      for (std::size_t k = 0; k < x.size(); ++k) x[k] += weight_[j] * direction_[j][k];
    return x;
  }
  /// Moves to the point nearest to b, dropping the corners that are in the way.
  void approach()
  {
    while (true) {
      const Numbers goal = nearest_of_plane();
      double step = 1;
      for (std::size_t j = 0; j < goal.size(); ++j)
        if (!(goal[j] > 0)) step = std::min(step, weight_[j] > 0 ? weight_[j] / (weight_[j] - goal[j]) : 0.);
      const double from = origin_weight(weight_), to = origin_weight(goal);
      if (origin_ && !(to > 0)) step = std::min(step, from > 0 ? from / (from - to) : 0.);
      if (step >= 1) {
        weight_ = goal;
        return;
      }
      const bool drop_origin = origin_ && !(to > 0) && from <= step * (from - to) * (1 + Rounding::sum);
      std::vector<char> drop(goal.size(), 0);
      for (std::size_t j = 0; j < goal.size(); ++j) {
        drop[j] = !(goal[j] > 0) && weight_[j] <= step * (weight_[j] - goal[j]) * (1 + Rounding::sum);
        weight_[j] = std::max(0., weight_[j] + step * (goal[j] - weight_[j]));
      }
      for (std::size_t j = goal.size(); j-- > 0;)
        if (drop[j]) remove(j);
      if (drop_origin) origin_ = false;
    }
  }

private:
  double origin_weight(const Numbers &weight) const { return 1 - dot(share_, weight); }
  void remove(const std::size_t j)
  {
    direction_.erase(direction_.begin() + j);
    share_.erase(share_.begin() + j);
    weight_.erase(weight_.begin() + j);
  }
  /// Weights of the point of the face's plane that is nearest to b, whatever their signs.
  Numbers nearest_of_plane() const
  {
    if (origin_) return least_squares(direction_, b_);
    // sum_j share_j weight_j = 1 gives the weight of the nearest corner by the others'.
    const std::size_t pivot = std::max_element(share_.begin(), share_.end()) - share_.begin();
    std::vector<Numbers> columns;
    Numbers rest = b_;
    for (std::size_t k = 0; k < rest.size(); ++k) rest[k] -= direction_[pivot][k] / share_[pivot];
    for (std::size_t j = 0; j < direction_.size(); ++j) {
      if (j == pivot) continue;
      Numbers column = direction_[j];
      for (std::size_t k = 0; k < column.size(); ++k) column[k] -= share_[j] / share_[pivot] * direction_[pivot][k];
      columns.push_back(column);
    }
    Numbers weight = least_squares(columns, rest);
    weight.insert(weight.begin() + pivot, 0.);
    weight[pivot] = origin_weight(weight) / share_[pivot];
    return weight;
  }

  Numbers b_;
  std::vector<Numbers> direction_; // (corners) unit
  Numbers share_;                  // (corners) 1/distance from the origin, 0 of endless ones
  Numbers weight_;                 // (corners)
  bool origin_ = true;
};

/// Of an endless direction and a bounded point the one that leads further along q for its length.
Furthest more_useful(Furthest furthest, const Numbers &q, const Numbers &x, const double size)
{
  if (furthest.bounded.empty()) return furthest;
  const double gain = dot(q, furthest.bounded) - dot(q, x), length = norm(furthest.bounded) + size;
  if (gain > dot(q, furthest.at) * length) return {furthest.bounded, false};
  return furthest;
}

} // namespace

Nearest nearest_point(const ConvexSet &set, const std::vector<double> &b, const double tolerance)
{
  constexpr int enough = 1000; // rounding alone could lead around in circles
  Face face(b);
  Nearest nearest;
  nearest.away = b;
  nearest.distance = norm(b);
  while (nearest.distance > tolerance && nearest.steps < enough) {
    const Numbers q = nearest.away, x = face.point();
    const Furthest furthest = more_useful(set(q), q, x, norm(b));
    ++nearest.steps;
    const double size = norm(furthest.at), gain = dot(q, furthest.at) - (furthest.endless ? 0 : dot(q, x));
    if (!(gain > Rounding::furthest * norm(q) * (furthest.endless ? 1 : size + norm(b)))) return nearest;
    if (size > 0)
      face.add(furthest);
    else if (!face.has_origin())
      face.add_origin();
    face.approach();
    const Numbers y = face.point();
    Numbers away = b;
    for (std::size_t k = 0; k < away.size(); ++k) away[k] -= y[k];
    if (!(norm(away) < nearest.distance)) return nearest;
    nearest.away = away;
    nearest.distance = norm(away);
  }
  if (nearest.distance <= tolerance) nearest.distance = 0;
  return nearest;
}

} // namespace rpc::contact
