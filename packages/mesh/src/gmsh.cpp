// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/gmsh.hpp"

#include "gmsh_mesh.hpp"
#include "gmsh_nearest.hpp"
#include "gmsh_process.hpp"
#include "mesh_checks.hpp"
#include "middle_nodes.hpp"
#include "msh_reader.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/remedies.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
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

/// Or else a .msh.
bool is_geo(const std::string &where, const GmshOptions &options)
{
  const std::string extension = fs::path(options.file).extension().string();
  RPC_REQUIRE(extension == ".geo" || extension == ".msh", where << "must end in .geo or .msh");
  return extension == ".geo";
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

/// What to do about an error in a .geo: sentences behind gmsh's own words; empty if nothing is known.
std::string complaint_remedy(const std::string &file, const std::string &complaint)
{
  static const std::regex syntax(R"(line (\d+): syntax error \((.*)\).*)"), variable(R"(.*Unknown variable '(.*)'.*)"),
      unknown(R"(.*Unknown .*)"), no_file(R"(.*Unable to open file.*)");
  std::smatch found;
  if (std::regex_match(complaint, found, variable))
    return ". Write " + found[1].str() + " = ...; before it is used, or correct the name";
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
         (known || meant.empty() ? " Look for a bracket, a comma or a \";\" that is missing there or before" : meant);
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
  request.geometry = options.needs_geometry();
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

MeshData meshed_geo(const std::string &where, const GmshOptions &options)
{
  check_last_line(where, read_text(where, options.file));
  return made_by_gmsh(where, options);
}

/// The file's text takes much memory, and is gone on return.
GmshContents contents_of_msh(const std::string &where, const GmshOptions &options)
{
  return read_msh(where, read_text(where, options.file));
}

MeshData read_msh_file(const std::string &where, const GmshOptions &options)
{
  try {
    return mesh_of_gmsh(where, contents_of_msh(where, options), false);
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
  const std::string where = where_of(options), text = read_text(where, options.file);
  if (!is_geo(where, options)) return dimension_of_msh(where, text);
  check_last_line(where, text);
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
  const bool make = is_geo(where, options);
  RPC_REQUIRE(make || options.size_factor == 1,
              where << "a size factor only goes with a .geo, got " << options.size_factor);
  RPC_REQUIRE(make || !options.sizes, where << "cell sizes only go with a .geo");
  MeshData mesh = make ? meshed_geo(where, options) : read_msh_file(where, options);
  if (make && options.needs_geometry()) mesh.geometry_file = options.file;
  RPC_REQUIRE(options.order == 0 || options.order == mesh.element.order,
              where << "its cells are of order " << mesh.element.order << ", which \"Order\" = " << options.order
                    << " does not change; that only goes with a .geo");
  return mesh;
}

} // namespace rpc::mesh
