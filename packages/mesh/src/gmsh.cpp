// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/gmsh.hpp"

#include "exodus_mesh.hpp"
#include "gmsh_mesh.hpp"
#include "gmsh_nearest.hpp"
#include "gmsh_process.hpp"
#include "mesh_checks.hpp"
#include "mesh_formats.hpp"
#include "meshio.hpp"
#include "middle_nodes.hpp"
#include "msh_reader.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"
#include "side_places.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <regex>
#include <sstream>
#include <utility>

namespace rpc::mesh
{
namespace
{

namespace fs = std::filesystem;

/// What messages begin with.
std::string where_of(const GmshOptions &options)
{
  return "mesh: \"" + options.file + "\": ";
}

MeshFormat known_format(const std::string &where, const GmshOptions &options)
{
  const MeshFormat format = format_of(options.file);
  RPC_REQUIRE(format != MeshFormat::unknown,
              where << "its name must end in one of " << join(known_endings()) << ", which tells the format");
  return format;
}

std::string read_text(const std::string &where, const std::string &path)
{
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  const bool open = file.is_open();
  std::string text;
  std::vector<char> piece(1 << 20);
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    text.append(piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  std::error_code ignored;
  RPC_REQUIRE(open && !file.bad() && !fs::is_directory(path, ignored),
              where << "cannot be opened: "
                    << (fs::is_directory(path, ignored) ? "it is a folder" : std::strerror(errno)));
  RPC_REQUIRE_CODE(text.rfind("version https://git-lfs.github.com/spec/", 0) != 0, ExitCode::bad_mesh,
                   where << "is a pointer of Git LFS in place of the file; git lfs pull fetches it");
  return text;
}

/// Of a last line without a line break gmsh 4.8 silently reads the first statement only.
void check_last_line(const std::string &where, const std::string &geo)
{
  const std::size_t statement = geo.find(';', geo.find_last_of('\n') + 1);
  RPC_REQUIRE_CODE(statement == geo.npos || geo.find_first_not_of(" \t\r", statement + 1) == geo.npos,
                   ExitCode::bad_mesh,
                   where << "the last line must end in a line break, or gmsh would ignore a part of it");
}

void check_number_of_cells(const std::string &where, const SizeField &field, const double factor)
{
  constexpr double most_cells = 5e6;
  const double cells = expected_cells(field) / std::pow(factor, field.dim);
  RPC_REQUIRE_CODE(cells <= most_cells, ExitCode::bad_mesh,
                   where << "cell sizes are too small: they ask for about " << cells << " cells; at most " << most_cells
                         << " are made");
}

/// A line of a .geo without comment and blanks around it.
std::string code_of(const std::string &line)
{
  const std::string code = line.substr(0, line.find("//"));
  const auto first = code.find_first_not_of(" \t\r");
  return first == code.npos ? "" : code.substr(first, code.find_last_not_of(" \t\r") - first + 1);
}

/// Whether a line, which is not empty, lacks the ";" of its command; what ends with "}" may be one of several lines unless it assigns.
bool needs_end(const std::string &code)
{
  return code.back() == '}' ? code.find('=') != code.npos : !std::strchr(";{,", code.back());
}

/// What to do about gmsh's complaint, most often of an error in a .geo: sentences behind gmsh's own words; empty if nothing is known.
std::string complaint_remedy(const std::string &file, const std::string &complaint)
{
  static const std::regex syntax(R"(line (\d+): syntax error \((.*)\).*)"), variable(R"(.*Unknown variable '(.*)'.*)"),
      unknown(R"(.*Unknown .*)"), no_file(R"(.*Unable to open file.*)"),
      graphical(R"(.*graphical interface context.*)"),
      no_triangles(R"(.*(Wrong number of points|Empty bounding box|No facets found|Error loading).*)");
  std::smatch found;
  if (format_of(file) == MeshFormat::by_gmsh ||
      (extension_of(file) == ".stl" && std::regex_match(complaint, no_triangles)))
    return ". The file is damaged, or gmsh does not know what it holds: write it anew, " +
           std::string(extension_of(file) == ".stl" ? "or as STEP" : "best as .msh or Exodus");
  if (std::regex_match(complaint, found, variable))
    return ". Write " + found[1].str() + " = ...; before it is used, or correct the name";
  if (complaint.find("for parametrization") != complaint.npos)
    return ". gmsh cannot divide this surface of triangles: give a STEP file, or a mesh with cells";
  if (std::regex_match(complaint, graphical))
    return ". Leave out the Print that asks for it: rpc needs the geometry alone";
  if (std::regex_match(complaint, no_file))
    return ". Files are looked for beside the .geo: name this one, or its whole path";
  if (std::regex_match(complaint, unknown)) return ". Define it in a line before that one, or correct its number";
  if (!std::regex_match(complaint, found, syntax)) return "";
  std::ifstream in(file);
  const int wrong = std::stoi(found[1]);
  std::string text, line, before;
  int number_before = 0;
  for (int number = 1; number <= wrong && std::getline(in, line); ++number) {
    if (number == wrong) text = line;
    if (number == wrong || code_of(line).empty()) continue;
    before = line;
    number_before = number;
  }
  static const std::vector<std::string> commands = {"Point",        "Line",
                                                    "Circle",       "Ellipse",
                                                    "Spline",       "BSpline",
                                                    "Curve",        "Surface",
                                                    "Volume",       "Physical",
                                                    "Loop",         "Plane",
                                                    "Field",        "Background",
                                                    "Merge",        "SetFactory",
                                                    "Extrude",      "Transfinite",
                                                    "Recombine",    "Rectangle",
                                                    "Disk",         "Box",
                                                    "Sphere",       "Cylinder",
                                                    "Cone",         "BooleanDifference",
                                                    "BooleanUnion", "DefineConstant"};
  const std::string word = found[2], meant = did_you_mean(word, commands);
  const auto quoted = [](const std::string &of) { return '"' + code_of(of).substr(0, 60) + '"'; };
  const bool first_in_line = text.find(word) == text.find_first_not_of(" \t");
  if (first_in_line && number_before > 0 && needs_end(code_of(before)))
    return ". Write \";\" at the end of line " + std::to_string(number_before) + ", " + quoted(before);
  const bool known = std::find(commands.begin(), commands.end(), word) != commands.end();
  return " in " + quoted(text) + "." +
         (known || meant.empty()
              ? " Look for a word, a bracket, a comma or a \";\" that is wrong or missing there or before"
              : meant);
}

/// Whether gmsh may end itself before the last line.
bool has_exit(const std::string &geo)
{
  static const std::regex statement(R"((^|[\n;{}])\s*Exit\s*;)");
  return std::regex_search(geo, statement);
}

/// @param[out] again  whether another attempt may do better where this one fails
GmshContents answer_of_gmsh(const std::string &where, const GmshOptions &options, const GmshRequest &request,
                            bool &again)
{
  GmshContents contents = run_gmsh(where, request);
  again = contents.again || contents.complaint.empty();
  const std::string file = "'" + options.file + "', "; // which the message has named
  if (contents.complaint.compare(0, file.size(), file) == 0) contents.complaint.erase(0, file.size());
  RPC_REQUIRE_CODE(contents.complaint.empty(), ExitCode::bad_mesh,
                   where << "gmsh: " << contents.complaint << complaint_remedy(options.file, contents.complaint));
  return contents;
}

/// One attempt at a mesh, checked. @param[out] again  whether another one may do better where it fails
MeshData attempt(const std::string &where, const GmshOptions &options, const GmshRequest &request, bool &again)
{
  GmshContents contents = answer_of_gmsh(where, options, request, again);
  RPC_REQUIRE_CODE(!options.sizes || contents.dim == options.sizes->dim, ExitCode::bad_mesh,
                   where << "a body in " << contents.dim << "D cannot be meshed by a field of cell sizes in "
                         << options.sizes->dim << "D");
  return mesh_of_gmsh(where, std::move(contents), true);
}

/// Whether a side is chosen by a surface of the geometry.
bool by_surfaces(const std::vector<SidePlace> &sides)
{
  return std::any_of(sides.begin(), sides.end(),
                     [](const SidePlace &side) { return !side.surfaces.empty() || !side.near.empty(); });
}

/// What a file of shapes has been taken for; empty where the deck's unit of length is the file's, or is named and the file tells none.
/// @param unit  see GmshOptions::length_unit
std::string note_on_unit(const MeshData &mesh, const std::string &file, const std::string &unit)
{
  const bool has_unit = extension_of(file) != ".stl" && extension_of(file) != ".brep";
  if (!unit.empty() && (unit == "mm" || !has_unit)) return "";
  const int dim = mesh.element.dim;
  std::ostringstream note;
  note << std::setprecision(3); // the same for all meshes of a curved body
  note << "\"" << fs::path(file).filename().string() << "\": the body is ";
  for (int d = 0; d < dim; ++d) {
    double low = mesh.coords[d], high = low;
    for (std::size_t n = d; n < mesh.coords.size(); n += dim) {
      low = std::min(low, mesh.coords[n]);
      high = std::max(high, mesh.coords[n]);
    }
    note << (d > 0 ? " x " : "") << high - low;
  }
  if (unit.empty())
    note << (has_unit ? " in the file's mm" : " in the file's unit of length, which it does not tell")
         << "; the deck's unit of length counts: see \"Units\"";
  else
    note << " " << unit << " in this deck: lengths of the file are read in mm, for which \"Units->Length\" is mm";
  return note.str();
}

GmshRequest request_for(const GmshOptions &options)
{
  GmshRequest request;
  std::error_code ignored;
  request.folder = fs::current_path(ignored).string();
  request.file = options.file;
  return request;
}

MeshData made_by_gmsh(const std::string &where, const GmshOptions &options)
{
  GmshRequest request = request_for(options);
  request.size_factor = options.size_factor;
  request.order = options.order == 0 ? 2 : options.order;
  request.geometry = options.needs_geometry() || options.list_surfaces || by_surfaces(options.sides);
  request.size = options.size;
  request.straight_where_bent = options.straight_where_bent;
  if (options.box) {
    const mesh::Element &element = options.box->element;
    request.box_dim = element.dim;
    std::copy_n(options.box->lower.begin(), element.dim, request.lower.begin());
    std::copy_n(options.box->upper.begin(), element.dim, request.upper.begin());
    request.quadrilaterals = element.dim == 2 && element.shape == Shape::tensor;
    request.order = 1; // middle nodes of straight edges are made faster than gmsh does it
  }
  if (options.sizes) {
    check_sizes(where, *options.sizes);
    check_number_of_cells(where, *options.sizes, options.size_factor);
    request.sizes = *options.sizes;
    request.simplices = options.simplices;
  }
  const int most_attempts = options.sizes ? 5 : 2;
  for (;; ++request.attempt) {
    const bool is_last = request.attempt + 1 == most_attempts;
    bool again = false;
    try {
      return attempt(where, options, request, again);
    } catch (const BentCell &) {
      if (is_last) throw;
    } catch (const Error &) {
      if (!again || !options.sizes || is_last) throw;
    }
  }
}

MeshData meshed_geometry(const std::string &where, const GmshOptions &options)
{
  const std::string text = read_text(where, options.file);
  if (format_of(options.file) == MeshFormat::geo) check_last_line(where, text);
  MeshData mesh;
  try {
    mesh = made_by_gmsh(where, options);
  } catch (const Error &refused) {
    const std::string what = refused.what();
    if (what.find("gmsh ended without a mesh") == what.npos || !has_exit(text)) throw;
    throw Error(refused.code(), what + ". The .geo has Exit;, which ends gmsh before: leave it out");
  }
  if (format_of(options.file) != MeshFormat::shapes) return mesh;
  const std::string note = note_on_unit(mesh, options.file, options.length_unit);
  if (!note.empty()) mesh.notes.push_back(note);
  return mesh;
}

/// What a file that has a mesh contains. Its text takes much memory, and is gone on return.
GmshContents contents_of_mesh(const std::string &where, const GmshOptions &options)
{
  if (options.contents && !options.contents->elements.empty()) return std::exchange(*options.contents, {});
  const MeshFormat format = format_of(options.file);
  if (format == MeshFormat::msh) return read_msh(where, read_text(where, options.file));
  read_text(where, options.file); // whether it can be opened
  if (format == MeshFormat::exodus) return read_exodus_mesh(where, options.file);
  if (format == MeshFormat::meshio) return read_by_meshio(where, options.file);
  bool unused = false;
  GmshContents contents = answer_of_gmsh(where, options, request_for(options), unused);
  contents.kind.fill("group");
  return contents;
}

MeshData read_mesh_file(const std::string &where, const GmshOptions &options)
{
  try {
    return mesh_of_gmsh(where, contents_of_mesh(where, options), false);
  } catch (const BentCell &refused) {
    throw Error(refused.code(), std::string(refused.what()) + ", or set Mesh.HighOrderOptimize = 1 in gmsh");
  }
}

MeshData read_box(const GmshOptions &options)
{
  const std::string where = "mesh: box: ";
  RPC_REQUIRE(options.file.empty() && options.sizes,
              where << "gmsh meshes one by a field of sizes only, and not along with a file");
  MeshData mesh = made_by_gmsh(where, options);
  return options.box->element.order == 2 ? with_middle_nodes(std::move(mesh)) : mesh;
}

} // namespace

int gmsh_dimension(const GmshOptions &options)
{
  if (options.box) return options.box->element.dim;
  const std::string where = where_of(options);
  const MeshFormat format = known_format(where, options);
  if (format == MeshFormat::msh) return dimension_of_msh(where, read_text(where, options.file));
  if (!is_geometry(format)) {
    GmshContents contents = contents_of_mesh(where, options);
    const int dim = contents.dim;
    if (options.contents) *options.contents = std::move(contents);
    return dim;
  }
  const std::string text = read_text(where, options.file);
  if (format == MeshFormat::geo) check_last_line(where, text);
  GmshRequest request = request_for(options);
  request.dimension_only = true;
  bool unused = false;
  return answer_of_gmsh(where, options, request, unused).dim;
}

std::vector<double> nearest_of_geo(const std::string &file, const std::vector<int> &tags,
                                   const std::vector<double> &coords)
{
  GmshOptions options;
  options.file = file;
  GmshRequest request = request_for(options);
  request.near_tags = tags;
  request.near_coords = coords;
  bool unused = false;
  return answer_of_gmsh(where_of(options), options, request, unused).coords;
}

MeshData read_gmsh(const GmshOptions &options)
{
  if (options.box) return read_box(options);
  const std::string where = where_of(options);
  const bool make = is_geometry(known_format(where, options));
  RPC_REQUIRE(make || options.size_factor == 1,
              where << "a size factor only goes with a geometry, such as a .geo, got " << options.size_factor);
  RPC_REQUIRE(make || !options.sizes, where << "cell sizes only go with a geometry, such as a .geo");
  MeshData mesh = make ? meshed_geometry(where, options) : read_mesh_file(where, options);
  add_sides(options.sides, mesh);
  if (!options.list_surfaces && !(options.needs_geometry() && keeps_geometry(options.file))) mesh.geometry.clear();
  if (options.needs_geometry() && keeps_geometry(options.file)) mesh.geometry_file = options.file;
  RPC_REQUIRE(options.order == 0 || options.order == mesh.element.order,
              where << "its cells are of order " << mesh.element.order << ", which \"Order\" = " << options.order
                    << " does not change; that only goes with a geometry, such as a .geo");
  return mesh;
}

} // namespace rpc::mesh
