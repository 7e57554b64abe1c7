#include "gmsh_process.hpp"

#include "gmsh_wire.hpp"
#include "rpc/core/error.hpp"

#ifdef RPC_GMSH_PROGRAM
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <optional>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace rpc::mesh
{

#ifdef RPC_GMSH_PROGRAM
namespace
{

constexpr const char *remedy = "; install gmsh's library (on Debian libgmsh4.8), or rpc anew";

/// Where the program may lie: in an install tree, wherever that was moved, or where it was built.
std::string find_program()
{
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = (self.parent_path() / RPC_GMSH_PROGRAM_FROM_BIN).lexically_normal();
  return !error && fs::exists(installed, error) ? installed.string() : RPC_GMSH_PROGRAM;
}

/// A pipe that no other child of this process inherits.
class Pipe
{
public:
  explicit Pipe(const std::string &where)
  {
    RPC_REQUIRE_CODE(::pipe2(ends_, O_CLOEXEC) == 0, ExitCode::internal_error,
                     where << "there is no pipe to gmsh: " << std::strerror(errno));
  }
  ~Pipe()
  {
    close(0);
    close(1);
  }
  Pipe(const Pipe &) = delete;
  Pipe &operator=(const Pipe &) = delete;

  int write_end() const { return ends_[1]; }

  /// All that comes until the other side closes.
  std::string read_all()
  {
    close(1);
    std::string text;
    std::array<char, 1 << 16> buffer;
    for (;;) {
      const ssize_t count = ::read(ends_[0], buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return text;
      text.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }

private:
  void close(const int end)
  {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }
  int ends_[2] = {-1, -1};
};

/// Starts the program, mute, with the pipe as its gmsh_output.
pid_t start(const std::string &where, const GmshRequest &request, const Pipe &pipe)
{
  std::ostringstream factor;
  factor << std::setprecision(std::numeric_limits<double>::max_digits10) << request.size_factor;
  std::string program = find_program(), file = request.file, size = factor.str(), order = std::to_string(request.order);
  std::array<char *, 5> arguments{program.data(), file.data(), size.data(), order.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe.write_end(), gmsh_output);
  for (const int console : {0, 1, 2}) posix_spawn_file_actions_addopen(&actions, console, "/dev/null", O_RDWR, 0);
  pid_t child = -1;
  const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  RPC_REQUIRE(error == 0, where << "gmsh cannot be started: \"" << program << "\": " << std::strerror(error) << remedy);
  return child;
}

/// What a child ended with; none if the system does not tell.
std::optional<int> wait_for(const pid_t child)
{
  int status = 0;
  pid_t ended = 0;
  do ended = ::waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  return ended == child ? std::optional<int>(status) : std::nullopt;
}

} // namespace

GmshContents run_gmsh(const std::string &where, const GmshRequest &request)
{
  Pipe pipe(where);
  const pid_t child = start(where, request, pipe);
  const std::string bytes = pipe.read_all();
  const std::optional<int> status = wait_for(child);
  constexpr int no_library = 127; // of the system's loader
  RPC_REQUIRE(!status || !WIFEXITED(*status) || WEXITSTATUS(*status) != no_library,
              where << "gmsh cannot be loaded" << remedy);
  std::string end = "ended without a mesh";
  if (status && WIFSIGNALED(*status)) end = std::string("broke down (") + strsignal(WTERMSIG(*status)) + ")";
  RPC_REQUIRE_CODE(!bytes.empty() && (!status || *status == 0), ExitCode::bad_mesh,
                   where << "gmsh " << end << ", as it does when memory runs out or when sizes or numbers are absurd");
  return unpacked(bytes);
}
#else
GmshContents run_gmsh(const std::string &where, const GmshRequest &)
{
  throw Error(ExitCode::bad_input, where +
                                       "this rpc was built without gmsh, which meshes a .geo; build it with gmsh (on "
                                       "Debian libgmsh-dev), or run gmsh -2 and give the .msh");
}
#endif

} // namespace rpc::mesh
