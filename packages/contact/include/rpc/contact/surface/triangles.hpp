// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/bounds.hpp"
#include "rpc/core/point.hpp"

#include <array>
#include <string>
#include <vector>

namespace rpc::contact
{

/// Triangles of a surface, anticlockwise as seen from outside.
struct Triangles {
  std::vector<Point> points; ///< [m]
  std::vector<std::array<int, 3>> corners;
};

/// What keeps triangles from being the surface of a body, with a place and a remedy: a triangle without an area, an edge that does not belong to two
/// triangles, or to two that turn the same way; or all of them turned inside out. Empty: nothing.
std::string fault_of(const Triangles &triangles);

/// The surface of a body, of triangles without a fault, in a tree of boxes about them.
class ClosedSurface
{
public:
  explicit ClosedSurface(Triangles triangles);

  struct Foot {
    double distance = 0; ///< >= 0 [m]
    Point place{};       ///< the nearest point of the surface
    Point
        normal{}; ///< unit, outwards; on edges and corners the mean of the triangles around, weighted by angles, whose side tells inside from outside
    Point smooth{}; ///< unit; interpolates those of the corners
  };
  Foot nearest(const Point &x) const;

  /// Where the line through x meets a triangle, g along the direction.
  struct Crossing {
    double g = 0;
    double descent = 0; ///< -direction . normal
  };
  std::vector<Crossing> crossings(const Point &x, const Point &direction) const;

  std::size_t size() const { return triangles_.corners.size(); }
  Bounds bounds() const;
  double mean_edge() const { return mean_edge_; } ///< [m]

private:
  static constexpr std::size_t few = 4; // triangles in a box that is not divided
  struct Box {
    Bounds bounds;
    std::size_t first, last; // of the triangles in order_
    std::size_t next;        // box after its parts, which follow it
  };
  void add_box(std::size_t first, std::size_t last);
  const Point &corner(std::size_t triangle, int k) const { return triangles_.points[triangles_.corners[triangle][k]]; }
  Foot foot_on(std::size_t triangle, const Point &x) const;

  Triangles triangles_;
  std::vector<Point> normal_;        // unit, of triangles
  std::vector<Point> corner_normal_; // unit, of points
  std::vector<std::array<Point, 3>>
      beyond_; // (triangles, edges) unit normal of the triangle beyond the edge from corner k to the next
  std::vector<std::size_t> order_;
  std::vector<Box> boxes_; // each before its parts
  double mean_edge_ = 0;
};

} // namespace rpc::contact
