#include "rpc/mesh/gmsh.hpp"

#include "gmsh_mesh.hpp"
#include "gmsh_module.hpp"
#include "msh_reader.hpp"
#include "rpc/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace rpc::mesh
{
namespace
{

namespace fs = std::filesystem;

#ifdef RPC_GMSH_MODULE
/// Where the module may lie: in an install tree, wherever that was moved, or where it was built.
fs::path find_module()
{
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = (program.parent_path() / RPC_GMSH_MODULE_FROM_BIN).lexically_normal();
  return !error && fs::exists(installed, error) ? installed : fs::path(RPC_GMSH_MODULE);
}

LoadGmsh *load_module()
{
  const std::string path = find_module().string();
  // Never closed: the next .geo needs it again.
  void *const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void *const function = module ? dlsym(module, load_gmsh_symbol) : nullptr;
  if (!function) {
    const char *const reason = dlerror();
    throw Error(ExitCode::bad_input, "mesh: gmsh cannot be loaded: " + std::string(reason ? reason : path) +
                                         "; install gmsh's library (on Debian libgmsh4.8), or rpc anew");
  }
  return reinterpret_cast<LoadGmsh *>(function);
}
#else
LoadGmsh *load_module()
{
  throw Error(ExitCode::bad_input, "mesh: this rpc was built without gmsh, which meshes a .geo; build it with gmsh (on "
                                   "Debian libgmsh-dev), or run gmsh -2 and give the .msh");
}
#endif

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
  static LoadGmsh *const load = load_module();
  GmshContents contents;
  load({options.file, options.size_factor, options.order == 0 ? 2 : options.order}, contents);
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
