// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/child_process.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace rpc
{
namespace
{

/// @return whether the other side read all of it
bool write_all(const int pipe, const std::string &bytes)
{
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(pipe, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) return false;
    done += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  return true;
}

std::string read_all(const int pipe)
{
  std::string bytes, piece(std::size_t(1) << 16, '\0');
  for (;;) {
    const ssize_t count = ::read(pipe, piece.data(), piece.size());
    if (count > 0) bytes.append(piece, 0, static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EINTR)) return bytes;
  }
}

/// The answer: a byte that is the code of an error, or `converged`, and its text or what work returns.
[[noreturn]] void answer_and_end(const int pipe, const std::function<std::string()> &work)
{
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int console : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, console);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM})
    std::signal(signal, SIG_DFL); // MPI's would write, and a request to stop is the parent's to answer
  std::signal(SIGPIPE, SIG_IGN);  // where the parent has died, what is written fails
  bool written = false;
  try {
    std::string answer;
    try {
      answer = static_cast<char>(ExitCode::converged) + work();
    } catch (const Error &error) {
      answer = static_cast<char>(error.code()) + std::string(error.what());
    }
    written = write_all(pipe, answer);
  } catch (const std::exception &) { // out of memory
  }
  ::_exit(written ? 0 : 1);
}

} // namespace

std::optional<std::string> in_child_process(const std::function<std::string()> &work)
{
  int ends[2];
  RPC_REQUIRE_CODE(::pipe2(ends, O_CLOEXEC) == 0, ExitCode::internal_error,
                   "no pipe can be opened: " << std::strerror(errno));
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    answer_and_end(ends[1], work);
  }
  const int cause = errno;
  ::close(ends[1]);
  const std::string answer = child > 0 ? read_all(ends[0]) : "";
  ::close(ends[0]);
  int status = 0;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  RPC_REQUIRE_CODE(child > 0, ExitCode::internal_error, "no child process can be started: " << std::strerror(cause));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty()) {
    throw_if_asked("while a file was read; no results are written"); // Ctrl-C at a console ends the child, too
    return std::nullopt;
  }
  const auto code = static_cast<ExitCode>(answer[0]);
  if (code != ExitCode::converged) throw Error(code, answer.substr(1));
  return answer.substr(1);
}

} // namespace rpc
