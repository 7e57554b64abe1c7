#include "rpc/mesh/gmsh.hpp"

#include "gmsh_mesh.hpp"
#include "gmsh_process.hpp"
#include "msh_reader.hpp"
#include "rpc/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace rpc::mesh
{
namespace
{

namespace fs = std::filesystem;

std::string read_text(const std::string &where, const std::string &path)
{
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::error_code ignored;
  RPC_REQUIRE(file.good() && !fs::is_directory(path, ignored),
              where << "cannot be opened: "
                    << (fs::is_directory(path, ignored) ? "it is a folder" : std::strerror(errno)));
  return text;
}

/// gmsh 4.8 drops, without a word, what follows the first statement of a last line without a line break.
void check_last_line(const std::string &where, const std::string &geo)
{
  const std::size_t statement = geo.find(';', geo.find_last_of('\n') + 1);
  RPC_REQUIRE_CODE(statement == geo.npos || geo.find_first_not_of(" \t\r", statement + 1) == geo.npos,
                   ExitCode::bad_mesh,
                   where << "the last line must end in a line break, or gmsh would ignore a part of it");
}

GmshContents made_by_gmsh(const std::string &where, const std::string &geo, const GmshOptions &options)
{
  check_last_line(where, geo);
  GmshContents contents = run_gmsh(where, {options.file, options.size_factor, options.order == 0 ? 2 : options.order});
  const std::string file = "'" + options.file + "', "; // which the message has named
  if (contents.complaint.compare(0, file.size(), file) == 0) contents.complaint.erase(0, file.size());
  RPC_REQUIRE_CODE(contents.complaint.empty(), ExitCode::bad_mesh, where << "gmsh: " << contents.complaint);
  return contents;
}

} // namespace

MeshData read_gmsh(const GmshOptions &options)
{
  const std::string where = "mesh: \"" + options.file + "\": ";
  const std::string extension = fs::path(options.file).extension().string();
  RPC_REQUIRE(extension == ".geo" || extension == ".msh", where << "must end in .geo or .msh");
  const bool make = extension == ".geo";
  RPC_REQUIRE(make || options.size_factor == 1,
              where << "a size factor only goes with a .geo, got " << options.size_factor);
  const std::string text = read_text(where, options.file);
  const GmshContents contents = make ? made_by_gmsh(where, text, options) : read_msh(where, text);
  MeshData mesh = mesh_of_gmsh(options.file, contents, make);
  RPC_REQUIRE(options.order == 0 || options.order == mesh.element.order,
              where << "its cells are of order " << mesh.element.order << ", which \"Order\" = " << options.order
                    << " does not change; that only goes with a .geo");
  return mesh;
}

} // namespace rpc::mesh
