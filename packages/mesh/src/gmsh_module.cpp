#include "gmsh_module.hpp"

#include <algorithm>
#include <clocale>
#include <cstdlib>
#include <exception>
#include <gmsh.h>
#include <set>
#include <sys/resource.h>

namespace rpc::mesh
{
namespace
{

/// Gives the process back what gmsh changes of it for good: search paths, the size of the stack, the locale.
class Surroundings
{
public:
  Surroundings() : locale_(std::setlocale(LC_ALL, nullptr)) { getrlimit(RLIMIT_STACK, &stack_); }
  ~Surroundings()
  {
    restore("PATH", path_);
    restore("PYTHONPATH", python_path_);
    setrlimit(RLIMIT_STACK, &stack_);
    std::setlocale(LC_ALL, locale_.c_str());
  }
  Surroundings(const Surroundings &) = delete;
  Surroundings &operator=(const Surroundings &) = delete;

private:
  struct Variable {
    explicit Variable(const char *name) : set(std::getenv(name)), value(set ? std::getenv(name) : "") {}
    bool set;
    std::string value;
  };
  static void restore(const char *name, const Variable &variable)
  {
    if (variable.set)
      setenv(name, variable.value.c_str(), 1);
    else
      unsetenv(name);
  }

  std::string locale_;
  Variable path_{"PATH"}, python_path_{"PYTHONPATH"};
  rlimit stack_{};
};

/// gmsh from start to end, silent, with the user's own gmsh settings out of play.
class Session
{
public:
  Session()
  {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    // An exception out of the middle of gmsh's parser would leave it in disorder for the next file: errors are logged.
    gmsh::option::setNumber("General.AbortOnError", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::logger::start();
  }
  ~Session()
  {
    try {
      gmsh::logger::stop(); // the log would outlive the session
      gmsh::finalize();
    } catch (...) { // nothing to be done about it
    }
  }
  Session(const Session &) = delete;
  Session &operator=(const Session &) = delete;

private:
  Surroundings surroundings_;
};

/// The first error in gmsh's log; those after it tend to follow from it.
std::string first_error()
{
  std::vector<std::string> log;
  gmsh::logger::get(log);
  const std::string mark = "Error: ";
  for (const auto &line : log)
    if (line.compare(0, mark.size(), mark) == 0) return line.substr(mark.size());
  return "";
}

void make_mesh(const GmshRequest &request)
{
  double own_factor = 1;
  gmsh::option::getNumber("Mesh.MeshSizeFactor", own_factor);
  gmsh::option::setNumber("Mesh.MeshSizeFactor", own_factor * request.size_factor);
  gmsh::option::setNumber("Mesh.ElementOrder", request.order);
  gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 0);
  gmsh::model::mesh::generate(2);
}

struct EntityElements {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
};

EntityElements elements_of(const int dim, const int entity)
{
  EntityElements elements;
  gmsh::model::mesh::getElements(elements.types, elements.tags, elements.nodes, dim, entity);
  return elements;
}

void take_groups(GmshContents &contents, std::set<int> &surfaces)
{
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  std::sort(groups.begin(), groups.end());
  for (const auto &[dim, tag] : groups) {
    if (dim != 1 && dim != 2) continue;
    GmshGroup group{dim, tag, ""};
    gmsh::model::getPhysicalName(dim, tag, group.name);
    contents.groups.push_back(group);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, entities);
    for (int &entity : entities) entity = std::abs(entity); // a curve's sign is its direction
    std::sort(entities.begin(), entities.end());
    entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
    for (const int entity : entities) {
      if (dim == 2) surfaces.insert(entity);
      EntityElements elements = elements_of(dim, entity);
      for (std::size_t t = 0; t < elements.types.size(); ++t)
        contents.elements.push_back({static_cast<int>(contents.groups.size()) - 1, elements.types[t],
                                     std::move(elements.tags[t]), std::move(elements.nodes[t])});
    }
  }
}

void take_mesh(GmshContents &contents)
{
  contents.solid = !elements_of(3, -1).types.empty();
  std::set<int> surfaces;
  take_groups(contents, surfaces);
  gmsh::vectorpair all_surfaces;
  gmsh::model::getEntities(all_surfaces, 2);
  for (const auto &[dim, surface] : all_surfaces) {
    if (surfaces.count(surface)) continue;
    for (const auto &nodes : elements_of(dim, surface).nodes)
      contents.ungrouped_nodes.insert(contents.ungrouped_nodes.end(), nodes.begin(), nodes.end());
  }
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(contents.node_tags, contents.coords, parametric, -1, -1, false, false);
}

void load(const GmshRequest &request, GmshContents &contents)
{
  const Session session;
  gmsh::open(request.file);
  contents.complaint = first_error();
  if (!contents.complaint.empty()) return;
  make_mesh(request);
  contents.complaint = first_error();
  if (contents.complaint.empty()) take_mesh(contents);
}

} // namespace
} // namespace rpc::mesh

extern "C" __attribute__((visibility("default"))) void rpc_load_gmsh(const rpc::mesh::GmshRequest &request,
                                                                     rpc::mesh::GmshContents &contents) noexcept
{
  try {
    rpc::mesh::load(request, contents);
  } catch (const std::string &message) { // gmsh throws plain strings
    contents.complaint = message;
  } catch (const std::exception &error) {
    contents.complaint = error.what();
  } catch (...) {
    contents.complaint = "unknown error";
  }
}
