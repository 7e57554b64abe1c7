// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/io/exodus.hpp"
#include "rpc/mesh/unrolled.hpp"
#include "scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace rpc
{

/// The Exodus file of a run with load steps, a time for each: it grows with each step. Where the mesh changes from one step to the
/// next, a new file begins, <deck>.e-s0002 and so on, as ParaView expects of one run. After a restart the files of the run before stay up
/// to the checkpoint, and the last of them goes on where its mesh does.
class Film
{
public:
  /// Adds the last of the solution's steps if it is to be written. Collective.
  void add(const Scene &scene, const analysis::Solution &solution, const std::string &folder);
  /// Adds the solution if it is not in yet, and finishes the file.
  void finish(const Scene &scene, const analysis::Solution &solution, const std::string &folder);
  const std::vector<std::string> &files() const { return files_; } ///< their paths
  double seconds() const { return seconds_; }                      ///< that writing took [s]
  const std::string &note() const { return note_; }                ///< for the user; empty: none

private:
  void write(const Scene &scene, const analysis::Solution &solution, const std::string &folder);
  std::unique_ptr<io::ExodusFile> opened(const Scene &scene, const analysis::Solution &solution,
                                         const std::string &path, const std::vector<std::string> &fields) const;
  void go_on(const Scene &scene, const analysis::Solution &solution, const std::string &first,
             const std::vector<std::string> &fields);

  std::shared_ptr<const mesh::Mesh> mesh_;
  mesh::Unrolled on_file_; // its mesh, which the file reads until its end
  std::unique_ptr<io::ExodusFile> file_;
  int written_ = 0; // number of the last step that is in
  std::vector<std::string> files_;
  std::string note_;
  double seconds_ = 0;
};

} // namespace rpc
