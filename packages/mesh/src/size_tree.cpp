// SPDX-License-Identifier: BSD-3-Clause
#include "size_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace rpc::mesh
{
namespace
{

constexpr int most_in_leaf = 4;

template <std::size_t dim>
double square_of_distance(const std::array<double, dim> &low, const std::array<double, dim> &high,
                          const std::array<double, dim> &at)
{
  double square = 0;
  for (std::size_t d = 0; d < dim; ++d) {
    const double apart = std::max({low[d] - at[d], at[d] - high[d], 0.});
    square += apart * apart;
  }
  return square;
}

/// A point and the size there, among those of a simplex nearest to another point.
struct NearestSize {
  double square; // of the distance; 0 inside
  double size;
};

/// By the arms from a point to the ends of an edge.
template <std::size_t dim>
NearestSize nearest_on_edge(const std::array<double, dim> &from, const std::array<double, dim> &to,
                            const double size_from, const double size_to)
{
  double length = 0, along = 0; // squared; times the length
  for (std::size_t d = 0; d < dim; ++d) {
    const double edge = to[d] - from[d];
    length += edge * edge;
    along -= from[d] * edge;
  }
  const double t = std::clamp(length > 0 ? along / length : 0, 0., 1.);
  double square = 0;
  for (std::size_t d = 0; d < dim; ++d) {
    const double foot = from[d] + t * (to[d] - from[d]);
    square += foot * foot;
  }
  return {square, (1 - t) * size_from + t * size_to};
}

/// By the arms from a point to the vertices of a triangle, whose inside is not asked.
template <std::size_t dim>
NearestSize nearest_on_edges(const std::array<std::array<double, dim>, 3> &arm, const std::array<double, 3> &size)
{
  NearestSize best{std::numeric_limits<double>::infinity(), size[0]};
  for (int v = 0; v < 3; ++v) {
    const int w = (v + 1) % 3;
    const NearestSize here = nearest_on_edge(arm[v], arm[w], size[v], size[w]);
    if (here.square < best.square) best = here;
  }
  return best;
}

using Arm = std::array<double, 3>;

double dot(const Arm &a, const Arm &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Arm cross(const Arm &a, const Arm &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// By the arms from a point to the vertices of a triangle in space.
NearestSize nearest_on_triangle(const std::array<Arm, 3> &arm, const std::array<double, 3> &size)
{
  const Arm ab = {arm[1][0] - arm[0][0], arm[1][1] - arm[0][1], arm[1][2] - arm[0][2]},
            ac = {arm[2][0] - arm[0][0], arm[2][1] - arm[0][1], arm[2][2] - arm[0][2]}, normal = cross(ab, ac);
  const double whole = dot(normal, normal); // 4 times the squared area
  if (whole > 0) {
    double part[3];
    for (int v = 0; v < 3; ++v) part[v] = dot(normal, cross(arm[(v + 1) % 3], arm[(v + 2) % 3])) / whole;
    if (part[0] >= 0 && part[1] >= 0 && part[2] >= 0) {
      const double height = dot(normal, arm[0]);
      return {height * height / whole, part[0] * size[0] + part[1] * size[1] + part[2] * size[2]};
    }
  }
  return nearest_on_edges(arm, size);
}

NearestSize nearest_in(const std::array<std::array<double, 2>, 3> &arm, const std::array<double, 3> &size)
{
  const auto cross = [&](const int a, const int b) { return arm[a][0] * arm[b][1] - arm[a][1] * arm[b][0]; };
  const double part[3] = {cross(1, 2), cross(2, 0), cross(0, 1)}, whole = part[0] + part[1] + part[2];
  if (whole != 0 && part[0] / whole >= 0 && part[1] / whole >= 0 && part[2] / whole >= 0)
    return {0, (part[0] * size[0] + part[1] * size[1] + part[2] * size[2]) / whole};
  return nearest_on_edges(arm, size);
}

NearestSize nearest_in(const std::array<Arm, 4> &arm, const std::array<double, 4> &size)
{
  // Six times the signed volumes of the tetrahedra that the point makes with the faces, and of the whole.
  const double part[4] = {dot(arm[1], cross(arm[2], arm[3])), -dot(arm[0], cross(arm[2], arm[3])),
                          dot(arm[0], cross(arm[1], arm[3])), -dot(arm[0], cross(arm[1], arm[2]))};
  const double whole = part[0] + part[1] + part[2] + part[3];
  if (whole != 0 && part[0] / whole >= 0 && part[1] / whole >= 0 && part[2] / whole >= 0 && part[3] / whole >= 0)
    return {0, (part[0] * size[0] + part[1] * size[1] + part[2] * size[2] + part[3] * size[3]) / whole};
  NearestSize best{std::numeric_limits<double>::infinity(), size[0]};
  for (int opposite = 0; opposite < 4; ++opposite) {
    const int a = opposite == 0 ? 1 : 0, b = opposite <= 1 ? 2 : 1, c = opposite <= 2 ? 3 : 2;
    const NearestSize here = nearest_on_triangle({arm[a], arm[b], arm[c]}, {size[a], size[b], size[c]});
    if (here.square < best.square) best = here;
  }
  return best;
}

} // namespace

template <int dim>
SizeTree<dim>::SizeTree(const SizeField &field)
{
  std::vector<Simplex> simplices(field.simplices.size() / vertices);
  for (std::size_t t = 0; t < simplices.size(); ++t)
    for (int v = 0; v < vertices; ++v) {
      const std::size_t node = field.simplices[vertices * t + v];
      std::copy_n(&field.coords[dim * node], dim, simplices[t].vertex[v].begin());
      simplices[t].size[v] = field.size[node];
    }
  std::vector<Place> order(simplices.size());
  for (std::size_t t = 0; t < simplices.size(); ++t) {
    order[t].simplex = static_cast<int>(t);
    for (const Point &vertex : simplices[t].vertex)
      for (int d = 0; d < dim; ++d) order[t].centre[d] += vertex[d];
  }
  boxes_.reserve(simplices.size());
  simplices_.reserve(simplices.size());
  boxes_.emplace_back();
  divide(0, simplices, order, 0, static_cast<int>(order.size()));
}

template <int dim>
void SizeTree<dim>::divide(const int box, const std::vector<Simplex> &simplices, std::vector<Place> &order,
                           const int first, const int last)
{
  constexpr double inf = std::numeric_limits<double>::infinity();
  Point low, high;
  low.fill(inf);
  high.fill(-inf);
  for (int k = first; k < last; ++k)
    for (const Point &vertex : simplices[order[k].simplex].vertex)
      for (int d = 0; d < dim; ++d) {
        low[d] = std::min(low[d], vertex[d]);
        high[d] = std::max(high[d], vertex[d]);
      }
  boxes_[box].low = low;
  boxes_[box].high = high;
  if (last - first <= most_in_leaf) {
    boxes_[box].first = static_cast<int>(simplices_.size());
    boxes_[box].count = last - first;
    for (int k = first; k < last; ++k) simplices_.push_back(simplices[order[k].simplex]);
    return;
  }
  int d = 0; // the first of the longest directions
  for (int other = 1; other < dim; ++other)
    if (high[other] - low[other] > high[d] - low[d]) d = other;
  const int middle = first + (last - first) / 2;
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last,
                   [d](const Place &a, const Place &b) {
                     return a.centre[d] < b.centre[d] || (a.centre[d] == b.centre[d] && a.simplex < b.simplex);
                   });
  const int below = static_cast<int>(boxes_.size());
  boxes_[box].first = below;
  boxes_.resize(boxes_.size() + 2);
  divide(below, simplices, order, first, middle);
  divide(below + 1, simplices, order, middle, last);
}

template <int dim>
double SizeTree<dim>::operator()(const Point &at) const
{
  const auto nearest = [&at](const Simplex &simplex) {
    std::array<Point, vertices> arm; // from the point to the vertices
    for (int v = 0; v < vertices; ++v)
      for (int d = 0; d < dim; ++d) arm[v][d] = simplex.vertex[v][d] - at[d];
    return nearest_in(arm, simplex.size);
  };
  NearestSize best{std::numeric_limits<double>::infinity(), boxes_.empty() ? 0 : simplices_[0].size[0]};
  std::array<std::pair<double, int>, 64> open; // a halving tree is 31 deep at most
  int num_open = 0;
  open[num_open++] = {0, 0};
  while (num_open > 0 && best.square > 0) {
    const auto [square, number] = open[--num_open];
    if (square >= best.square) continue;
    const Box &box = boxes_[number];
    for (int t = box.first; t < box.first + box.count; ++t) {
      const NearestSize here = nearest(simplices_[t]);
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

template class SizeTree<2>;
template class SizeTree<3>;

} // namespace rpc::mesh
