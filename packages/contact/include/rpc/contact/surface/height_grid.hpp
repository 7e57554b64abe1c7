// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/interval.hpp"
#include "rpc/core/point.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rpc::contact
{

/// Heights at the nodes of a regular grid, as a file has them.
struct HeightTable {
  int columns = 0, rows = 0;             ///< along X and Y; one row is a profile
  std::vector<double> height;            ///< (rows, columns), in the file's unit
  std::array<double, 2> spacing{{0, 0}}; ///< along X and Y, in the file's unit; 0: the file does not say

  double at(const int column, const int row) const { return height[static_cast<std::size_t>(row) * columns + column]; }
};

/// What is between the heights of a grid.
enum class Interpolation {
  bicubic, ///< Catmull-Rom splines along both directions: slopes are continuous, and errors of smooth surfaces fall with the spacing's cube
  bilinear ///< slopes jump from cell to cell, and errors fall with the spacing's square
};

/// A surface z = h(x, y) through the heights of a grid whose first one is at x = y = 0, or, of one row, z = h(x). The foundation lies below
/// it. Where it is not periodic it ends with the grid, and below its ends there is nothing either.
class HeightGrid
{
public:
  /// @param table  of at least two columns, with spacings; heights and spacings in [m]
  HeightGrid(const HeightTable &table, Interpolation interpolation, bool periodic);

  struct Value {
    double height = 0;                   ///< [m]
    std::array<double, 2> slope{{0, 0}}; ///< along x and y
  };
  /// At a place that covers() has; others are taken to its edge.
  Value at(double x, double y) const;
  bool covers(double x, double y) const;
  bool is_profile() const { return cells_[1] == 0; }

  /// The point of the surface nearest to a place.
  struct Nearest {
    Point point{};        ///< [m]
    Point normal{};       ///< unit, out of the foundation
    bool at_edge = false; ///< the surface ends there, so that the way to it need not be the normal
  };
  Nearest nearest(const Point &x) const;

  /// The way g along a unit direction, which leads down, from x to the first place where it crosses the surface into the foundation; of x in
  /// the foundation, the way back to where it left it last, < 0. Nothing where there is no such place.
  std::optional<double> crossing(const Point &x, const Point &direction) const;

  /// How far a box is from the foundation, at least [m].
  double clearance(const Box &box) const;

  Interval heights() const
  {
    return levels_.back().range.front();
  } ///< bounds on all heights between the nodes, too [m]
  const std::array<double, 2> &spacing() const { return spacing_; } ///< [m]
  std::array<double, 2> extent() const;                             ///< along x and y; periodic: a period [m]
  double rms_height() const;                                        ///< about the mean, at the nodes [m]
  double rms_slope() const;                                         ///< of the differences of neighbours

private:
  struct Patch; // of one cell
  /// Bounds on the heights of cells, or of four parts of the level below.
  struct Level {
    std::array<int, 2> size;
    std::vector<Interval> range; // (size[1], size[0])
    const Interval &at(const int i, const int j) const { return range[static_cast<std::size_t>(j) * size[0] + i]; }
  };
  /// A part of a level, with the number of periods that it is moved by.
  struct Part {
    double bound; // on the square of a distance
    int level, i, j;
    std::array<int, 2> period;
    bool operator<(const Part &other) const { return bound > other.bound; } // the nearest one first
  };

  Patch patch(int i, int j) const;
  double node(int i, int j) const; // beyond the edges, too
  void set_levels();
  /// The cell of a coordinate and the place in it, from 0 to 1; periodic: with the first period's cell.
  std::pair<int, double> cell_of(double x, int direction) const;
  std::array<Interval, 2> footprint(const Part &part) const;
  template <class Bound, class Wants, class Visit>
  void search(const Box &box, const Bound &bound, const Wants &wants, const Visit &visit) const;
  double above(const Point &x) const { return x[2] - at(x[0], x[1]).height; }

  std::array<int, 2> cells_; // along x and y; of a profile 0 along y
  std::array<double, 2> spacing_;
  Interpolation interpolation_;
  bool periodic_;
  int columns_, rows_;
  std::vector<double> height_; // of the table, with one more about it before and two behind
  std::vector<Level> levels_;  // the cells, then ever fewer, to one
};

} // namespace rpc::contact
