// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_info.hpp"

#include "rpc/core/error.hpp"
#include "rpc/io/atomic_file.hpp"
#include "rpc/io/mesh_picture.hpp"
#include "rpc/mesh/gmsh.hpp"
#include "rpc/mesh/mesh_summary.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace rpc
{
namespace
{

using mesh::MeshSummary;
using mesh::PartSummary;

/// A vector in its components; what is rounding against `size` is 0.
std::string in_components(const std::array<double, 3> &v, const int dim, const double size)
{
  std::ostringstream text;
  for (int c = 0; c < dim; ++c) text << (c > 0 ? ", " : "(") << (std::abs(v[c]) <= 1e-9 * size ? 0 : v[c]);
  return text.str() + ")";
}

std::string box_text(const PartSummary &part, const int dim, const double size)
{
  std::ostringstream text;
  const auto shown = [&](const double x) { return std::abs(x) <= 1e-9 * size ? 0 : x; };
  for (int d = 0; d < dim; ++d)
    text << (d > 0 ? ", " : "") << "xyz"[d] << " from " << shown(part.lower[d]) << " to " << shown(part.upper[d]);
  return text.str();
}

void print_line(std::ostream &out, const std::string &heading, const std::string &text)
{
  out << "  " << heading << std::string(heading.size() < 12 ? 12 - heading.size() : 1, ' ') << text << '\n';
}

std::string facets_text(const PartSummary &part, const int dim, const double size)
{
  std::ostringstream text;
  text << part.count << (part.count == 1 ? " facet" : " facets") << ", " << (dim == 2 ? "length " : "area ")
       << part.measure << ", centroid " << in_components(part.centroid, dim, size);
  const double length = std::hypot(part.normal[0], part.normal[1], part.normal[2]);
  if (length < 1e-3)
    text << ", normals in all directions";
  else
    text << ", normal " << in_components(part.normal, dim, 1) << (length < 1 - 1e-6 ? " in the mean" : "");
  text << "; " << box_text(part, dim, size);
  return text.str();
}

double size_of(const PartSummary &body)
{
  return std::hypot(body.upper[0] - body.lower[0], body.upper[1] - body.lower[1], body.upper[2] - body.lower[2]);
}

} // namespace

std::string mesh_info(const std::string &file, const std::string &folder)
{
  std::error_code ignored;
  RPC_REQUIRE(std::filesystem::exists(file, ignored),
              "command line: --mesh-info: there is no file \"" << file << "\" in the current folder");
  mesh::GmshOptions options;
  options.file = file;
  options.list_surfaces = true;
  const mesh::MeshData mesh = mesh::read_gmsh(options);
  MeshSummary summary = mesh::summary_of(mesh);
  const int dim = summary.element.dim;
  if (dim == 2) // rounding of the third coordinate, which there is not
    for (auto *const parts : {&summary.blocks, &summary.sides, &summary.surfaces})
      for (PartSummary &part : *parts) part.lower[2] = part.upper[2] = 0;
  summary.body.lower[2] = dim == 2 ? 0 : summary.body.lower[2];
  summary.body.upper[2] = dim == 2 ? 0 : summary.body.upper[2];
  const double size = size_of(summary.body);
  std::ostringstream out;
  out << file << ": " << summary.num_cells << " cells of " << summary.element.name()
      << (dim == 2 ? " in the plane, " : " in space, ") << summary.num_nodes << " nodes; "
      << box_text(summary.body, dim, size) << '\n';
  const auto quoted = [](const std::string &name) { return "\"" + name + "\""; };
  for (const PartSummary &block : summary.blocks) {
    std::ostringstream text;
    text << quoted(block.name) << ": " << block.count << " cells, " << (dim == 2 ? "area " : "volume ")
         << block.measure;
    if (summary.blocks.size() > 1) text << "; " << box_text(block, dim, size);
    print_line(out, "block", text.str());
  }
  const std::string surface = dim == 2 ? "curve" : "surface";
  const auto named_by_number = [&](const PartSummary &side) {
    const auto &all = summary.surfaces;
    return std::any_of(all.begin(), all.end(),
                       [&](const PartSummary &each) { return side.name == surface + " " + std::to_string(each.tag); });
  };
  const auto drawn = [&](const std::string &name) {
    for (std::size_t k = 0; k < summary.sides.size(); ++k)
      if (summary.sides[k].name == name) return "; drawn " + io::colour_of_side(k);
    return std::string();
  };
  for (const PartSummary &side : summary.sides)
    if (!named_by_number(side))
      print_line(out, "side", quoted(side.name) + ": " + facets_text(side, dim, size) + drawn(side.name));
  for (const PartSummary &each : summary.surfaces) {
    const std::string number = std::to_string(each.tag);
    print_line(out, surface,
               number + ", " + each.name + ": " + facets_text(each, dim, size) + drawn(surface + " " + number));
  }
  for (const mesh::PointData &points : mesh.points)
    print_line(out, "points",
               quoted(points.name) + ": " + std::to_string(points.node.size()) +
                   (points.node.size() == 1 ? " node" : " nodes"));
  std::ostringstream boundary, edges, quality;
  boundary << summary.boundary.count << " facets, " << (dim == 2 ? "length " : "area ") << summary.boundary.measure;
  print_line(out, "boundary", boundary.str());
  edges << "edges of cells from " << summary.least_edge << " to " << summary.greatest_edge << ", in the mean "
        << summary.mean_edge;
  print_line(out, "sizes", edges.str());
  quality << "scaled Jacobian from " << summary.least_quality << ", in the mean " << summary.mean_quality
          << "; 1 is a regular cell, 0 a flat one";
  print_line(out, "quality", quality.str());
  for (const std::string &note : mesh.notes) print_line(out, "note", note);
  const std::filesystem::path picture =
      std::filesystem::path(folder) / (std::filesystem::path(file).stem().string() + ".mesh.png");
  io::require_writable_folder(folder);
  io::write_text(picture.string(), io::mesh_picture(mesh));
  print_line(out, "picture", picture.lexically_normal().string());
  return out.str();
}

} // namespace rpc
