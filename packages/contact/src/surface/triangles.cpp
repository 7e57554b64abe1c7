// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/triangles.hpp"

#include "rpc/contact/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

namespace rpc::contact
{
namespace
{

Point sum_of(const Point &a, const Point &b)
{
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

Point unit_of(const Point &v)
{
  return scaled(1 / length(v), v);
}

Point area_vector(const Triangles &t, const std::size_t k)
{
  const auto &[a, b, c] = t.corners[k];
  return scaled(0.5, cross(difference(t.points[b], t.points[a]), difference(t.points[c], t.points[a])));
}

std::string shown_place(const Point &x)
{
  std::ostringstream text;
  text << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return text.str();
}

/// Directed edges, and the triangle of each.
using Edges = std::map<std::pair<int, int>, std::size_t>;

/// Triangles that are joined over edges.
struct ConnectedPart {
  std::vector<std::size_t> triangles;
  Bounds bounds = Bounds::empty();
  double six_volumes = 0; ///< < 0 where they look inwards
  double sizes = 0;       ///< of its terms
};

/// @param neighbours  (triangles, edges) the triangle beyond each edge
std::vector<ConnectedPart> parts_of(const Triangles &t, const std::vector<std::array<std::size_t, 3>> &neighbours)
{
  std::vector<ConnectedPart> parts;
  std::vector<char> seen(t.corners.size(), 0);
  for (std::size_t first = 0; first < t.corners.size(); ++first) {
    if (seen[first] != 0) continue;
    seen[first] = 1;
    ConnectedPart part;
    part.triangles = {first};
    for (std::size_t n = 0; n < part.triangles.size(); ++n) {
      const std::size_t triangle = part.triangles[n];
      const auto &each = t.corners[triangle];
      const double here = 2 * inner(area_vector(t, triangle), t.points[each[0]]);
      part.six_volumes += here;
      part.sizes += std::abs(here);
      for (int k = 0; k < 3; ++k) {
        part.bounds.add(t.points[each[k]]);
        const std::size_t other = neighbours[triangle][k];
        if (std::exchange(seen[other], 1) == 0) part.triangles.push_back(other);
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

/// How often a part surrounds x, off its surface: 1 within, 0 outside; less that where it looks inwards.
double times_around(const Triangles &t, const ConnectedPart &part, const Point &x)
{
  double angle =
      0; // solid, of the triangles seen from x: A. van Oosterom, J. Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125
  for (const std::size_t n : part.triangles) {
    Point a[3];
    for (int k = 0; k < 3; ++k) a[k] = difference(t.points[t.corners[n][k]], x);
    const double l[3] = {length(a[0]), length(a[1]), length(a[2])};
    angle += 2 * std::atan2(inner(a[0], cross(a[1], a[2])), l[0] * l[1] * l[2] + inner(a[0], a[1]) * l[2] +
                                                                inner(a[1], a[2]) * l[0] + inner(a[2], a[0]) * l[1]);
  }
  return angle / (4 * 3.14159265358979323846);
}

/// The first part that looks inwards and is no cavity of another one; none: null.
const ConnectedPart *part_inside_out(const Triangles &t, const std::vector<ConnectedPart> &parts)
{
  for (const ConnectedPart &part : parts) {
    if (!(part.six_volumes < -Rounding::place * part.sizes)) continue; // a fin without thickness has none
    const Point &x = t.points[t.corners[part.triangles.front()][0]];
    double around = 0;
    for (const ConnectedPart &other : parts)
      if (&other != &part && !(other.bounds.nearest(x) > 0)) around += times_around(t, other, x);
    if (around < 0.5) return &part;
  }
  return nullptr;
}

} // namespace

std::string fault_of(const Triangles &t)
{
  constexpr const char *mend = "; mend it in the program that made it, or in a program for meshes such as MeshLab";
  double longest = 0;
  for (const auto &each : t.corners)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, length(difference(t.points[each[(k + 1) % 3]], t.points[each[k]])));
  Edges edges;
  for (std::size_t n = 0; n < t.corners.size(); ++n) {
    const auto &each = t.corners[n];
    const Point area = area_vector(t, n), &a = t.points[each[0]];
    double edge = 0;
    for (int k = 0; k < 3; ++k)
      edge = std::max(edge, length(difference(t.points[each[(k + 1) % 3]], t.points[each[k]])));
    if (!(length(area) > Rounding::place * edge * edge))
      return "facet " + std::to_string(n + 1) + " at " + shown_place(a) + " has no area" + mend;
    for (int k = 0; k < 3; ++k) {
      const std::pair<int, int> here{each[k], each[(k + 1) % 3]};
      const auto [other, is_new] = edges.emplace(here, n);
      if (!is_new)
        return "facets " + std::to_string(other->second + 1) + " and " + std::to_string(n + 1) +
               " turn different ways, or lie on each other: both have the edge from " +
               shown_place(t.points[here.first]) + " to " + shown_place(t.points[here.second]) + mend;
    }
  }
  std::vector<std::array<std::size_t, 3>> neighbours(t.corners.size());
  for (const auto &[edge, n] : edges) {
    const auto other = edges.find({edge.second, edge.first});
    if (other == edges.end())
      return "there is a hole: facet " + std::to_string(n + 1) + " has no neighbour at its edge from " +
             shown_place(t.points[edge.first]) + " to " + shown_place(t.points[edge.second]) +
             "; the surface must be closed, also below the side" + mend;
    neighbours[n][std::find(t.corners[n].begin(), t.corners[n].end(), edge.first) - t.corners[n].begin()] =
        other->second;
  }
  if (t.corners.empty()) return "there are no facets; name a file that has some";
  const std::vector<ConnectedPart> parts = parts_of(t, neighbours);
  const double six_volumes =
      std::accumulate(parts.begin(), parts.end(), 0.,
                      [](const double sum, const ConnectedPart &part) { return sum + part.six_volumes; });
  const ConnectedPart *const wrong = parts.size() > 1 ? part_inside_out(t, parts) : nullptr;
  if (wrong)
    return "the " + std::to_string(wrong->triangles.size()) + " facets of the part at " +
           shown_place(t.points[t.corners[wrong->triangles.front()][0]]) +
           " point inwards, and it is no cavity of another one; turn them round" + mend;
  if (!(six_volumes > 0)) return "its facets all point inwards; turn them round";
  return "";
}

ClosedSurface::ClosedSurface(Triangles triangles)
    : triangles_(std::move(triangles)), corner_normal_(triangles_.points.size(), Point{}),
      beyond_(triangles_.corners.size()), order_(triangles_.corners.size())
{
  Edges edges;
  for (std::size_t n = 0; n < size(); ++n) {
    const Point unit = unit_of(area_vector(triangles_, n));
    normal_.push_back(unit);
    for (int k = 0; k < 3; ++k) {
      const Point &here = corner(n, k), to = difference(corner(n, (k + 1) % 3), here),
                  from = difference(corner(n, (k + 2) % 3), here);
      const double angle = std::atan2(length(cross(to, from)), inner(to, from));
      Point &sum = corner_normal_[triangles_.corners[n][k]];
      sum = sum_of(sum, scaled(angle, unit));
      edges[{triangles_.corners[n][k], triangles_.corners[n][(k + 1) % 3]}] = n;
      mean_edge_ += length(to) / (3. * static_cast<double>(size()));
    }
  }
  for (Point &normal : corner_normal_)
    if (length(normal) > 0) normal = unit_of(normal);
  for (std::size_t n = 0; n < size(); ++n)
    for (int k = 0; k < 3; ++k)
      beyond_[n][k] = normal_[edges.at({triangles_.corners[n][(k + 1) % 3], triangles_.corners[n][k]})];
  std::iota(order_.begin(), order_.end(), std::size_t(0));
  add_box(0, size());
}

void ClosedSurface::add_box(const std::size_t first, const std::size_t last)
{
  const std::size_t here = boxes_.size();
  Box box{Bounds::empty(), first, last, 0};
  for (std::size_t n = first; n < last; ++n)
    for (int k = 0; k < 3; ++k) box.bounds.add(corner(order_[n], k));
  boxes_.push_back(box);
  if (last - first > few) {
    const int axis = box.bounds.longest();
    const auto place = [&](const std::size_t n) {
      return corner(n, 0)[axis] + corner(n, 1)[axis] + corner(n, 2)[axis];
    };
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](const std::size_t n) { return order_.begin() + static_cast<std::ptrdiff_t>(n); };
    std::nth_element(at(first), at(middle), at(last),
                     [&](const std::size_t a, const std::size_t b) { return place(a) < place(b); });
    add_box(first, middle);
    add_box(middle, last);
  }
  boxes_[here].next = boxes_.size();
}

Bounds ClosedSurface::bounds() const
{
  return boxes_.front().bounds;
}

ClosedSurface::Foot ClosedSurface::foot_on(const std::size_t triangle, const Point &x) const
{
  // By the regions of the plane around the triangle: C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
  std::array<Point, 3> from{}; // from corners to x
  std::array<Point, 3> edge{};
  for (int k = 0; k < 3; ++k) {
    from[k] = difference(x, corner(triangle, k));
    edge[k] = difference(corner(triangle, (k + 1) % 3), corner(triangle, k));
  }
  std::array<double, 3> weights{};
  Point normal = normal_[triangle];
  const auto finish = [&]() {
    Foot foot;
    foot.normal = normal;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) {
        foot.place[c] += weights[k] * corner(triangle, k)[c];
        foot.smooth[c] += weights[k] * corner_normal_[triangles_.corners[triangle][k]][c];
      }
    foot.distance = length(difference(x, foot.place));
    return foot;
  };
  for (int k = 0; k < 3; ++k) {
    const int last = (k + 2) % 3;
    if (!(inner(from[k], edge[k]) > 0) && !(inner(from[k], edge[last]) < 0)) { // nearest to corner k
      weights[k] = 1;
      normal = corner_normal_[triangles_.corners[triangle][k]];
      return finish();
    }
  }
  for (int k = 0; k < 3; ++k) {
    const double along = inner(from[k], edge[k]) / inner(edge[k], edge[k]);
    const double outside = inner(cross(edge[k], normal_[triangle]), from[k]);
    if (along > 0 && along < 1 && !(outside < 0)) { // nearest to the edge from corner k to the next
      weights[k] = 1 - along;
      weights[(k + 1) % 3] = along;
      normal = sum_of(normal_[triangle], beyond_[triangle][k]);
      // Of two triangles that lie on each other the edge looks away from both.
      normal = unit_of(length(normal) > Rounding::place ? normal : cross(edge[k], normal_[triangle]));
      return finish();
    }
  }
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    weights[(k + 2) % 3] = inner(cross(edge[k], from[k]), normal_[triangle]); // as areas
    sum += weights[(k + 2) % 3];
  }
  for (double &weight : weights) weight /= sum;
  return finish();
}

ClosedSurface::Foot ClosedSurface::nearest(const Point &x) const
{
  Foot best;
  best.distance = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, std::size_t>> open{
      {boxes_.front().bounds.nearest(x), 0}}; // squared distances and boxes
  while (!open.empty()) {
    const auto [square, k] = open.back();
    open.pop_back();
    if (square > best.distance * best.distance) continue;
    const Box &box = boxes_[k];
    if (box.last - box.first <= few) {
      for (std::size_t n = box.first; n < box.last; ++n) {
        const Foot foot = foot_on(order_[n], x);
        if (foot.distance < best.distance) best = foot;
      }
      continue;
    }
    const std::size_t parts[2] = {k + 1, boxes_[k + 1].next};
    const double near[2] = {boxes_[parts[0]].bounds.nearest(x), boxes_[parts[1]].bounds.nearest(x)};
    const int later = near[0] < near[1] ? 1 : 0; // the nearer one is taken next
    open.emplace_back(near[later], parts[later]);
    open.emplace_back(near[1 - later], parts[1 - later]);
  }
  best.smooth = length(best.smooth) > 0 ? unit_of(best.smooth) : best.normal;
  return best;
}

std::vector<ClosedSurface::Crossing> ClosedSurface::crossings(const Point &x, const Point &direction) const
{
  std::vector<Crossing> found;
  for (std::size_t k = 0; k < boxes_.size();) {
    const Box &box = boxes_[k];
    const bool met = box.bounds.meets_line(x, direction);
    for (std::size_t n = box.first; n < box.last && met && box.last - box.first <= few; ++n) {
      const std::size_t triangle = order_[n];
      const double descent = -inner(normal_[triangle], direction);
      if (!(std::abs(descent) > Rounding::place)) continue;
      std::array<Point, 3> seen{};
      for (int c = 0; c < 3; ++c) seen[c] = difference(corner(triangle, c), x);
      double least = std::numeric_limits<double>::infinity(), sum = 0;
      for (int c = 0; c < 3; ++c) { // of the corners, as areas seen along the line; their sum has the sign of -descent
        const double weight = inner(cross(seen[(c + 1) % 3], seen[(c + 2) % 3]), direction) * (descent > 0 ? -1 : 1);
        least = std::min(least, weight);
        sum += weight;
      }
      if (least >= -Rounding::place * sum) found.push_back({-inner(seen[0], normal_[triangle]) / descent, descent});
    }
    k = met ? k + 1 : box.next;
  }
  return found;
}

} // namespace rpc::contact
