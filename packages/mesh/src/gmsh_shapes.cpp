// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_shapes.hpp"

#include "gmsh_mesher.hpp"
#include "mesh_formats.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <gmsh.h>
#include <map>
#include <optional>
#include <sstream>
#include <sys/resource.h>
#include <utility>
#include <vector>

namespace rpc::mesh
{
namespace
{

/// OpenCASCADE reads some damaged files for ever: where a number is none, its reader of BREP asks again. SIGXCPU then ends this process, which is
/// there for one file.
class TimeToRead
{
public:
  /// @param file  "" has no limit
  explicit TimeToRead(const std::string &file)
  {
    std::error_code failed;
    const auto bytes = file.empty() ? 0 : std::filesystem::file_size(file, failed);
    if (file.empty() || failed || ::getrlimit(RLIMIT_CPU, &before_) != 0) return;
    // A hundred times what sound files take: 0.05 s at least, and 0.5 s for 1 MB of STEP, on one core of 2.5 GHz.
    constexpr double least = 5, for_megabyte = 50; // [s]
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    rlimit limit = before_;
    limit.rlim_cur = static_cast<rlim_t>(static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1 + least +
                                         for_megabyte * 1e-6 * static_cast<double>(bytes));
    is_set_ = limit.rlim_cur < before_.rlim_cur && ::setrlimit(RLIMIT_CPU, &limit) == 0;
  }
  ~TimeToRead()
  {
    if (is_set_) ::setrlimit(RLIMIT_CPU, &before_);
  }
  TimeToRead(const TimeToRead &) = delete;
  TimeToRead &operator=(const TimeToRead &) = delete;

private:
  rlimit before_{};
  bool is_set_ = false;
};

constexpr const char *kind_of_entity[] = {"point", "curve", "surface", "volume"};

/// Parts that touch get one common surface there, or a mesh would not hold together.
void join_parts()
{
  const int dim = gmsh::model::getDimension();
  gmsh::vectorpair parts, result;
  gmsh::model::getEntities(parts, dim);
  if (dim < 2 || parts.size() < 2) return;
  std::vector<gmsh::vectorpair> map;
  gmsh::model::occ::fragment(parts, {}, result, map);
  gmsh::model::occ::synchronize();
}

/// The middle of an edge that one triangle alone has; none if the triangles are closed.
std::optional<std::array<double, 3>> open_edge()
{
  constexpr int triangle = 2; // gmsh's number
  std::vector<std::size_t> tags, nodes;
  gmsh::model::mesh::getElementsByType(triangle, tags, nodes);
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t k = 0; k + 2 < nodes.size(); k += 3)
    for (int a = 0; a < 3; ++a) {
      const auto [low, high] = std::minmax(nodes[k + a], nodes[k + (a + 1) % 3]);
      if (low != high) edges.emplace_back(low, high);
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0, last = 0; k < edges.size(); k = last) {
    for (last = k; last < edges.size() && edges[last] == edges[k];) ++last;
    if (last - k > 1) continue;
    std::vector<double> coords, unused;
    gmsh::model::mesh::getNodes(tags, coords, unused);
    std::array<double, 3> middle{};
    for (std::size_t n = 0; n < tags.size(); ++n)
      for (int d = 0; d < 3 && (tags[n] == edges[k].first || tags[n] == edges[k].second); ++d)
        middle[d] += coords[3 * n + d] / 2;
    return middle;
  }
  return std::nullopt;
}

/// Makes a body of the triangles of an STL.
/// @return why there is none; "" if there is
std::string fill_surface()
{
  constexpr const char *remedy =
      ". An STL must be the closed surface of a body in space; repair it in the program that "
      "made it, or give a STEP file or a mesh with cells";
  constexpr double pi = 3.14159265358979323846;
  constexpr double edge_angle =
      40 * pi / 180; // [rad] between triangles, at edges of the body: that of gmsh's own example for STL files
  gmsh::model::mesh::removeDuplicateNodes();
  if (const auto at = open_edge()) { // gmsh divides some open surfaces for ever
    std::ostringstream text;
    text << "its triangles do not bound a body: there is an open edge at (" << (*at)[0] << ", " << (*at)[1] << ", "
         << (*at)[2] << ")" << remedy;
    return text.str();
  }
  gmsh::model::mesh::classifySurfaces(edge_angle, true, true, pi);
  gmsh::vectorpair surfaces, curves;
  gmsh::model::getEntities(surfaces, 2);
  for (const auto &[dim, tag] : surfaces) {
    gmsh::vectorpair around;
    gmsh::model::getBoundary({{dim, tag}}, around, false, false, false);
    for (const auto &[of_curve, curve] : around) curves.emplace_back(of_curve, std::abs(curve));
  }
  std::sort(curves.begin(), curves.end());
  for (const auto &curve : curves)
    if (std::count(curves.begin(), curves.end(), curve) != 2)
      return std::string("its triangles do not bound a body: there is an edge of more than two faces") + remedy;
  gmsh::model::mesh::createGeometry();
  std::vector<int> tags;
  for (const auto &[dim, tag] : surfaces) tags.push_back(tag);
  gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(tags)});
  gmsh::model::geo::synchronize();
  return "";
}

/// Whether all of a model has one z, to a millionth of its size.
bool in_one_height()
{
  double low[3], high[3];
  gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
  constexpr double flat = 1e-6;
  return high[2] - low[2] <= flat * std::hypot(high[0] - low[0], high[1] - low[1]);
}

