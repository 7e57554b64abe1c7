// SPDX-License-Identifier: BSD-3-Clause
#include "output/paths.hpp"

#include "rpc/core/on_root.hpp"
#include "rpc/io/atomic_file.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <regex>
#include <sstream>

namespace rpc
{
namespace
{

/// An adaptive run comes to far fewer meshes.
constexpr int most_cycles = 1000;

/// The files that results of one name can have, of an Exodus file the first part, joined.
std::vector<std::string> all_files(const std::string &name, const std::string &folder)
{
  const std::string stem = (std::filesystem::path(folder) / name).string();
  return {stem + ".e", stem + ".contact.csv", stem + ".json", stem + ".history.csv", stem + ".points.csv"};
}

/// Those that there are, joined and split Exodus files of all parts included.
std::vector<std::string> existing_files(const std::string &name, const std::string &folder)
{
  static const std::regex ends(R"(\.(e(-s[0-9]+)?(\.[0-9]+\.[0-9]+)?|(contact|history|points)\.csv|json))");
  std::vector<std::string> found;
  std::error_code none;
  for (const auto &entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string file = entry.path().filename().string();
    if (file.compare(0, name.size(), name) == 0 &&
        std::regex_match(file.substr(std::min(file.size(), name.size())), ends))
      found.push_back((std::filesystem::path(folder) / file).string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

Scene of_cycle(Scene scene, const int cycle)
{
  scene.name = cycle_name(scene, cycle);
  return scene;
}

void require_replaceable(const Scene &scene, const std::string &folder, const int num_ranks)
{
  const ResultPaths paths(scene, folder);
  for (const std::string &path : paths.all()) {
    if (path.empty()) continue;
    const bool exodus = path == paths.exodus;
    for (const std::string &file :
         exodus ? exodus_on_disk(path, scene.output.exodus_files, num_ranks) : std::vector<std::string>{path})
      io::require_replaceable(file);
  }
}

} // namespace

std::string cycle_name(const Scene &scene, const int cycle)
{
  return scene.name + ".cycle" + std::to_string(cycle);
}

ResultPaths::ResultPaths(const Scene &scene, const std::string &folder)
{
  const auto files = all_files(scene.name, folder);
  if (scene.output.exodus) exodus = files[0];
  if (scene.output.csv && !scene.model.contact.empty()) csv = files[1];
  if (scene.output.json) json = files[2];
  if (scene.output.csv && scene.has_steps()) history = files[3];
  if (scene.output.csv && !scene.output.points.empty()) points = files[4];
}

std::string film_part(const std::string &exodus, const int part)
{
  if (part == 1) return exodus;
  std::ostringstream name;
  name << exodus << "-s" << std::setw(4) << std::setfill('0') << part;
  return name.str();
}

std::vector<std::string> exodus_on_disk(const std::string &exodus, const io::ExodusFiles files, const int num_ranks)
{
  if (files == io::ExodusFiles::joined) return {exodus};
  std::vector<std::string> paths;
  for (int rank = 0; rank < num_ranks; ++rank) paths.push_back(io::exodus_file_of(exodus, num_ranks, rank));
  return paths;
}

bool is_result(const Scene &scene, const std::string &file)
{
  static const std::regex ends(
      R"(\.(cycle[0-9]+\.)?(e(-s[0-9]+)?(\.[0-9]+\.[0-9]+)?|(contact|history|points)\.csv|json|checkpoint-[0-9]+\.e))");
  return file.compare(0, scene.name.size(), scene.name) == 0 &&
         std::regex_match(file.substr(std::min(file.size(), scene.name.size())), ends);
}

void require_writable_results(const Scene &scene, const std::string &folder, const Comm &comm)
{
  const int num_ranks = comm.getSize();
  on_root(comm, ExitCode::bad_input, [&] {
    io::require_writable_folder(folder);
    require_replaceable(scene, folder, num_ranks);
    std::error_code none;
    for (const std::string &file : existing_files(scene.name, folder)) // those that are not written are removed
      if (std::filesystem::is_regular_file(file, none)) io::require_replaceable(file);
    if (!scene.adapt.adapts() || !scene.adapt.write_all) return;
    for (int cycle = 1; cycle <= std::min(scene.adapt.max_cycles, most_cycles); ++cycle)
      require_replaceable(of_cycle(scene, cycle), folder, num_ranks);
  });
  if (scene.output.exodus && scene.output.exodus_files == io::ExodusFiles::split) // maybe on disks of the ranks' own
    on_each(comm, ExitCode::bad_input, [&] { io::require_writable_folder(folder); });
}

void require_place_for_results(const Scene &scene, const std::string &folder, const Comm &comm)
{
  bool exists = false;
  on_root(comm, ExitCode::bad_input, [&] {
    std::error_code none;
    std::filesystem::path place = std::filesystem::absolute(folder.empty() ? "." : folder, none);
    exists = std::filesystem::exists(place, none);
    while (!std::filesystem::exists(place, none) && place.has_relative_path()) place = place.parent_path();
    if (!exists) io::require_writable_folder(place.string());
  });
  if (max_all(comm, exists ? 1. : 0.) > 0) require_writable_results(scene, folder, comm);
}

std::vector<std::string> older_files(const Scene &scene, const Solution &s, const std::string &folder,
                                     const std::vector<std::string> &film)
{
  const int num_ranks = s.discretization.mesh->comm().getSize();
  std::vector<std::string> ours = ResultPaths(scene, folder).all();
  ours.erase(ours.begin()); // the Exodus file is the film's
  const ResultPaths paths(scene, folder);
  for (const std::string &path : {paths.csv, paths.points})
    if (!s.has_results()) ours.erase(std::remove(ours.begin(), ours.end(), path), ours.end());
  for (const std::string &part : film)
    for (const std::string &file : exodus_on_disk(part, scene.output.exodus_files, num_ranks)) ours.push_back(file);
  std::vector<std::string> older;
  const auto add_existing = [&](const std::string &name) {
    bool found = false;
    for (const std::string &file : existing_files(name, folder)) {
      if (std::find(ours.begin(), ours.end(), file) != ours.end()) continue;
      older.push_back(file);
      found = true;
    }
    return found;
  };
  add_existing(scene.name);
  int cycle = scene.adapt.write_all && s.adaptation ? static_cast<int>(s.adaptation->cycles.size()) : 0;
  while (add_existing(cycle_name(scene, ++cycle))) {
  }
  return older;
}

} // namespace rpc
