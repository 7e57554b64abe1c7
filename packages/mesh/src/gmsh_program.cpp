// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_mesher.hpp"
#include "gmsh_wire.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <malloc.h>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace rpc::mesh
{
namespace
{

/// Closes the files and pipes of rpc and its MPI: an end of a pipe kept open here would hide from others that rpc has ended.
void close_inherited()
{
  namespace fs = std::filesystem;
  std::vector<int> open;
  std::error_code error;
  for (fs::directory_iterator it("/proc/self/fd", error), end; !error && it != end; it.increment(error))
    open.push_back(std::atoi(it->path().filename().c_str()));
  for (const int descriptor : open)
    if (descriptor > STDERR_FILENO && descriptor != gmsh_socket) ::close(descriptor);
}

/// In a process of its own: it starts with a fresh gmsh, and its memory goes with it.
[[noreturn]] void answer(const std::string &bytes, const pid_t parent)
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1); // it has ended before
  bool sent = false;
  try {
    const GmshRequest request = unpacked_request(bytes);
    std::error_code ignored; // a folder that is gone: relative paths fail by themselves
    std::filesystem::current_path(request.folder, ignored);
    sent = ::getppid() == parent && send_bytes(gmsh_socket, packed(made_mesh(request)));
  } catch (const std::exception &) { // out of memory: no answer says enough
  }
  ::_exit(sent ? 0 : 1);
}

/// @return how waitpid() says that it ended
int status_of(const pid_t child)
{
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return 0;
  return status;
}

/// gmsh allocates by the million and ends without giving back: memory comes in large pieces and stays.
void set_up_memory()
{
  mallopt(M_TOP_PAD, 1 << 26);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
}

void serve()
{
  const pid_t self = ::getpid();
  for (;;) {
    std::string bytes;
    int number = 0;
    if (!receive(gmsh_socket, bytes, number)) return;
    const pid_t child = ::fork();
    if (child == 0) answer(bytes, self);
    if (child < 0 || !send_end(gmsh_socket, status_of(child))) return;
  }
}

} // namespace
} // namespace rpc::mesh

/// rpc_gmsh: makes the meshes that rpc asks for through gmsh_socket, until rpc ends. A program of its own, because
/// gmsh can break down, leave by exit() in the middle of a file and change the process for good; and its libraries take
/// long to load.
int main()
{
  prctl(PR_SET_PDEATHSIG, SIGKILL); // not to outlive an rpc that is killed
  std::signal(SIGCHLD, SIG_DFL);    // ignored by whoever started rpc, it would hide how children end
  for (const int to_all :
       {SIGINT, SIGTERM}) // of a console, a batch system, timeout: rpc answers them, and ends this program
    std::signal(to_all, SIG_IGN);
  rpc::mesh::close_inherited();
  rpc::mesh::set_up_memory();
  rpc::mesh::start_gmsh();
  rpc::mesh::serve();
  ::_exit(0);
}