/// Makes solids of faces that bound them, as most IGES files have them. @return whether there is a solid then
bool sew_faces(std::vector<std::string> &notes)
{
  gmsh::vectorpair all, sewn;
  gmsh::model::getEntities(all, 2);
  double low[3], high[3];
  gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
  constexpr double gap = 1e-6; // of the body, between edges that are one: IGES writes seven digits and more
  const double size = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  gmsh::model::occ::healShapes(sewn, all, gap * size);
  gmsh::model::occ::remove(all, true);
  gmsh::model::occ::synchronize();
  gmsh::model::getEntities(sewn, 3);
  if (sewn.empty()) return false;
  notes.push_back("the file has " + std::to_string(all.size()) + " faces and no solid: they are sewn, and bound " +
                  (sewn.size() == 1 ? "one solid" : std::to_string(sewn.size()) + " solids"));
  return true;
}

/// "Shapes/bracket/foot" is the "foot" of a file. What translators make up is no name.
std::string name_in_file(const int dim, const int tag)
{
  std::string name;
  gmsh::model::getEntityName(dim, tag, name);
  name.erase(0, name.find_last_of('/') + 1);
  return name.find("translator") == name.npos && name.find("Created by") == name.npos ? name : "";
}

/// The entities of a dimension, by name in the order of their numbers.
std::vector<std::pair<std::string, std::vector<int>>> named_entities(const int dim, const bool boundary)
{
  gmsh::vectorpair all;
  gmsh::model::getEntities(all, dim);
  std::sort(all.begin(), all.end());
  std::vector<std::pair<std::string, std::vector<int>>> groups;
  for (const auto &[of_dim, tag] : all) {
    std::vector<int> upward, downward;
    gmsh::model::getAdjacencies(dim, tag, upward, downward);
    if (boundary && upward.size() != 1) continue;
    std::string name = boundary || all.size() > 1 ? name_in_file(dim, tag) : whole_body;
    if (name.empty()) name = kind_of_entity[dim] + (" " + std::to_string(tag));
    const auto same = std::find_if(groups.begin(), groups.end(), [&, n = name](const auto &g) { return g.first == n; });
    if (same == groups.end())
      groups.push_back({name, {tag}});
    else
      same->second.push_back(tag);
  }
  return groups;
}

} // namespace

std::string open_file(const GmshRequest &request, std::vector<std::string> &notes)
{
  const bool shapes = format_of(request.file) == MeshFormat::shapes;
  {
    const TimeToRead limit(shapes ? request.file : "");
    gmsh::open(request.file);
  }
  if (!shapes || !first_error().empty()) return "";
  if (extension_of(request.file) == ".stl") return fill_surface();
  gmsh::vectorpair bodies;
  gmsh::model::getEntities(bodies, gmsh::model::getDimension());
  if (bodies.empty() || gmsh::model::getDimension() < 2) return "there is no solid and no surface in it";
  if (gmsh::model::getDimension() == 2 && !in_one_height() && !sew_faces(notes))
    return "its faces do not bound a solid: there is an open edge, or a face twice. Write the body as a solid, in a "
           "STEP "
           "file; for a body in the plane, its face at one height z";
  join_parts();
  return "";
}

std::string with_remedy(const std::string &complaint)
{
  const std::size_t begin = complaint.find('\''), end = complaint.find("', line ", begin + 1);
  if (end == complaint.npos || complaint.find("syntax error", end) == complaint.npos) return complaint;
  const std::string file = complaint.substr(begin + 1, end - begin - 1);
  const std::string extension = extension_of(file);
  if (extension.empty() || extension == ".geo" || extension == ".pos" || extension == ".opt") return complaint;
  return complaint + "; gmsh does not read this format, and took the file for a script: name it as \"Mesh->File\" "
                     "itself, without a .geo";
}

std::string why_no_cells(const GmshContents &contents)
{
  for (const auto &elements : contents.elements)
    if (contents.groups[elements.group].dim == contents.dim && !elements.tags.empty()) return "";
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, contents.dim);
  for (const auto &[dim, tag] : surfaces) {
    std::string type;
    gmsh::model::getType(dim, tag, type);
    if (contents.dim != 2 || type != "Discrete surface") return "";
  }
  if (surfaces.empty()) return "";
  return "there is nothing but the triangles of an STL or of a mesh, a surface that encloses no volume yet: name the "
         "STL as "
         "\"Mesh->File\" itself, "
         "or go on in the .geo with ClassifySurfaces, CreateGeometry, Surface Loop and Volume";
}

void set_own_size(const GmshRequest &request)
{
  if (!(request.size > 0)) return;
  for (const char *const bound : {"Mesh.MeshSizeMin", "Mesh.MeshSizeMax"}) gmsh::option::setNumber(bound, request.size);
}

double expected_nodes(const GmshRequest &request)
{
  if (!(request.size > 0) || extension_of(request.file) == ".stl") return 0;
  const double h = request.size * request.size_factor;
  const double nodes_of_size[] = {2 / (std::sqrt(3.) * h * h), std::sqrt(2.) / (h * h * h)}; // the densest lattices
  double nodes = 0;
  for (const int dim : {2, 3}) {
    gmsh::vectorpair entities;
    gmsh::model::getEntities(entities, dim);
    for (const auto &[of_dim, tag] : entities) {
      double size = 0;
      gmsh::model::occ::getMass(of_dim, tag, size);
      nodes += nodes_of_size[dim - 2] * size;
    }
  }
  return nodes;
}

void take_shapes(GmshContents &contents)
{
  for (const bool boundary : {true, false}) {
    const int dim = boundary ? contents.dim - 1 : contents.dim;
    for (const auto &[name, entities] : named_entities(dim, boundary))
      take_group({dim, entities.front(), name}, entities, contents);
  }
}

} // namespace rpc::mesh
