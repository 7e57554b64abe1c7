// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/facets.hpp"

#include "rpc/contact/rounding.hpp"
#include "rpc/core/exchange.hpp"
#include "rpc/core/rank_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace rpc::contact
{
namespace
{

constexpr double margin = 0.5; // of a facet, beyond the edge of the surface
constexpr std::size_t few = 4; // facets in a box that is not divided

/// A straight facet as weights of the nodes of the facet that it is a part of: (corners, nodes).
using Part = std::vector<std::vector<double>>;

/// The straight facets that stand for a facet of an element.
std::vector<Part> straight_parts(const mesh::Element &facet)
{
  const int order = facet.order, nodes = facet.num_nodes();
  std::map<std::array<int, 2>, int> node;
  for (int a = 0; a < nodes; ++a) node[{facet.lattice()[a][0], facet.dim == 2 ? facet.lattice()[a][1] : 0}] = a;
  std::vector<Part> parts;
  /// The mean of some places of the lattice.
  const auto at = [&](const std::vector<std::array<int, 2>> &places) {
    std::vector<double> weights(nodes, 0.);
    for (const auto &place : places) weights[node.at(place)] += 1. / static_cast<double>(places.size());
    return weights;
  };
  for (int i = 0; i < order && facet.dim == 1; ++i) parts.push_back({at({{i, 0}}), at({{i + 1, 0}})});
  for (int i = 0; i < order && facet.dim == 2; ++i)
    for (int j = 0; j < order; ++j) {
      const std::array<std::array<int, 2>, 4> around = {{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
      if (facet.shape == mesh::Shape::tensor) {
        const auto middle = at({around.begin(), around.end()});
        for (int k = 0; k < 4; ++k) parts.push_back({middle, at({around[k]}), at({around[(k + 1) % 4]})});
      } else {
        if (i + j < order) parts.push_back({at({around[0]}), at({around[1]}), at({around[3]})});
        if (i + j + 1 < order) parts.push_back({at({around[1]}), at({around[2]}), at({around[3]})});
      }
    }
  return parts;
}

} // namespace

StraightFacets straight_facets(const mesh::Element &facet, const std::vector<Point> &places,
                               const std::vector<double> &values)
{
  const std::size_t per_facet = facet.num_nodes();
  const auto parts = straight_parts(facet);
  StraightFacets straight;
  straight.dim = facet.dim + 1;
  for (std::size_t first = 0; first < values.size(); first += per_facet)
    for (const Part &part : parts)
      for (const auto &weights : part) {
        Point x{};
        double here = 0;
        for (std::size_t a = 0; a < per_facet; ++a) {
          for (int c = 0; c < straight.dim; ++c) x[c] += weights[a] * places[first + a][c];
          here += weights[a] * values[first + a];
        }
        straight.corners.insert(straight.corners.end(), x.begin(), x.begin() + straight.dim);
        straight.values.push_back(here);
      }
  return straight;
}

FacetSurface::FacetSurface(StraightFacets facets, const double beyond)
    : facets_(std::move(facets)), beyond_(beyond), order_(facets_.size())
{
  std::iota(order_.begin(), order_.end(), std::size_t(0));
  if (!order_.empty()) add_box(0, order_.size());
}

Point FacetSurface::corner(const std::size_t facet, const int k) const
{
  Point x{};
  for (int c = 0; c < facets_.dim; ++c) x[c] = facets_.corners[(facet * facets_.dim + k) * facets_.dim + c];
  return x;
}

void FacetSurface::add_box(const std::size_t first, const std::size_t last)
{
  const std::size_t here = boxes_.size();
  Box box{Bounds::empty(), first, last, 0};
  double longest = 0; // edge, of the facets
  for (std::size_t k = first; k < last; ++k)
    for (int a = 0; a < facets_.dim; ++a) {
      const Point x = corner(order_[k], a), edge = difference(corner(order_[k], (a + 1) % facets_.dim), x);
      longest = std::max(longest, length(edge));
      box.bounds.add(x);
    }
  const int axis = box.bounds.longest();
  // A place that counts to a triangle by `margin` on two of its sides lies off by an edge at most.
  const double around = std::max(beyond_, longest);
  for (int c = 0; c < 3; ++c) {
    box.bounds.lower[c] -= around;
    box.bounds.upper[c] += around;
  }
  boxes_.push_back(box);
  if (last - first > few) {
    const auto place = [&](const std::size_t facet) {
      double sum = 0;
      for (int a = 0; a < facets_.dim; ++a) sum += corner(facet, a)[axis];
      return sum;
    };
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](const std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(first), at(middle), at(last),
                     [&](const std::size_t a, const std::size_t b) { return place(a) < place(b); });
    add_box(first, middle);
    add_box(middle, last);
  }
  boxes_[here].next = boxes_.size();
}

namespace
{

/// Where a line meets the straight line or plane of a facet.
struct InFacet {
  std::array<double, 3> weights{}; // of the corners, their sum is 1
  double distance = 0;             // from x [m]
};

/// @param x  corners, seen from the line's point
std::optional<InFacet> meet(const int dim, const std::array<Point, 3> &x, const Point &direction)
{
  InFacet meeting;
  const Point along = difference(x[1], x[0]);
  if (dim == 2) {
    const Point normal = {along[1], -along[0], 0}; // as long as the facet
    const double facing = inner(normal, direction);
    if (!(facing > Rounding::place * length(along))) return std::nullopt;
    const Point across = {direction[1], -direction[0], 0};
    meeting.weights[1] = inner(x[0], across) / -inner(along, across);
    meeting.weights[0] = 1 - meeting.weights[1];
    meeting.distance = inner(x[0], normal) / facing;
    return meeting;
  }
  const Point other = difference(x[2], x[0]), normal = cross(along, other);
  const double facing = inner(normal, direction);
  if (!(facing > Rounding::place * length(normal))) return std::nullopt;
  for (int k = 0; k < 3; ++k) meeting.weights[k] = inner(cross(x[(k + 1) % 3], x[(k + 2) % 3]), direction) / facing;
  meeting.distance = inner(x[0], normal) / facing;
  return meeting;
}

} // namespace

std::optional<FacetSurface::Meeting> FacetSurface::along(const Point &x, const Point &direction) const
{
  const int dim = facets_.dim;
  std::optional<Meeting> first;
  const auto look_at = [&](const std::size_t facet) {
    std::array<Point, 3> seen{};
    for (int k = 0; k < dim; ++k) seen[k] = difference(corner(facet, k), x);
    const auto meeting = meet(dim, seen, direction);
    if (!meeting) return;
    std::array<double, 3> inside{};
    double sum = 0, deepest = 0;
    for (int k = 0; k < dim; ++k) {
      inside[k] = std::max(0., meeting->weights[k]);
      sum += inside[k];
      deepest = std::max(deepest, -meeting->weights[k]);
    }
    Point away{}; // from the facet
    double here = 0;
    for (int k = 0; k < dim; ++k) {
      inside[k] /= sum;
      here += inside[k] * facets_.values[facet * dim + k];
      for (int c = 0; c < 3; ++c) away[c] += (meeting->weights[k] - inside[k]) * seen[k][c];
    }
    double off = length(away);
    if (deepest > margin && off > beyond_ * (1 + Rounding::place)) return;
    if (deepest <= Rounding::place) off = 0;
    const Meeting found{off, std::abs(meeting->distance), here};
    if (!first || found.before(*first)) first = found;
  };
  for (std::size_t k = 0; k < boxes_.size();) {
    const Box &box = boxes_[k];
    const bool met = box.bounds.meets_line(x, direction);
    for (std::size_t n = box.first; n < box.last && met && box.last - box.first <= few; ++n) look_at(order_[n]);
    k = met ? k + 1 : box.next;
  }
  return first;
}

Bounds FacetSurface::bounds() const
{
  return boxes_.empty() ? Bounds::empty() : boxes_.front().bounds;
}

std::vector<std::optional<FacetSurface::Meeting>> meetings_along(const Comm &comm, const FacetSurface &mine,
                                                                 const std::vector<Point> &x,
                                                                 const std::vector<Point> &direction)
{
  const RankBoxes boxes = rank_boxes(comm, mine.bounds());
  std::vector<std::pair<int, std::size_t>> sent; // rank, line
  for (std::size_t n = 0; n < x.size(); ++n)
    boxes.along(x[n], direction[n], [&](const int rank) { sent.emplace_back(rank, n); });
  std::sort(sent.begin(), sent.end());
  std::vector<int> counts(comm.getSize());
  std::vector<double> lines;
  for (const auto &[rank, n] : sent) {
    ++counts[rank];
    lines.insert(lines.end(), x[n].begin(), x[n].end());
    lines.insert(lines.end(), direction[n].begin(), direction[n].end());
  }
  const Exchange exchange(comm, counts);
  const std::vector<double> asked = exchange.forward(lines, 6);
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::vector<double> replies;
  for (std::size_t k = 0; k < asked.size(); k += 6) {
    const auto met = mine.along({asked[k], asked[k + 1], asked[k + 2]}, {asked[k + 3], asked[k + 4], asked[k + 5]});
    if (met)
      replies.insert(replies.end(), {met->off, met->distance, met->value});
    else
      replies.insert(replies.end(), {inf, inf, 0});
  }
  const std::vector<double> got = exchange.back(replies, 3);
  std::vector<std::optional<FacetSurface::Meeting>> first(x.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    const FacetSurface::Meeting found{got[3 * k], got[3 * k + 1], got[3 * k + 2]};
    auto &best = first[sent[k].second];
    if (found.off < inf && (!best || found.before(*best))) best = found;
  }
  return first;
}

} // namespace rpc::contact
