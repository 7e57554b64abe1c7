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

/// Half as many cells in a direction.
void halve(const int d, const BoxOptions &options, BoxOptions &coarse)
{
  coarse.cells[d] = options.cells[d] / 2;
  coarse.last[d] = (options.cells[d] % 2 + 1 + options.last_in(d)) / 2; // of the last two or three
}

/// Order 1 in these directions; where it is that already, half as many cells.
BoxOptions coarsened_along(const Directions &directions, const BoxOptions &options)
{
  BoxOptions coarse = options;
  coarse.last.resize(options.element.dim, 1.);
  Directions lower{};
  for (int d = 0; d < options.element.dim; ++d) {
    lower[d] = directions[d] && options.element.order_along(d) == 2;
    if (!directions[d] || lower[d]) continue;
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
    longest = std::max(longest, options.node_distance(d));
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
  for (int d = 0; d < dim; ++d) {
    closest[d] = can_be_coarsened(options, d) && options.node_distance(d) <= coarsening_rules.equally_long * shortest;
    all = all && (closest[d] || options.intervals(d) == 1);
  }
  if (options.element.shape == Shape::simplex && options.element.order == 2) {
    if (all) {
      fine.element.order = 1;
      return fine;
    }
    fine.element.shape = Shape::tensor; // of the same nodes
  }
  const BoxOptions coarse = coarsened_along(closest, fine);
  if (!thin_direction(coarse) || thin_direction(options)) return coarse;
  for (int d = 0; d < dim; ++d) to_one[d] = closest[d] && coarse.intervals(d) == 1;
  const BoxOptions across = coarsened_along(to_one, fine);
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
