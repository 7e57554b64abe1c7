// SPDX-License-Identifier: BSD-3-Clause
#include "meshio.hpp"

#include "abaqus_script.hpp"
#include "meshio_script.hpp"
#include "msh_reader.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace rpc::mesh
{
namespace
{

namespace fs = std::filesystem;

constexpr const char *while_it_ran = "while meshio converted a file; no results are written";
constexpr const char *install =
    "install it, on Debian: apt-get install python3-meshio python3-h5py, elsewhere: pip install meshio[all]";

/// A folder that goes with what is in it.
class ScratchFolder
{
public:
  explicit ScratchFolder(const std::string &where)
  {
    std::error_code error;
    const fs::path temporary = fs::temp_directory_path(error);
    path_ = ((error ? fs::path("/tmp") : temporary) / "rpc-meshio-XXXXXX").string();
    RPC_REQUIRE(::mkdtemp(path_.data()),
                where << "no folder \"" << path_ << "\" can be made: " << std::strerror(errno));
  }
  ~ScratchFolder()
  {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder &) = delete;
  ScratchFolder &operator=(const ScratchFolder &) = delete;
  std::string file(const char *const name) const { return path_ + "/" + name; }

private:
  std::string path_;
};

std::string contents_of(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Runs python3 with its output in files. @return how it ended, as waitpid() gives it; -1 if it cannot be started
/// @throws rpc::Error (not_converged) where this process is asked to stop meanwhile: then python3 has ended, too
int run_python(std::vector<std::string> arguments, const std::string &out, const std::string &errors)
{
  std::vector<char *> pointers;
  for (std::string &argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = -1;
  const int error = ::posix_spawnp(&child, pointers[0], &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -1;
  int status = 0;
  constexpr std::chrono::milliseconds between_looks(10);
  pid_t ended = 0;
  try {
    while ((ended = ::waitpid(child, &status, WNOHANG)) == 0) {
      throw_if_asked(while_it_ran);
      std::this_thread::sleep_for(between_looks);
    }
  } catch (const Error &) {
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    throw;
  }
  throw_if_asked(while_it_ran); // Ctrl-C at a console ends python3, too
  return ended == child ? status : -1;
}

/// The last line of a traceback, which says what is wrong.
std::string last_line(const std::string &text)
{
  std::istringstream in(text);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (line.find_first_not_of(" \t\r") != line.npos) last = line;
  for (char &c : last)
    if (c < ' ' || c > '~') c = '?';
  constexpr std::size_t longest = 300;
  return last.substr(0, longest);
}

} // namespace

GmshContents read_by_meshio(const std::string &where, const std::string &path)
{
  const ScratchFolder folder(where);
  const std::string mesh = folder.file("mesh.msh"), out = folder.file("notes"), errors = folder.file("errors");
  const int status = run_python({"python3", "-c", std::string(abaqus_script) + meshio_script, path, mesh}, out, errors);
  constexpr int no_program = 127, no_meshio = 9, refused = 8; // of posix_spawnp()'s child, and of the script
  const bool exited = status >= 0 && WIFEXITED(status);
  RPC_REQUIRE(exited ? WEXITSTATUS(status) != no_program && WEXITSTATUS(status) != no_meshio : status >= 0,
              where << "files of this format are converted by the Python package meshio, which python3 does not find; "
                    << install);
  const std::string complaint = last_line(contents_of(errors));
  RPC_REQUIRE_CODE(!exited || WEXITSTATUS(status) != refused, ExitCode::bad_mesh, where << complaint);
  RPC_REQUIRE_CODE(exited && WEXITSTATUS(status) == 0, ExitCode::bad_mesh,
                   where << "meshio cannot convert it: " << (complaint.empty() ? "it broke down" : complaint)
                         << ". The file is damaged, or has what meshio does not read: write it anew, best as .msh or "
                            "Exodus");
  GmshContents contents = read_msh(where, contents_of(mesh));
  contents.kind = {"set", "set", "set", "set"};
  contents.node_sets = true;
  std::istringstream notes(contents_of(out));
  for (std::string note; std::getline(notes, note);)
    if (note.rfind("note: ", 0) == 0) contents.notes.push_back(note.substr(6));
  return contents;
}

} // namespace rpc::mesh
