// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "output/film.hpp"
#include "output/history.hpp"
#include "output/points.hpp"
#include "scene.hpp"
#include "solve.hpp"

#include <string>
#include <vector>

namespace rpc
{

/// Those files of a run with load steps that grow with each step.
struct StepFiles {
  Film film;
  HistoryFile history;
  PointsFile points;

  /// Adds the solution's last step. The first time a summary and a contact table of an earlier run go: they are not of this one.
  /// Collective.
  void add(const Scene &scene, const analysis::Solution &solution, const std::string &folder);

private:
  bool begun_ = false;
};

/// Writes what the scene asks for into a folder, each file whole or not at all; collective. Results of one name belong to
/// one run: files of an earlier run that this one does not write are removed. Updates seconds.output and seconds.total.
/// @param steps  of load steps, to be finished
/// @param start  wall-clock time at which the run began [s]
/// @return the files' paths
/// @throws rpc::Error on every rank if a file cannot be written, or an earlier one not removed
std::vector<std::string> write_results(const Scene &scene, Solution &solution, const std::string &folder, double start,
                                       StepFiles &steps);

} // namespace rpc
