#include "size_tree.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace rpc::mesh
{
namespace
{

constexpr int most_in_leaf = 4;

double square_of_distance(const std::array<double, 2> &low, const std::array<double, 2> &high,
                          const std::array<double, 2> &at)
{
  double square = 0;
  for (int d = 0; d < 2; ++d) {
    const double apart = std::max({low[d] - at[d], at[d] - high[d], 0.});
    square += apart * apart;
  }
  return square;
}

} // namespace

SizeTree::SizeTree(const SizeField &field)
{
  std::vector<Triangle> triangles(field.triangles.size() / 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int v = 0; v < 3; ++v) {
      const std::size_t node = field.triangles[3 * t + v];
      triangles[t].vertex[v] = {field.coords[2 * node], field.coords[2 * node + 1]};
      triangles[t].size[v] = field.size[node];
    }
  std::vector<Place> order(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    order[t].triangle = static_cast<int>(t);
    for (const Point &vertex : triangles[t].vertex)
      for (int d = 0; d < 2; ++d) order[t].centre[d] += vertex[d];
  }
  boxes_.reserve(triangles.size());
  triangles_.reserve(triangles.size());
  boxes_.emplace_back();
  divide(0, triangles, order, 0, static_cast<int>(order.size()));
}

void SizeTree::divide(const int box, const std::vector<Triangle> &triangles, std::vector<Place> &order, const int first,
                      const int last)
{
  constexpr double inf = std::numeric_limits<double>::infinity();
  Point low{inf, inf}, high{-inf, -inf};
  for (int k = first; k < last; ++k)
    for (const Point &vertex : triangles[order[k].triangle].vertex)
      for (int d = 0; d < 2; ++d) {
        low[d] = std::min(low[d], vertex[d]);
        high[d] = std::max(high[d], vertex[d]);
      }
  boxes_[box].low = low;
  boxes_[box].high = high;
  if (last - first <= most_in_leaf) {
    boxes_[box].first = static_cast<int>(triangles_.size());
    boxes_[box].count = last - first;
    for (int k = first; k < last; ++k) triangles_.push_back(triangles[order[k].triangle]);
    return;
  }
  const int d = high[0] - low[0] >= high[1] - low[1] ? 0 : 1, middle = first + (last - first) / 2;
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last,
                   [d](const Place &a, const Place &b) {
                     return a.centre[d] < b.centre[d] || (a.centre[d] == b.centre[d] && a.triangle < b.triangle);
                   });
  const int below = static_cast<int>(boxes_.size());
  boxes_[box].first = below;
  boxes_.resize(boxes_.size() + 2);
  divide(below, triangles, order, first, middle);
  divide(below + 1, triangles, order, middle, last);
}

SizeTree::Nearest SizeTree::nearest(const Triangle &triangle, const Point &at)
{
  std::array<Point, 3> arm; // from the point to the vertices
  for (int v = 0; v < 3; ++v) arm[v] = {triangle.vertex[v][0] - at[0], triangle.vertex[v][1] - at[1]};
  const auto cross = [&](const int a, const int b) { return arm[a][0] * arm[b][1] - arm[a][1] * arm[b][0]; };
  const double part[3] = {cross(1, 2), cross(2, 0), cross(0, 1)}, whole = part[0] + part[1] + part[2];
  if (whole != 0 && part[0] / whole >= 0 && part[1] / whole >= 0 && part[2] / whole >= 0)
    return {0, (part[0] * triangle.size[0] + part[1] * triangle.size[1] + part[2] * triangle.size[2]) / whole};

  Nearest best{std::numeric_limits<double>::infinity(), triangle.size[0]};
  for (int v = 0; v < 3; ++v) {
    const int w = (v + 1) % 3;
    const Point edge = {arm[w][0] - arm[v][0], arm[w][1] - arm[v][1]};
    const double length = edge[0] * edge[0] + edge[1] * edge[1]; // squared
    double t = length > 0 ? -(arm[v][0] * edge[0] + arm[v][1] * edge[1]) / length : 0;
    t = std::clamp(t, 0., 1.);
    const Point foot = {arm[v][0] + t * edge[0], arm[v][1] + t * edge[1]};
    const double square = foot[0] * foot[0] + foot[1] * foot[1];
    if (square < best.square) best = {square, (1 - t) * triangle.size[v] + t * triangle.size[w]};
  }
  return best;
}

double SizeTree::operator()(const double x, const double y) const
{
  const Point at{x, y};
  Nearest best{std::numeric_limits<double>::infinity(), boxes_.empty() ? 0 : triangles_[0].size[0]};
  std::array<std::pair<double, int>, 64> open; // a halving tree is 31 deep at most
  int num_open = 0;
  open[num_open++] = {0, 0};
  while (num_open > 0 && best.square > 0) {
    const auto [square, number] = open[--num_open];
    if (square >= best.square) continue;
    const Box &box = boxes_[number];
    for (int t = box.first; t < box.first + box.count; ++t) {
      const Nearest here = nearest(triangles_[t], at);
      if (here.square < best.square) best = here;
    }
    if (box.count > 0) continue;
    std::pair<double, int> near{0, box.first}, far{0, box.first + 1};
    for (auto *const half : {&near, &far})
      half->first = square_of_distance(boxes_[half->second].low, boxes_[half->second].high, at);
    if (far.first < near.first) std::swap(near, far);
    open[num_open++] = far;
    open[num_open++] = near;
  }
  return best.size;
}

} // namespace rpc::mesh
