// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/rank_boxes.hpp"

#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace rpc
{
RankBoxes::RankBoxes(std::vector<Bounds> boxes) : boxes_(std::move(boxes))
{
  std::vector<int> ranks;
  for (std::size_t rank = 0; rank < boxes_.size(); ++rank)
    if (!boxes_[rank].is_empty()) ranks.push_back(static_cast<int>(rank));
  if (!ranks.empty()) add_part(ranks.begin(), ranks.end());
}

void RankBoxes::add_part(const std::vector<int>::iterator first, const std::vector<int>::iterator last)
{
  const std::size_t here = parts_.size();
  Bounds around = Bounds::empty();
  for (auto rank = first; rank != last; ++rank) around.add(boxes_[*rank]);
  parts_.push_back({around, last - first == 1 ? *first : -1, 0});
  if (last - first > 1) {
    const int axis = around.longest();
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [&](const int a, const int b) {
      return boxes_[a].lower[axis] + boxes_[a].upper[axis] < boxes_[b].lower[axis] + boxes_[b].upper[axis];
    });
    add_part(first, middle);
    add_part(middle, last);
  }
  parts_[here].next = parts_.size();
}

double RankBoxes::least_farthest(const Point &x) const
{
  double least = std::numeric_limits<double>::infinity();
  walk([&](const Bounds &box) { return box.nearest(x) < least; },
       [&](const int rank) { least = std::min(least, boxes_[rank].farthest(x)); });
  return least;
}

RankBoxes rank_boxes(const Comm &comm, const Bounds &mine)
{
  std::vector<double> ends(mine.lower.begin(), mine.lower.end());
  ends.insert(ends.end(), mine.upper.begin(), mine.upper.end());
  ends = gathered_by_all(comm, ends);
  std::vector<Bounds> boxes(comm.getSize());
  for (std::size_t rank = 0; rank < boxes.size(); ++rank) {
    std::copy_n(&ends[6 * rank], 3, boxes[rank].lower.begin());
    std::copy_n(&ends[6 * rank + 3], 3, boxes[rank].upper.begin());
  }
  return RankBoxes(std::move(boxes));
}

} // namespace rpc
