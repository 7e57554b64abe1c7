// SPDX-License-Identifier: BSD-3-Clause
#include "part_of_side.hpp"

#include "gauss.hpp"
#include "side_on_host.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::bound
{
namespace
{

/// The box without those ends that no corner of a facet lies beyond, the others moved inwards.
template <std::size_t Corners>
Box cutting(const Box &box, const std::array<Point, Corners> &corner, const double near, const double inwards)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box cut{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  for (const Point &x : corner)
    for (int d = 0; d < 3; ++d) {
      if (x[d] < box.low[d] - near) cut.low[d] = box.low[d] + inwards;
      if (x[d] > box.high[d] + near) cut.high[d] = box.high[d] - inwards;
    }
  return cut;
}

bool cuts(const Box &box)
{
  for (int d = 0; d < 3; ++d)
    if (std::isfinite(box.low[d]) || std::isfinite(box.high[d])) return true;
  return false;
}

/// From where to where on the line from one point to another, from 0 to 1, it is in a box; empty if the second is not the larger one.
std::array<double, 2> part_of_line(const std::array<Point, 2> &ends, const Box &box)
{
  std::array<double, 2> part{0, 1};
  for (int d = 0; d < 3; ++d) {
    const double along = ends[1][d] - ends[0][d];
    for (const double sign : {1., -1.}) { // within the lower and the upper end
      const double inside = sign > 0 ? ends[0][d] - box.low[d] : box.high[d] - ends[0][d], slope = sign * along;
      if (slope == 0 && inside < 0) return {1, 0}; // beside it
      if (slope > 0) part[0] = std::max(part[0], -inside / slope);
      if (slope < 0) part[1] = std::min(part[1], -inside / slope);
    }
  }
  return part;
}

/// The part of a triangle in a box.
std::vector<Barycentric> polygon_in(const std::array<Point, 3> &corner, const Box &box)
{
  std::vector<Barycentric> polygon{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int d = 0; d < 3; ++d) {
    OfTriangle above{}, below{};
    for (int v = 0; v < 3; ++v) {
      above[v] = corner[v][d] - box.low[d];
      below[v] = box.high[d] - corner[v][d];
    }
    if (std::isfinite(box.low[d])) polygon = part_of_polygon(polygon, above, 1);
    if (std::isfinite(box.high[d])) polygon = part_of_polygon(polygon, below, 1);
  }
  return polygon;
}

} // namespace

std::vector<PartOfFacet> parts_of_facets(const ContactFacets &c, const Box &box, const double near)
{
  const Gauss rule = gauss(2); // exact for pressures of degree 2
  std::vector<PartOfFacet> parts;
  for (std::size_t f = 0; f < c.ends.size(); ++f) {
    PartOfFacet part;
    part.whole = !cuts(cutting(box, c.ends[f], near, 0));
    const auto within = part_of_line(c.ends[f], cutting(box, c.ends[f], near, near));
    part.partly = within[1] > within[0];
    const auto all = part_of_line(c.ends[f], cutting(box, c.ends[f], near, 0));
    const double along = part.partly ? c.length[f] * std::max(0., all[1] - all[0]) : 0;
    for (std::size_t q = 0; q < rule.point.size(); ++q) {
      const double at = all[0] + rule.point[q] * (all[1] - all[0]), weight = along * rule.weight[q];
      part.size += weight * (c.circle.empty() ? 1 : c.circle[f][0] + at * (c.circle[f][c.order] - c.circle[f][0]));
      part.force += weight * at_point(c.order, c.pressure[f], at); // of revolution it counts 2 pi r
    }
    parts.push_back(part);
  }
  return parts;
}

std::vector<PartOfFacet> parts_of_facets(const SpaceContact &c, const Box &box, const double near)
{
  std::vector<PartOfFacet> parts;
  for (std::size_t f = 0; f < c.corner.size(); ++f) {
    PartOfFacet part;
    const auto &corner = c.corner[f];
    part.whole = !cuts(cutting(box, corner, near, 0));
    part.partly = polygon_in(corner, cutting(box, corner, near, near)).size() >= 3;
    const auto polygon = polygon_in(corner, cutting(box, corner, near, 0));
    for (std::size_t k = 2; part.partly && k < polygon.size(); ++k) {
      const Barycentric *const t[3] = {&polygon[0], &polygon[k - 1], &polygon[k]};
      const auto side = [&](const int v, const int i) { return (*t[v])[i] - (*t[0])[i]; };
      const double size = c.area[f] * std::abs(side(1, 1) * side(2, 2) - side(1, 2) * side(2, 1));
      part.size += size;
      for (int v = 0; v < 3; ++v)
        for (int i = 0; i < 3; ++i) part.force += size / 3 * (*t[v])[i] * c.pressure[f][i];
    }
    parts.push_back(part);
  }
  return parts;
}

} // namespace rpc::bound
