// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"
#include "solve.hpp"

#include <string>
#include <vector>

namespace rpc
{

/// The name of one mesh's results, "Adapt->Write All".
/// @param cycle  from 1
std::string cycle_name(const Scene &scene, int cycle);

/// Paths of the results; empty for files that are not asked for.
struct ResultPaths {
  std::string exodus, csv, json, history, points;

  ResultPaths(const Scene &scene, const std::string &folder);
  std::vector<std::string> all() const { return {exodus, csv, history, points, json}; }
};

/// Where a part of a film goes.
/// @param part  from 1
std::string film_part(const std::string &exodus, int part);

/// The files of an Exodus path on disk: itself, or those of all ranks.
std::vector<std::string> exodus_on_disk(const std::string &exodus, io::ExodusFiles files, int num_ranks);

/// Whether a file's name is that of a result or checkpoint of the scene.
bool is_result(const Scene &scene, const std::string &file);

/// Proves that the folder can be made and written to, and that nothing stands in the way of a scene's files, those of
/// its cycles included: before the run, not after it. Collective.
/// @throws rpc::Error (bad_input) on every rank
void require_writable_results(const Scene &scene, const std::string &folder, const Comm &comm);

/// The same of a run that is only checked: no folder is made for it. Collective.
/// @throws rpc::Error (bad_input) on every rank
void require_place_for_results(const Scene &scene, const std::string &folder, const Comm &comm);

/// Files of the same name that an earlier run has left and this run does not write, those of its meshes included. One rank only.
/// @param film  that this run has written
std::vector<std::string> older_files(const Scene &scene, const Solution &solution, const std::string &folder,
                                     const std::vector<std::string> &film);

} // namespace rpc
