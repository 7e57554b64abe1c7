// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"
#include "solve.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace rpc
{

/// A number of the results, or a vector, with its error bar: what the console shows of it and the summary lists.
struct Result {
  std::string key;           ///< in the summary
  std::string entry;         ///< of the deck's list that it belongs to: the name of a support; else empty
  std::string line;          ///< heading of its line on the console, shared by results of one heading; empty: no line
  std::string label;         ///< on that line, before the number
  std::vector<double> value; ///< one number, or one for each direction of space
  bool is_vector = false;
  std::string unit; ///< may be empty
  double error_bar = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> error_bars{}; ///< of a vector's components, where they differ; else empty
  std::string no_bar;               ///< why there is no error bar, if there is none
  bool tells_why = false;           ///< it has a reason of its own, which its line tells
  // Of the largest pressure:
  std::vector<double> place; ///< where it is [length]; else empty
  GO num_places = 0;         ///< nodes that have it; the place is that of the first
  std::string nothing_to;    ///< "to rounding": it is no more than that with its error bar, and the console shows 0
  std::string more;          ///< what follows the number on the console: the same as text, or why it is exact
};

/// The results of a run in the order in which an engineer reads them: forces, contact, supports, body, energies. Without
/// a solution all are NaN. Collective.
std::vector<Result> result_list(const Scene &scene, const Solution &solution);

/// How far the obstacle that a force moves is from where it was at t = 0 [m], NaN without a solution; nothing where there is none.
std::optional<Point> obstacle_moved(const Scene &scene, const Solution &solution);
/// With what its springs draw it back [N]; NaN without a solution; nothing where it has none.
std::optional<Point> obstacle_spring_force(const Scene &scene, const Solution &solution);

/// Those of one of several contact sides, without error bars.
std::vector<Result> side_results(const Scene &scene, const Solution &solution, std::size_t side);

/// Value, error bar and unit as text.
std::string text_of(const Result &result);

} // namespace rpc
