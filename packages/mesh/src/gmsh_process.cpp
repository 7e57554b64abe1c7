// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_process.hpp"

#include "gmsh_wire.hpp"
#include "mesh_formats.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/mesh/gmsh.hpp"
#include "rpc/mesh/has_gmsh.hpp"

#ifdef RPC_GMSH_PROGRAM
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace rpc::mesh
{

#ifdef RPC_GMSH_PROGRAM
namespace
{

constexpr const char *remedy = "; install gmsh's library (on Debian: apt-get install libgmsh-dev), or rpc anew";

/// Places of the program: an install tree, which may have been moved, and the build tree.
std::string find_program()
{
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = (self.parent_path() / RPC_GMSH_PROGRAM_FROM_BIN).lexically_normal();
  return !error && fs::exists(installed, error) ? installed.string() : RPC_GMSH_PROGRAM;
}

/// The program rpc_gmsh, alive from its first start to the end of this process: it need not load gmsh for each mesh.
class Program
{
public:
  static Program &instance()
  {
    static Program program;
    return program;
  }
  Program(const Program &) = delete;
  Program &operator=(const Program &) = delete;
  ~Program() { stop(); }

  /// @return why it cannot be started; "" if it can, or runs already
  std::string start();

  /// @param[out] status  of the process that answered, as waitpid() gives it; none if the system does not tell
  /// @throws rpc::Error (not_converged) where this process is asked to stop before: then the program has ended, too
  std::string answer(const std::string &request, std::optional<int> &status);

private:
  Program() = default;
  void stop();
  void wait_for_answer();
  void close_socket();

  pid_t pid_ = -1, owner_ = -1;
  int socket_ = -1;
};

/// What a child ended with; none if the system does not tell.
std::optional<int> wait_for(const pid_t child)
{
  int status = 0;
  pid_t ended = 0;
  do ended = ::waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  return ended == child ? std::optional<int>(status) : std::nullopt;
}

void Program::close_socket()
{
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

void Program::stop()
{
  close_socket();
  if (pid_ > 0 && owner_ == ::getpid()) { // a fork of this process leaves the program to it
    ::kill(pid_, SIGKILL);
    wait_for(pid_);
  }
  pid_ = -1;
}

std::string Program::start()
{
  int status = 0;
  if (pid_ > 0 && owner_ == ::getpid() && ::waitpid(pid_, &status, WNOHANG) == 0) return "";
  if (owner_ == ::getpid()) pid_ = -1; // it has ended, and its number may be another's by now
  stop();
  int ends[2]; // no other child of this process inherits them
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
    return std::string("there is no socket: ") + std::strerror(errno);
  std::string program = find_program();
  std::array<char *, 2> arguments{program.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], gmsh_socket);
  for (const int console : {0, 1, 2}) posix_spawn_file_actions_addopen(&actions, console, "/dev/null", O_RDWR, 0);
  const int error = posix_spawn(&pid_, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  socket_ = ends[0];
  owner_ = ::getpid();
  if (error == 0) return "";
  pid_ = -1;
  stop();
  return "\"" + program + "\": " + std::strerror(error);
}

/// Until something comes, or the other side is closed.
void Program::wait_for_answer()
{
  constexpr int between_looks = 100; // [ms]
  pollfd other{socket_, POLLIN, 0};
  while (::poll(&other, 1, between_looks) <= 0) throw_if_asked("while gmsh made a mesh; no results are written");
}

std::string Program::answer(const std::string &request, std::optional<int> &status)
{
  std::string bytes;
  int number = 0;
  try {
    if (send_bytes(socket_, request) && send_end(socket_, 0)) {
      wait_for_answer();
      if (receive(socket_, bytes, number)) {
        status = number;
        return bytes;
      }
    }
  } catch (...) { // out of memory, or asked to stop: what is still to come would be taken for the next answer
    stop();
    throw;
  }
  status = wait_for(pid_);
  pid_ = -1;
  close_socket();
  return bytes;
}

} // namespace

bool has_gmsh()
{
  return true;
}

void start_gmsh_early()
{
  Program::instance().start();
}

GmshContents run_gmsh(const std::string &where, const GmshRequest &request)
{
  Program &program = Program::instance();
  const std::string obstacle = program.start();
  RPC_REQUIRE(obstacle.empty(), where << "gmsh cannot be started: " << obstacle << remedy);
  std::optional<int> status;
  const std::string bytes = program.answer(packed(request), status);
  constexpr int no_library = 127; // of the system's loader
  RPC_REQUIRE(!status || !WIFEXITED(*status) || WEXITSTATUS(*status) != no_library,
              where << "gmsh cannot be loaded" << remedy);
  RPC_REQUIRE_CODE(!status || !WIFSIGNALED(*status) || WTERMSIG(*status) != SIGXCPU, ExitCode::bad_mesh,
                   where << "gmsh does not come to an end with it: the file is damaged. Write it anew, best as STEP");
  std::string end = "ended without a mesh";
  if (status && WIFSIGNALED(*status)) end = std::string("broke down (") + strsignal(WTERMSIG(*status)) + ")";
  const MeshFormat format = format_of(request.file);
  RPC_REQUIRE_CODE(!bytes.empty() && (!status || *status == 0), ExitCode::bad_mesh,
                   where << "gmsh " << end
                         << (format == MeshFormat::by_gmsh
                                 ? ", as it does on damaged files. Write it anew, best as .msh or Exodus"
                             : format == MeshFormat::shapes
                                 ? ", as it does on damaged files, or when memory runs out or sizes are absurd. Write "
                                   "it anew, best as STEP"
                                 : ", as it does when memory runs out or when sizes or numbers are absurd"));
  return unpacked_contents(bytes);
}
#else
bool has_gmsh()
{
  return false;
}

void start_gmsh_early() {}

GmshContents run_gmsh(const std::string &where, const GmshRequest &)
{
  throw Error(ExitCode::bad_input, where +
                                       "this rpc was built without gmsh, which meshes a .geo; build it with gmsh (on "
                                       "Debian libgmsh-dev), or run gmsh -2, in space gmsh -3, and give the .msh");
}
#endif

} // namespace rpc::mesh
