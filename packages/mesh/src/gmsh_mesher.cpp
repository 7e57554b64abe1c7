// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_mesher.hpp"

#include "gmsh_boundary.hpp"
#include "gmsh_box.hpp"
#include "gmsh_shapes.hpp"
#include "gmsh_size_callback.hpp"
#include "mesh_formats.hpp"
#include "size_tree.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <gmsh.h>
#include <initializer_list>
#include <iomanip>
#include <map>
#include <new>
#include <set>
#include <sstream>
#include <utility>

namespace rpc::mesh
{
namespace
{

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

constexpr std::size_t most_nodes = 2'000'000; // of order 1: larger meshes are for gmsh alone

/// Meshes surfaces and volumes; a bound on the nodes inside them gives sizes that are absurd an end.
void mesh_surfaces_and_volumes()
{
  std::size_t nodes = 0; // gmsh asks for the size at each, once
  set_size_callback([&](int, int, double, double, double, const double own_size) {
    if (++nodes > most_nodes)
      throw "cell sizes are too small: surfaces and volumes would have more than " + std::to_string(most_nodes) +
          " nodes";
    return own_size;
  });
  gmsh::model::mesh::generate(3);
  gmsh::model::mesh::removeSizeCallback();
}

/// By cell sizes of the .geo's own. @return whether those on curves have an end
/// @param again  whether curves can be meshed more than once: those of an STL are lost then
bool mesh_by_own_sizes(const double body, const double factor, const int dim, const bool again)
{
  gmsh::option::setNumber("Mesh.MeshSizeFactor", factor);
  constexpr double most_cells_along = 1e4; // of a body whose curves are meshed once
  if (again ? !mesh_curves(body, factor) : body > most_cells_along * factor * number_option("Mesh.MeshSizeMax"))
    return false;
  if (dim == 3)
    mesh_surfaces_and_volumes();
  else
    gmsh::model::mesh::generate(2);
  return true;
}

/// Whether the .geo recombines triangles to quadrilaterals, which nothing but a mesh tells: a coarse one.
bool recombines()
{
  const double order = number_option("Mesh.ElementOrder");
  gmsh::option::setNumber("Mesh.ElementOrder", 1);
  set_size_callback([](int, int, double, double, double, double) { return unbounded_size; });
  gmsh::model::mesh::generate(2);
  gmsh::option::setNumber("Mesh.ElementOrder", order);
  std::vector<std::size_t> tags, nodes;
  constexpr int quadrilateral = 3;
  gmsh::model::mesh::getElementsByType(quadrilateral, tags, nodes);
  gmsh::model::mesh::clear();
  return !tags.empty();
}

/// Surfaces and volumes have the sizes of a field alone.
/// @param algorithm  of surfaces, gmsh's number
void leave_sizes_to_field(const double algorithm)
{
  for (const int dimension : {2, 3}) {
    gmsh::vectorpair entities;
    gmsh::model::getEntities(entities, dimension);
    for (const auto &[dim, entity] : entities) {
      gmsh::model::mesh::setSizeFromBoundary(dim, entity, 0);
      if (dim == 2) gmsh::model::mesh::setAlgorithm(dim, entity, static_cast<int>(algorithm));
    }
  }
}

/// Nothing is recombined to quadrilaterals any more.
void keep_triangles()
{
  gmsh::vectorpair surfaces;
  gmsh::model::getEntities(surfaces, 2);
  gmsh::model::mesh::removeConstraints(surfaces);
  gmsh::option::setNumber("Mesh.RecombineAll", 0);
}

/// What belongs to a .geo's own cell sizes goes out of play, but for curvature where it asks for cells by it.
void set_field_options(const GmshRequest &request)
{
  // Frontal-Delaunay: of all algorithms the one whose cells are the best and about as many as asked for. Delaunay takes two
  // thirds of the time, but leaves cells without area where boundary sizes are a millionth of the body; so do both of them
  // where nodes are moved by more than 1e-12 of the body to avoid ties. Where they are moved by less, some ties remain.
  // In space gmsh 4.12 and later leave facets that overlap at the tip of a cone, for some sizes with one of the two algorithms,
  // for others with the other one: every second attempt is Delaunay's.
  constexpr double frontal = 6, delaunay = 5;
  const double on_surfaces = request.sizes.dim == 3 && request.attempt % 2 == 1 ? delaunay : frontal;
  // In space Delaunay: HXT takes a quarter of the time for cells as good, but its meshes differ from run to run, on one thread too.
  constexpr double delaunay_in_space = 1;
  const double tie_breaker = 1e-13 * std::pow(10, request.attempt);
  gmsh::model::mesh::field::setAsBackgroundMesh(-1); // none
  leave_sizes_to_field(on_surfaces);
  const std::initializer_list<std::pair<const char *, double>> options = {
      {"MeshSizeFromPoints", 0},
      {"MeshSizeFromParametricPoints", 0},
      {"MeshSizeExtendFromBoundary", 0},
      {"MeshSizeMin", 0},
      {"MeshSizeMax", 1e22},
      {"MeshSizeFactor", 1},
      {"Algorithm", on_surfaces},
      {"Algorithm3D", delaunay_in_space},
      {"RandomFactor", tie_breaker},
      {"Smoothing", 0},                 // it takes half as long as all the rest, and triangles are good without
      {"LcIntegrationPrecision", 1e-4}, // cells, per step along a curve: the default takes a thousand times the steps
      {"SubdivisionAlgorithm", 0}};
  for (const auto &[name, value] : options) gmsh::option::setNumber(std::string("Mesh.") + name, value);
  const bool by_file = !request.file.empty() && recombines();
  if (by_file && request.simplices) {
    keep_triangles();
    leave_sizes_to_field(on_surfaces);
  } else if (request.quadrilaterals || by_file) {
    gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", 1); // or some triangles would be left
    gmsh::option::setNumber("Mesh.Smoothing", 1);            // or some quadrilaterals would be inverted
    if (request.quadrilaterals) gmsh::option::setNumber("Mesh.RecombineAll", 1);
  }
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

/// @param asked  tags of curves
/// @return the tag of another one that is divided, 0 if there is none but copies of others
int curve_that_asked_for_no_size(const std::set<int> &asked)
{
  gmsh::vectorpair curves;
  gmsh::model::getEntities(curves, 1);
  for (const auto &[dim, curve] : curves) {
    if (asked.count(curve) || elements_of(1, curve).types.empty())
      continue; // the latter is a point, such as a sphere's pole
    int master = curve;
    std::vector<std::size_t> nodes, master_nodes;
    std::vector<double> transformation;
    gmsh::model::mesh::getPeriodicNodes(dim, curve, master, nodes, master_nodes, transformation);
    if (master == curve) return curve;
  }
  return 0;
}

/// Sizes of a field at points.
std::function<double(double, double, double)> sizes_at(const SizeField &field)
{
  if (field.dim == 2)
    return [tree = SizeTree<2>(field)](const double x, const double y, double) { return tree({x, y}); };
  return [tree = SizeTree<3>(field)](const double x, const double y, const double z) { return tree({x, y, z}); };
}

/// @param dim  of the body, that of the field
/// @return why the .geo leaves no room for a size field; "" if there is room
std::string mesh_by_field(const GmshRequest &request, const int dim)
{
  set_field_options(request);
  // Two triangles make a quadrilateral with somewhat shorter edges, and then each edge is halved.
  constexpr double for_quadrilaterals = 2.3;
  const bool quadrilaterals = number_option("Mesh.SubdivisionAlgorithm") != 0;
  const double factor = request.size_factor * (quadrilaterals ? for_quadrilaterals : 1);
  const auto size_at = sizes_at(request.sizes);
  std::size_t calls = 0;
  std::set<int> curves;
  set_size_callback([&](const int dimension, const int entity, const double x, const double y, const double z,
                        const double own_size) { // of curvature, if of anything
    constexpr std::size_t most_calls =
        50'000'000; // of one or two per cell: where the field does not reach, no other bound is
    if (++calls > most_calls) throw std::string("cell sizes are too small where the size field does not reach");
    if (dimension == 1) curves.insert(entity);
    return std::min(own_size, factor * size_at(x, y, z));
  });
  gmsh::model::mesh::generate(1);
  const int fixed = curve_that_asked_for_no_size(curves);
  if (fixed != 0)
    return "curve " + std::to_string(fixed) +
           " is divided by Transfinite or Layers; where cells are to have sizes of a field, leave these out, or "
           "set \"Adapt->Meshes\" to nested";
  gmsh::model::mesh::generate(dim);
  gmsh::model::mesh::removeSizeCallback();
  return "";
}

/// Makes the mesh. @return why its cell sizes make no sense; "" if they do
std::string make_mesh(const GmshRequest &request, const int dim)
{
  constexpr double greatest_factor = 1e9, greatest_body = 1e50;
  const bool field = !request.sizes.simplices.empty();
  const double own_factor = field ? 1 : number_option("Mesh.MeshSizeFactor");
  const double factor = own_factor * request.size_factor, body = diameter();
  std::ostringstream complaint;
  if (!(factor >= 1 / greatest_factor && factor <= greatest_factor))
    complaint << "the factor on cell sizes must be " << 1 / greatest_factor << " to " << greatest_factor << ", got "
              << factor;
  else if (!(body <= greatest_body))
    complaint << "the geometry's size must be at most " << greatest_body << " [m], got " << body;
  if (!complaint.str().empty()) return complaint.str();
  gmsh::option::setNumber("Mesh.ElementOrder", request.order);
  gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 0);
  // Straightens cells whose curved edges bend too far. The first attempt by a field leaves that out, for it takes time.
  const bool straightens = request.attempt > 0, all_cells = straightens && request.straight_where_bent;
  if (straightens || field) gmsh::option::setNumber("Mesh.HighOrderOptimize", straightens && !all_cells);
  if (all_cells) gmsh::option::setNumber("Mesh.SecondOrderLinear", 1);
  if (field)
    complaint << mesh_by_field(request, dim);
  else if (!mesh_by_own_sizes(body, factor, dim, request.file.empty() || keeps_geometry(request.file)))
    complaint << "cell sizes are too small for a body of size " << body
              << " [m]: its curves would have more than 100000 nodes";
  return complaint.str();
}

/// Without groups of the body's dimension all entities of that dimension are the body.
void take_groups(GmshContents &contents)
{
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  std::sort(groups.begin(), groups.end());
  for (const auto &[dim, tag] : groups) {
    if (dim != 0 && dim != contents.dim - 1 && dim != contents.dim) continue;
    GmshGroup group{dim, tag, ""};
    gmsh::model::getPhysicalName(dim, tag, group.name);
    if (dim == 0 && group.name.empty()) continue; // nobody can name it
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, entities);
    for (int &entity : entities) entity = std::abs(entity); // its sign is its direction
    std::sort(entities.begin(), entities.end());
    entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
    take_group(group, entities, contents);
  }
  if (contents.groups.empty() || contents.groups.back().dim < contents.dim) {
    gmsh::vectorpair all;
    gmsh::model::getEntities(all, contents.dim);
    std::vector<int> entities;
    for (const auto &[dim, entity] : all) entities.push_back(entity);
    take_group({contents.dim, 0, whole_body}, entities, contents);
  }
}

void take_nodes(GmshContents &contents)
{
  std::vector<double> parametric;
  gmsh::model::mesh::getNodes(contents.node_tags, contents.coords, parametric, -1, -1, false, false);
}

void load(const GmshRequest &request, GmshContents &contents)
{
  gmsh::logger::start();
  if (request.file.empty())
    add_box(request);
  else
    contents.complaint = open_file(request, contents.notes);
  const std::string error = first_error();
  if (!error.empty()) contents.complaint = with_remedy(error);
  if (!contents.complaint.empty()) return;
  contents.dim = std::max(2, gmsh::model::getDimension());
  if (!request.near_tags.empty()) return take_nearest_points(request, contents);
  const bool sizes_elsewhere = !request.sizes.simplices.empty() && contents.dim != request.sizes.dim;
  if (request.dimension_only || sizes_elsewhere) return;
  const MeshFormat format = format_of(request.file);
  if (format == MeshFormat::by_gmsh) {
    take_groups(contents);
    return take_nodes(contents);
  }
  const bool shapes = format == MeshFormat::shapes;
  if (shapes) set_own_size(request);
  if (const double nodes = shapes ? expected_nodes(request) : 0; nodes > static_cast<double>(most_nodes)) {
    std::ostringstream text;
    text << std::setprecision(3) << "cells of size " << request.size * request.size_factor
         << " are too small for a body of size " << diameter() << ": there would be about " << nodes
         << " nodes, and at most " << most_nodes << " are made. Is \"Size\" in the file's unit of length?";
    contents.complaint = text.str();
    return;
  }
  const std::string absurdity = make_mesh(request, contents.dim);
  contents.complaint = first_error();
  contents.again = !contents.complaint.empty();
  if (contents.complaint.empty()) contents.complaint = absurdity;
  if (!contents.complaint.empty()) return;
  if (shapes)
    take_shapes(contents);
  else
    take_groups(contents);
  contents.complaint = why_no_cells(contents);
  take_nodes(contents);
  if (request.geometry) take_boundary(contents);
}

} // namespace

