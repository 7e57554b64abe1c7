// SPDX-License-Identifier: BSD-3-Clause
#include "box_divisions.hpp"

#include "rpc/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rpc::mesh
{
namespace
{

/// grade(), in one direction.
void grade_along(BoxOptions &options, const int direction)
{
  const int cells = options.cells[direction];
  const double ratio = options.expansion_in(direction);
  std::vector<double> &ends = options.ends[direction];
  ends.clear();
  if (ratio == 1 || cells == 1) return;
  const double lower = options.lower[direction], upper = options.upper[direction],
               log_q = std::log(ratio) / (cells - 1);
  for (int k = 0; k < cells; ++k) {
    const double t = std::expm1(k * log_q) / std::expm1(cells * log_q);
    ends.push_back((1 - t) * lower + t * upper);
  }
  ends.push_back(upper);
}

} // namespace

double BoxOptions::cell_length(const int direction) const
{
  if (!graded(direction)) return (upper[direction] - lower[direction]) / (cells[direction] - 1 + last_in(direction));
  const auto &end = ends[direction];
  double longest = 0;
  for (std::size_t k = 0; k + 1 < end.size(); ++k) longest = std::max(longest, end[k + 1] - end[k]);
  return longest;
}

double BoxOptions::node_distance(const int direction) const
{
  const int order = element.order_along(direction);
  if (!graded(direction)) return cell_length(direction) / order;
  const auto &end = ends[direction];
  double least = upper[direction] - lower[direction];
  for (std::size_t k = 0; k + 2 < end.size(); ++k)
    least = std::min(least, std::max(end[k + 1] - end[k], end[k + 2] - end[k + 1]));
  return least / order;
}

std::vector<double> cell_ends(const BoxOptions &options, const int direction)
{
  if (options.graded(direction)) return options.ends[direction];
  const double lower = options.lower[direction], upper = options.upper[direction];
  const double cells = options.cells[direction] - 1 + options.last_in(direction);
  std::vector<double> ends;
  for (int k = 0; k < options.cells[direction]; ++k) ends.push_back((1 - k / cells) * lower + k / cells * upper);
  ends.push_back(upper);
  return ends;
}

void grade(BoxOptions &options)
{
  for (int d = 0; d < options.element.dim; ++d) grade_along(options, d);
}

void require_expansion(const BoxOptions &options)
{
  constexpr double least = 1e-4; // of the last cell over the first one
  for (int d = 0; d < options.element.dim; ++d) {
    const double ratio = options.expansion_in(d);
    RPC_REQUIRE(ratio >= least && ratio <= 1 / least, "deck: \"Mesh->Expansion Ratio\" must be from "
                                                          << least << " to " << 1 / least << " in each direction, got "
                                                          << ratio << " in direction " << d + 1);
    if (ratio == 1) continue;
    const double size = options.upper[d] - options.lower[d];
    const double shortest = size / options.intervals(d) * std::min(ratio, 1 / ratio);
    const double farthest = std::max(std::abs(options.lower[d]), std::abs(options.upper[d]));
    RPC_REQUIRE(
        shortest >= 1e-12 * farthest,
        "deck: \"Mesh->Expansion Ratio\": nodes must be at least 1e-12 times as far apart as from the origin, got "
            << shortest << " and " << farthest << " [m] in direction " << d + 1);
    const char *const where = options.cells[d] == 1 ? "of one cell"
                              : options.periodic[d] ? "in which the box is periodic"
                                                    : nullptr;
    RPC_REQUIRE(!where, "deck: \"Mesh->Expansion Ratio\" must be 1 in directions "
                            << where << ", got " << ratio << " in direction " << d + 1
                            << ". Write 1 there, or more cells, or no \"Periodic\"");
  }
}

} // namespace rpc::mesh
