// SPDX-License-Identifier: BSD-3-Clause
#include "output/results.hpp"

#include "output/contact.hpp"
#include "output/paths.hpp"
#include "output/summary.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/io/atomic_file.hpp"

#include <Teuchos_Time.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <utility>

namespace rpc
{

void StepFiles::add(const Scene &scene, const analysis::Solution &s, const std::string &folder)
{
  const ResultPaths paths(scene, folder);
  if (!std::exchange(begun_, true))
    on_root(s.discretization.mesh->comm(), ExitCode::internal_error, [&] {
      for (const std::string &path : {paths.json, paths.csv})
        if (!path.empty()) io::remove_older(path);
    });
  if (!paths.history.empty()) history.update(paths.history, scene, s);
  points.update(paths.points, scene, s);
  film.add(scene, s, folder);
}

std::vector<std::string> write_results(const Scene &scene, Solution &s, const std::string &folder, const double start,
                                       StepFiles &steps)
{
  Film &film = steps.film;
  const double begin = Teuchos::Time::wallTime() - film.seconds();
  const ResultPaths paths(scene, folder);
  const mesh::Mesh &mesh = *s.discretization.mesh;
  if (!paths.exodus.empty() && s.has_results()) film.finish(scene, s, folder);
  if (!paths.csv.empty() && s.has_results()) {
    const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::contact table"));
    write_contact(paths.csv, scene, s);
  }
  if (!paths.history.empty()) steps.history.update(paths.history, scene, s);
  steps.points.update(paths.points, scene, s);
  // After a restart that finds no step, the files of the run before it stay.
  const bool nothing_new = !s.has_results() && std::any_of(s.history.begin(), s.history.end(),
                                                           [](const auto &step) { return step.converged; });
  on_root(mesh.comm(), ExitCode::internal_error, [&] {
    if (nothing_new) return;
    for (const std::string &file : older_files(scene, s, folder, film.files())) io::remove_older(file);
  });
  const double now = Teuchos::Time::wallTime();
  s.seconds.output = now - begin;
  s.seconds.total = now - start;
  if (!paths.json.empty()) { // last: its presence says that the others are complete and of this run
    // Collective, hence outside. A deck's name may be no valid UTF-8.
    const auto json = summary(scene, s);
    const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    on_root(mesh.comm(), ExitCode::internal_error, [&] { io::write_text(paths.json, text); });
  }
  std::vector<std::string> files;
  for (const std::string &file : film.files()) {
    const bool split = scene.output.exodus_files == io::ExodusFiles::split;
    files.push_back(split ? file + '.' + std::to_string(mesh.comm().getSize()) + ".*" : file);
  }
  for (const std::string &path : paths.all())
    if (!path.empty() && path != paths.exodus && ((path != paths.csv && path != paths.points) || s.has_results()))
      files.push_back(path);
  return files;
}

} // namespace rpc
