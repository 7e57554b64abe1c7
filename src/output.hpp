#pragma once

#include "rpc/io/exodus.hpp"
#include "solve.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rpc
{

/// The summary of a run as doc/input.md lists it. A value that is not a number (a limit of inf, say) is null.
nlohmann::ordered_json summary(const Scene &scene, const Solution &solution);

/// The name of one mesh's results, "Adapt->Write All".
/// @param cycle  from 1
std::string cycle_name(const Scene &scene, int cycle);

/// Proves that the folder can be made and written to, and that nothing stands in the way of a scene's files, those of
/// its cycles included: before the run, not after it. Collective.
/// @throws rpc::Error (bad_input) on every rank
void require_writable_results(const Scene &scene, const std::string &folder, const Comm &comm);

/// The Exodus file of a run with load steps, a time for each: it appears with the other results. Where the mesh changes from one step
/// to the next, a new file begins, <deck>.e-s0002 and so on, as ParaView expects of one run.
class Film
{
public:
  /// Adds the last of the solution's steps if it is to be written. Collective.
  void add(const Scene &scene, const Solution &solution, const std::string &folder);
  /// Adds the solution if it is not in yet, and finishes the file.
  void finish(const Scene &scene, const Solution &solution, const std::string &folder);
  const std::vector<std::string> &files() const { return files_; } ///< their paths
  double seconds() const { return seconds_; }                      ///< that writing took [s]

private:
  void write(const Scene &scene, const Solution &solution, const std::string &folder);

  std::shared_ptr<const mesh::Mesh> mesh_; // which the file reads until its end
  std::unique_ptr<io::ExodusFile> file_;
  int written_ = 0; // number of the last step that is in
  std::vector<std::string> files_;
  double seconds_ = 0;
};

/// Writes what the scene asks for into a folder, each file whole or not at all; collective. Results of one name belong to
/// one run: files of an earlier run that this one does not write are removed. Updates seconds.output and seconds.total.
/// @param film   of load steps, to be finished
/// @param start  wall-clock time at which the run began [s]
/// @return the files' paths
/// @throws rpc::Error on every rank if a file cannot be written, or an earlier one not removed
std::vector<std::string> write_results(const Scene &scene, Solution &solution, const std::string &folder, double start,
                                       Film &film);

} // namespace rpc
