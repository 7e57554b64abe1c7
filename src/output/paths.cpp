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

/// All files that results of one name can have.
std::vector<std::string> all_files(const std::string &name, const std::string &folder)
{
  const std::string stem = (std::filesystem::path(folder) / name).string();
  return {stem + ".e", stem + ".contact.csv", stem + ".json", stem + ".history.csv"};
}

Scene of_cycle(Scene scene, const int cycle)
{
  scene.name = cycle_name(scene, cycle);
  return scene;
}

void require_replaceable(const ResultPaths &paths)
{
  for (const std::string &path : paths.all())
    if (!path.empty()) io::require_replaceable(path);
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
}

std::string film_part(const std::string &exodus, const int part)
{
  if (part == 1) return exodus;
  std::ostringstream name;
  name << exodus << "-s" << std::setw(4) << std::setfill('0') << part;
  return name.str();
}

bool is_result(const Scene &scene, const std::string &file)
{
  static const std::regex ends(
      R"(\.(cycle[0-9]+\.)?(e(-s[0-9]+)?|contact\.csv|history\.csv|json|checkpoint-[0-9]+\.e))");
  return file.compare(0, scene.name.size(), scene.name) == 0 &&
         std::regex_match(file.substr(std::min(file.size(), scene.name.size())), ends);
}

void require_writable_results(const Scene &scene, const std::string &folder, const Comm &comm)
{
  on_root(comm, ExitCode::bad_input, [&] {
    io::require_writable_folder(folder);
    require_replaceable(ResultPaths(scene, folder));
    std::error_code none;
    for (const std::string &file : all_files(scene.name, folder)) // those that are not written are removed
      if (std::filesystem::is_regular_file(file, none)) io::require_replaceable(file);
    if (!scene.adapt.adapts() || !scene.adapt.write_all) return;
    for (int cycle = 1; cycle <= std::min(scene.adapt.max_cycles, most_cycles); ++cycle)
      require_replaceable(ResultPaths(of_cycle(scene, cycle), folder));
  });
}

std::vector<std::string> older_files(const Scene &scene, const Solution &s, const std::string &folder, const int parts)
{
  const auto ours = ResultPaths(scene, folder).all();
  std::vector<std::string> older;
  const auto add_existing = [&](const std::string &name) {
    bool found = false;
    for (const std::string &file : all_files(name, folder)) {
      std::error_code none;
      if (std::find(ours.begin(), ours.end(), file) != ours.end()) continue;
      if (!std::filesystem::exists(file, none)) continue;
      older.push_back(file);
      found = true;
    }
    return found;
  };
  add_existing(scene.name);
  for (int part = parts + 1;; ++part) {
    const std::string file = film_part(all_files(scene.name, folder)[0], std::max(part, 2));
    std::error_code none;
    if (!std::filesystem::exists(file, none)) break;
    older.push_back(file);
  }
  int cycle = scene.adapt.write_all && s.adaptation ? static_cast<int>(s.adaptation->cycles.size()) : 0;
  while (add_existing(cycle_name(scene, ++cycle))) {
  }
  return older;
}

} // namespace rpc
