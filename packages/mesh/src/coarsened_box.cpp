// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box.hpp"

#include "rpc/mesh/rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rpc::mesh
{
namespace
{

using Directions = std::array<bool, 3>;

bool has_more_intervals(const BoxOptions &options, const int d)
{
  return options.intervals(d) > 1;
}
/// A node of a periodic box must not be there twice in a cell.
bool can_be_coarsened(const BoxOptions &options, const int d)
{
  return has_more_intervals(options, d) &&
         (!options.periodic[d] || options.element.order_along(d) == 2 || options.cells[d] >= 4);
}

/// The least node distance of some directions; infinite where there is none.
double shortest_distance(const BoxOptions &options, bool (*const counts)(const BoxOptions &, int))
{
  double shortest = std::numeric_limits<double>::infinity();
  for (int d = 0; d < options.element.dim; ++d)
    if (counts(options, d)) shortest = std::min(shortest, options.node_distance(d));
  return shortest;
}

/// Neighbouring cells become one in pairs where both are short. One that is left over before longer ones stays; at the end of the box it joins the last pair.
/// @param ends  where cells end   @param longest  a cell that is short may be
std::vector<double> joined_in_pairs(const std::vector<double> &ends, const double longest)
{
  const std::size_t cells = ends.size() - 1;
  const auto is_short = [&](const std::size_t cell) { return cell < cells && ends[cell + 1] - ends[cell] <= longest; };
  std::vector<double> kept{ends[0]};
  for (std::size_t cell = 0; cell < cells;) {
    const bool pair = is_short(cell) && is_short(cell + 1), three = pair && cell + 3 == cells && is_short(cell + 2);
    cell += three ? 3 : pair ? 2 : 1;
    kept.push_back(ends[cell]);
  }
  return kept;
}

/// The same of cells that become longer or shorter: those left over lie among the longer ones.
void join_short(const int d, const double longest, BoxOptions &coarse)
{
  std::vector<double> &ends = coarse.ends[d];
  const std::size_t last = ends.size() - 1;
  const bool shorter = ends[last] - ends[last - 1] < ends[1] - ends[0];
  const auto turn = [&ends] {
    std::reverse(ends.begin(), ends.end());
    for (double &x : ends) x = -x;
  };
  if (shorter) turn();
  ends = joined_in_pairs(ends, longest);
  if (shorter) turn();
  coarse.cells[d] = static_cast<int>(ends.size()) - 1;
  if (coarse.cells[d] == 1) ends.clear();
}

/// Half as many cells in a direction.
void halve(const int d, const BoxOptions &options, BoxOptions &coarse)
{
  coarse.cells[d] = options.cells[d] / 2;
  coarse.last[d] = (options.cells[d] % 2 + 1 + options.last_in(d)) / 2; // of the last two or three
}

/// Order 1 in these directions; where it is that already, half as many cells, in graded directions of those that are short.
BoxOptions coarsened_along(const Directions &directions, const double longest_short, const BoxOptions &options)
{
  BoxOptions coarse = options;
  coarse.last.resize(options.element.dim, 1.);
  Directions lower{};
  for (int d = 0; d < options.element.dim; ++d) {
    lower[d] = directions[d] && options.element.order_along(d) == 2;
    if (!directions[d] || lower[d]) continue;
    if (options.graded(d))
      join_short(d, longest_short, coarse);
    else
      halve(d, options, coarse);
  }
  coarse.element = options.element.with_order_one_along(lower);
  return coarse;
}

} // namespace

double stretch(const BoxOptions &options)
{
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (int d = 0; d < options.element.dim; ++d) {
    shortest = std::min(shortest, options.node_distance(d));
    longest = std::max(longest, options.graded(d) ? options.cell_length(d) / options.element.order_along(d)
                                                  : options.node_distance(d));
  }
  return longest / shortest;
}

std::optional<BoxOptions> coarsened(const BoxOptions &options)
{
  const int dim = options.element.dim;
  const double shortest = shortest_distance(options, can_be_coarsened);
  if (!std::isfinite(shortest)) return std::nullopt;
  BoxOptions fine = options;
  Directions closest{}, to_one{};
  bool all = true;
  const double longest_short = coarsening_rules.equally_long * shortest;
  for (int d = 0; d < dim; ++d) {
    closest[d] = can_be_coarsened(options, d) && options.node_distance(d) <= longest_short;
    all = all && (closest[d] || options.intervals(d) == 1);
  }
  if (options.element.shape == Shape::simplex && options.element.order == 2) {
    if (all) {
      fine.element.order = 1;
      return fine;
    }
    fine.element.shape = Shape::tensor; // of the same nodes
  }
  const BoxOptions coarse = coarsened_along(closest, longest_short, fine);
  if (!thin_direction(coarse) || thin_direction(options)) return coarse;
  for (int d = 0; d < dim; ++d) to_one[d] = closest[d] && coarse.intervals(d) == 1;
  const BoxOptions across = coarsened_along(to_one, longest_short, fine);
  return thin_direction(across) ? across : coarse;
}

std::optional<int> thin_direction(const BoxOptions &options)
{
  const double shortest = shortest_distance(options, has_more_intervals);
  std::optional<int> thinnest;
  const auto thickness = [&options](const int d) { return options.upper[d] - options.lower[d]; };
  for (int d = 0; d < options.element.dim; ++d)
    if (options.intervals(d) == 1 && (!thinnest || thickness(d) < thickness(*thinnest))) thinnest = d;
  const bool is_thin =
      thinnest && std::isfinite(shortest) && thickness(*thinnest) < coarsening_rules.equally_long * shortest;
  return is_thin ? thinnest : std::nullopt;
}

} // namespace rpc::mesh
