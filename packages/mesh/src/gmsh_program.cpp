#include "gmsh_wire.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <gmsh.h>
#include <new>
#include <set>
#include <sstream>
#include <sys/prctl.h>
#include <unistd.h>

namespace rpc::mesh
{
namespace
{

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

double number_option(const char *name)
{
  double value = 0;
  gmsh::option::getNumber(name, value);
  return value;
}

/// Of the box around the model, 0 if there is nothing.
double diameter()
{
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities);
  if (entities.empty()) return 0;
  double low[3], high[3];
  gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

std::size_t num_nodes()
{
  std::vector<std::size_t> nodes;
  std::vector<double> coords, parametric;
  gmsh::model::mesh::getNodes(nodes, coords, parametric, -1, -1, false, false);
  return nodes.size();
}

/// Meshes the curves; gmsh would do that for ever, or until memory ends, if sizes are absurd. So a bound on sizes goes down
/// from 1e-4 of the body in steps of ten, until it makes no difference or there are too many nodes.
/// @return whether there is an end to it
bool mesh_curves(const double body, const double factor)
{
  constexpr std::size_t most_nodes = 100000;
  constexpr double least_share = 1e-12;
  const double own_bound = number_option("Mesh.MeshSizeMin");
  bool done = false;
  std::size_t before = 0;
  for (double share = 1e-4; !done && share > least_share; share /= 10) {
    gmsh::model::mesh::clear();
    gmsh::option::setNumber("Mesh.MeshSizeMin", std::max(own_bound, share * body / factor));
    gmsh::model::mesh::generate(1);
    const std::size_t nodes = num_nodes();
    if (nodes > most_nodes) return false;
    done = nodes == before;
    before = nodes;
  }
  gmsh::option::setNumber("Mesh.MeshSizeMin", own_bound);
  return done;
}

/// Makes the mesh. @return what is absurd about its sizes; "" if nothing is
std::string make_mesh(const GmshRequest &request)
{
  constexpr double greatest_factor = 1e9, greatest_body = 1e50;
  const double factor = number_option("Mesh.MeshSizeFactor") * request.size_factor, body = diameter();
  std::ostringstream complaint;
  if (!(factor >= 1 / greatest_factor && factor <= greatest_factor))
    complaint << "the factor on cell sizes must be " << 1 / greatest_factor << " to " << greatest_factor << ", got "
              << factor;
  else if (!(body <= greatest_body))
    complaint << "the geometry's size must be at most " << greatest_body << " [m], got " << body;
  if (!complaint.str().empty()) return complaint.str();
  gmsh::option::setNumber("Mesh.MeshSizeFactor", factor);
  gmsh::option::setNumber("Mesh.ElementOrder", request.order);
  gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 0);
  if (!mesh_curves(body, factor))
    complaint << "cell sizes are too small for a body of size " << body
              << " [m]: its curves would have more than 100000 nodes";
  else
    gmsh::model::mesh::generate(2);
  return complaint.str();
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
  const std::string absurdity = make_mesh(request);
  contents.complaint = first_error();
  if (contents.complaint.empty()) contents.complaint = absurdity;
  if (contents.complaint.empty()) take_mesh(contents);
}

GmshContents contents_of(const GmshRequest &request)
{
  GmshContents contents;
  try {
    load(request, contents);
  } catch (const std::string &message) { // gmsh throws plain strings
    contents.complaint = message;
  } catch (const std::bad_alloc &) {
    contents.complaint = "out of memory";
  } catch (const std::exception &error) {
    contents.complaint = error.what();
  } catch (...) {
    contents.complaint = "unknown error";
  }
  return contents;
}

bool write_all(const std::string &bytes)
{
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(gmsh_output, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) done += static_cast<std::size_t>(written);
  }
  return true;
}

} // namespace
} // namespace rpc::mesh

/// rpc_gmsh FILE SIZE_FACTOR ORDER: meshes a .geo for rpc. A program of its own, because gmsh can break down, leave by
/// exit() in the middle of a file and change the process for good.
int main(const int argc, char *argv[])
{
  using namespace rpc::mesh;
  if (argc != 4) return 1;
  prctl(PR_SET_PDEATHSIG, SIGKILL); // not to outlive an rpc that is killed
  const std::string bytes = packed(contents_of({argv[1], std::strtod(argv[2], nullptr), std::atoi(argv[3])}));
  return write_all(bytes) ? 0 : 1;
}
