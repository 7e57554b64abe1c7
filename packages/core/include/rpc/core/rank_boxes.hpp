// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/bounds.hpp"
#include "rpc/core/tpetra.hpp"

#include <cstddef>
#include <vector>

namespace rpc
{

/// The boxes around the cells or facets of each rank, known to all ranks: a tree that finds the ranks whose boxes contain a place
/// without a loop over all of them.
class RankBoxes
{
public:
  /// @param boxes  (ranks) empty ones are never found
  explicit RankBoxes(std::vector<Bounds> boxes);

  const std::vector<Bounds> &boxes() const { return boxes_; }
  /// Calls visit(rank) for the ranks whose boxes are no farther from x than that.
  /// @param bound  square of the distance [m^2]
  template <class Visit>
  void within(const Point &x, const double bound, const Visit &visit) const
  {
    walk([&](const Bounds &box) { return box.nearest(x) <= bound; }, visit);
  }
  /// Calls visit(rank) for the ranks whose boxes the line through x meets.
  template <class Visit>
  void along(const Point &x, const Point &direction, const Visit &visit) const
  {
    walk([&](const Bounds &box) { return box.meets_line(x, direction); }, visit);
  }
  /// The least of `farthest` of all boxes: something is no farther from x [m^2]; infinite if all are empty.
  double least_farthest(const Point &x) const;

private:
  struct Part {
    Bounds bounds;
    int rank;         // of a box; -1: of several, which follow
    std::size_t next; // after these
  };
  void add_part(std::vector<int>::iterator first, std::vector<int>::iterator last);
  template <class Reaches, class Visit>
  void walk(const Reaches &reaches, const Visit &visit) const
  {
    for (std::size_t k = 0; k < parts_.size();) {
      const Part &part = parts_[k];
      const bool reached = reaches(part.bounds);
      if (reached && part.rank >= 0) visit(part.rank);
      k = reached ? k + 1 : part.next;
    }
  }

  std::vector<Bounds> boxes_;
  std::vector<Part> parts_;
};

/// The boxes of all ranks, known to each; collective.
RankBoxes rank_boxes(const Comm &comm, const Bounds &mine);

} // namespace rpc
