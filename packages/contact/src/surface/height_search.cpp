// SPDX-License-Identifier: BSD-3-Clause
#include "height_patch.hpp"
#include "rpc/contact/rounding.hpp"
#include "rpc/contact/surface/height_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

/// What a height grid finds: nearest points, and places where a way crosses it.
namespace rpc::contact
{
namespace
{

/// How far its searches go, where rounding or a level way could make them endless.
struct HeightSearch {
  static constexpr int parts_of_a_way =
      4; ///< through a cell, at whose ends the signs of heights above the surface are compared
  static constexpr int root_steps = 200;
  static constexpr int nearest_steps = 30;
  static constexpr double least_step = 1e-6; ///< of Newton's
  static constexpr int periods = 64;         ///< that a way is followed over, before it counts as level
};

/// Where a function is 0 that is not negative at the first place and not positive at the second: by the secant, in turn with halving.
template <class Function>
double root_between(double before, double after, const Function &f)
{
  double high = f(before), low = f(after);
  for (int step = 0; step < HeightSearch::root_steps; ++step) {
    if (high <= 0) return before;
    if (low >= 0) return after;
    if (after - before <= 2 * std::numeric_limits<double>::epsilon() * std::abs(after)) break;
    const double secant = before + (after - before) * high / (high - low), middle = (before + after) / 2;
    const double at = step % 3 == 2 ? middle : secant, value = f(at);
    if (value > 0) {
      if (at == before) return at;
      before = at;
      high = value;
    } else {
      if (at == after) return at;
      after = at;
      low = value;
    }
  }
  return (before + after) / 2;
}

} // namespace

std::array<Interval, 2> HeightGrid::footprint(const Part &part) const
{
  std::array<Interval, 2> print;
  const std::array<double, 2> size = extent();
  const std::array<int, 2> at{part.i, part.j};
  for (int c = 0; c < 2; ++c) {
    if (cells_[c] == 0) continue; // a profile goes on for ever
    const double from = part.period[c] * size[c];
    const int first = at[c] << part.level, last = std::min((at[c] + 1) << part.level, cells_[c]);
    print[c] = {from + first * spacing_[c], from + last * spacing_[c]};
  }
  return print;
}

/// Goes through cells, those first whose bounds are least.
/// @param bound  of a footprint and heights in it, on the square of a distance
/// @param wants  whether to go on to a bound
template <class Bound, class Wants, class Visit>
void HeightGrid::search(const Box &box, const Bound &bound, const Wants &wants, const Visit &visit) const
{
  std::priority_queue<Part> parts;
  const auto add = [&](Part part) {
    part.bound = bound(footprint(part), levels_[part.level].at(part.i, part.j));
    parts.push(part);
  };
  const std::array<double, 2> size = extent();
  std::array<std::array<int, 2>, 2> periods{};
  for (int c = 0; c < 2 && periodic_; ++c)
    if (cells_[c] > 0) { // two whole periods are over any place of a box that is as wide as one
      const int first = static_cast<int>(std::floor(box.low[c] / size[c])) - 1;
      periods[c] = {first, std::min(static_cast<int>(std::floor(box.high[c] / size[c])) + 1, first + 3)};
    }
  const int top = static_cast<int>(levels_.size()) - 1;
  for (int q = periods[1][0]; q <= periods[1][1]; ++q)
    for (int p = periods[0][0]; p <= periods[0][1]; ++p) add({0, top, 0, 0, {p, q}});
  while (!parts.empty() && wants(parts.top().bound)) {
    const Part part = parts.top();
    parts.pop();
    if (part.level == 0) {
      visit(part);
      continue;
    }
    const Level &below = levels_[part.level - 1];
    for (int j = 2 * part.j; j < std::min(2 * part.j + 2, below.size[1]); ++j)
      for (int i = 2 * part.i; i < std::min(2 * part.i + 2, below.size[0]); ++i)
        add({0, part.level - 1, i, j, part.period});
  }
}

HeightGrid::Nearest HeightGrid::nearest(const Point &x) const
{
  const std::array<double, 2> size = extent();
  const int directions = is_profile() ? 1 : 2;
  constexpr double endless = std::numeric_limits<double>::infinity();
  double best = endless;
  Nearest found;
  /// The nearest point of a cell, from the nearest of some of its places: Newton's method, within the cell.
  const auto look_at = [&](const Part &part) {
    const Patch patch = this->patch(part.i, part.j);
    const std::array<int, 2> cell{part.i, part.j};
    const std::array<double, 2> from{part.period[0] * size[0] + part.i * spacing_[0],
                                     part.period[1] * size[1] + part.j * spacing_[1]};
    const auto way = [&](const std::array<double, 2> &t, const double height) {
      return Point{from[0] + t[0] * spacing_[0] - x[0], directions == 1 ? 0 : from[1] + t[1] * spacing_[1] - x[1],
                   height - x[2]};
    };
    const auto squared = [&](const std::array<double, 2> &t) {
      const Point d = way(t, patch.height(t[0], t[1]));
      return inner(d, d);
    };
    std::array<double, 2> t{0.5, 0.5};
    double least = endless;
    for (const double v : {0.5, 0., 1.})
      for (const double u : {0.5, 0., 1.}) {
        const double here = squared({u, v});
        if (here < least) t = {u, v};
        least = std::min(least, here);
      }
    for (int step = 0; step < HeightSearch::nearest_steps; ++step) {
      const Patch::Jet jet = patch.at(t[0], t[1]);
      const Point d = way(t, jet.height);
      const std::array<double, 2> slope{jet.u, jet.v};
      std::array<double, 2> gradient{}, move{};
      std::array<bool, 2> free{};
      for (int c = 0; c < directions; ++c) {
        gradient[c] = d[c] * spacing_[c] + d[2] * slope[c];
        free[c] = !(t[c] <= 0 && gradient[c] > 0) && !(t[c] >= 1 && gradient[c] < 0);
      }
      const double metric[3] = {spacing_[0] * spacing_[0] + jet.u * jet.u, jet.u * jet.v,
                                spacing_[1] * spacing_[1] + jet.v * jet.v};
      double H[3] = {metric[0] + d[2] * jet.uu, metric[1] + d[2] * jet.uv, metric[2] + d[2] * jet.vv};
      const bool two = directions == 2 && free[0] && free[1];
      const auto is_convex = [&](const double *const h) {
        if (two) return h[0] > 0 && h[0] * h[2] > h[1] * h[1];
        return (!free[0] || h[0] > 0) && (!free[1] || directions == 1 || h[2] > 0);
      };
      if (!is_convex(H)) std::copy_n(metric, 3, H);
      if (two) {
        const double det = H[0] * H[2] - H[1] * H[1];
        move = {-(H[2] * gradient[0] - H[1] * gradient[1]) / det, -(H[0] * gradient[1] - H[1] * gradient[0]) / det};
      } else {
        for (int c = 0; c < directions; ++c)
          if (free[c]) move[c] = -gradient[c] / H[2 * c];
      }
      std::array<double, 2> next = t;
      double there = least;
      double share = 1;
      for (; share > HeightSearch::least_step; share /= 2) {
        for (int c = 0; c < directions; ++c) next[c] = std::clamp(t[c] + share * move[c], 0., 1.);
        there = squared(next);
        if (there <= least) break;
      }
      const double moved = std::max(std::abs(next[0] - t[0]), std::abs(next[1] - t[1]));
      if (!(there <= least) || !(moved > 0)) break;
      t = next;
      least = there;
      if (moved < Rounding::sum) break;
    }
    if (!(least < best)) return;
    best = least;
    const Patch::Jet jet = patch.at(t[0], t[1]);
    const Point normal{-jet.u / spacing_[0], -jet.v / spacing_[1], 1};
    found.point = {from[0] + t[0] * spacing_[0], directions == 1 ? x[1] : from[1] + t[1] * spacing_[1], jet.height};
    found.normal = scaled(1 / length(normal), normal);
    found.at_edge = false;
    for (int c = 0; c < directions && !periodic_; ++c)
      found.at_edge |= (cell[c] == 0 && t[c] <= 0) || (cell[c] == cells_[c] - 1 && t[c] >= 1);
  };
  const auto bound = [&](const std::array<Interval, 2> &print, const Interval &z) {
    const double a = outside(x[0], print[0]), b = outside(x[1], print[1]), c = outside(x[2], z);
    return a * a + b * b + c * c;
  };
  search(
      {x, x}, bound, [&](const double least) { return least < best; }, look_at);
  return found;
}

double HeightGrid::clearance(const Box &box) const
{
  constexpr double endless = std::numeric_limits<double>::infinity();
  const auto bound = [&](const std::array<Interval, 2> &print, const Interval &z) {
    const double a = apart({box.low[0], box.high[0]}, print[0]), b = apart({box.low[1], box.high[1]}, print[1]),
                 c = apart({box.low[2], box.high[2]}, {-endless, z.high});
    return a * a + b * b + c * c;
  };
  double least = endless; // the first cell that comes is the nearest one
  search(
      box, bound, [&](double) { return least == endless; }, [&](const Part &part) { least = part.bound; });
  return std::sqrt(least);
}

std::optional<double> HeightGrid::crossing(const Point &x, const Point &direction) const
{
  const double descent = -direction[2];
  if (!(descent > Rounding::place)) return std::nullopt;
  const bool covered = covers(x[0], x[1]);
  const double across = std::hypot(direction[0], direction[1]);
  if (!(across > Rounding::place)) {
    if (!covered) return std::nullopt;
    return above(x) / descent;
  }
  const bool inside = covered && above(x) < 0;
  const double sign = inside ? -1 : 1; // the way back leads up
  const Interval heights = this->heights();
  // From where the way may meet the surface to where it must have met it.
  double s = inside ? 0 : std::max(0., (x[2] - heights.high) / descent);
  double end = inside ? (heights.high - x[2]) / descent : (x[2] - heights.low) / descent;
  end += Rounding::place * (std::abs(end) + heights.high - heights.low);
  const int directions = is_profile() ? 1 : 2;
  const std::array<double, 2> size = extent();
  for (int c = 0; c < directions && !periodic_; ++c) { // to the part over the surface
    const double way = sign * direction[c], slack = Rounding::place * size[c];
    if (way == 0) {
      if (outside(x[c], {0, size[c]}) > slack) return std::nullopt;
      continue;
    }
    const double to_low = (-slack - x[c]) / way, to_high = (size[c] + slack - x[c]) / way;
    s = std::max(s, std::min(to_low, to_high));
    end = std::min(end, std::max(to_low, to_high));
  }
  if (periodic_)
    for (int c = 0; c < directions; ++c) end = std::min(end, s + HeightSearch::periods * size[c] / across);
  const auto place = [&](const double way) {
    return Point{x[0] + sign * way * direction[0], x[1] + sign * way * direction[1], x[2] + sign * way * direction[2]};
  };
  const auto f = [&](const double way) { return sign * above(place(way)); }; // from >= 0 to below
  if (f(s) < 0) return std::nullopt;                                         // it comes from beside, below the edge
  while (s < end) {
    const Point at = place(s);
    // To the end of the cell.
    double next = end;
    for (int c = 0; c < directions; ++c) {
      const double way = sign * direction[c] / spacing_[c];
      if (way == 0) continue;
      const double t = at[c] / spacing_[c];
      double line = way > 0 ? std::floor(t) + 1 : std::ceil(t) - 1;
      if (std::abs(line - t) < Rounding::sum * (1 + std::abs(t))) line += way > 0 ? 1 : -1;
      next = std::min(next, s + (line - t) / way);
    }
    const Point middle = place((s + next) / 2), to = place(next);
    const Interval range = levels_.front().at(cell_of(middle[0], 0).first, cell_of(middle[1], 1).first);
    const bool passes = inside ? std::max(at[2], to[2]) < range.low : std::min(at[2], to[2]) > range.high;
    double before = s;
    for (int k = 1; k <= HeightSearch::parts_of_a_way && !passes; ++k) {
      const double after = s + (next - s) * k / HeightSearch::parts_of_a_way;
      if (f(after) <= 0) return sign * root_between(before, after, f);
      before = after;
    }
    s = next;
  }
  return std::nullopt;
}

} // namespace rpc::contact