std::string first_error()
{
  std::vector<std::string> log;
  gmsh::logger::get(log);
  const std::string mark = "Error: ";
  for (const auto &line : log)
    if (line.compare(0, mark.size(), mark) == 0 && line.find("critical value") == line.npos)
      return line.substr(mark.size());
  return "";
}

void take_group(const GmshGroup &group, const std::vector<int> &entities, GmshContents &contents)
{
  contents.groups.push_back(group);
  for (const int entity : entities) {
    EntityElements elements = elements_of(group.dim, entity);
    for (std::size_t t = 0; t < elements.types.size(); ++t)
      contents.elements.push_back({static_cast<int>(contents.groups.size()) - 1, elements.types[t],
                                   std::move(elements.tags[t]), std::move(elements.nodes[t])});
  }
}

void start_gmsh()
{
  // A first mesh, which is thrown away, loads the libraries that meshing needs, once for all later processes.
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  GmshContents unused;
  GmshRequest request;
  request.upper = {1, 1};
  request.sizes = {{0, 0, 1, 0, 0, 1}, {0, 1, 2}, {.3, .3, .3}};
  load(request, unused);
  gmsh::logger::stop();
  gmsh::finalize();

  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  // An exception out of the middle of gmsh's parser would leave it in disorder: errors are logged.
  gmsh::option::setNumber("General.AbortOnError", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
}

GmshContents made_mesh(const GmshRequest &request)
{
  GmshContents contents;
  try {
    load(request, contents);
  } catch (const std::string &message) { // gmsh before 4.12, and the callback that counts cells
    contents.complaint = message;
  } catch (const std::bad_alloc &) {
    contents.complaint = "out of memory";
  } catch (const std::exception &error) { // gmsh 4.12 and later: where no mesh could be made
    contents.complaint = error.what();
    contents.again = true;
  } catch (...) {
    contents.complaint = "unknown error";
  }
  return contents;
}

} // namespace rpc::mesh
