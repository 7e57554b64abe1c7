#pragma once

#include "output/film.hpp"
#include "scene.hpp"
#include "solve.hpp"

#include <string>
#include <vector>

namespace rpc
{

/// Writes what the scene asks for into a folder, each file whole or not at all; collective. Results of one name belong to
/// one run: files of an earlier run that this one does not write are removed. Updates seconds.output and seconds.total.
/// @param film   of load steps, to be finished
/// @param start  wall-clock time at which the run began [s]
/// @return the files' paths
/// @throws rpc::Error on every rank if a file cannot be written, or an earlier one not removed
std::vector<std::string> write_results(const Scene &scene, Solution &solution, const std::string &folder, double start,
                                       Film &film);

} // namespace rpc
