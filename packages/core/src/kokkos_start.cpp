// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/kokkos_start.hpp"

#include <csetjmp>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <pthread.h>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

namespace rpc
{
namespace
{

/// The standard error, kept in a file while this lives; where no file can be made nothing is kept.
class KeptErrors
{
public:
  KeptErrors() : file_(std::tmpfile())
  {
    if (!file_) return;
    std::fflush(stderr);
    screen_ = dup(STDERR_FILENO);
    dup2(fileno(file_), STDERR_FILENO);
  }
  ~KeptErrors()
  {
    if (!file_) return;
    give_back();
    std::fclose(file_);
  }
  KeptErrors(const KeptErrors &) = delete;
  KeptErrors &operator=(const KeptErrors &) = delete;

  /// What was written; from now on it goes to the screen again.
  std::string text()
  {
    if (!file_) return "";
    give_back();
    std::rewind(file_);
    std::string all;
    for (int c = std::fgetc(file_); c != EOF; c = std::fgetc(file_)) all += static_cast<char>(c);
    return all;
  }

private:
  void give_back()
  {
    if (screen_ < 0) return;
    std::fflush(stderr);
    dup2(screen_, STDERR_FILENO);
    close(screen_);
    screen_ = -1;
  }

  std::FILE *file_;
  int screen_ = -1;
};

sigjmp_buf before_abort;
pthread_t starting_thread;

/// abort() goes on, and ends the process, where another thread has called it.
void leave_abort(int)
{
  if (pthread_equal(pthread_self(), starting_thread) != 0) siglongjmp(before_abort, 1);
}

/// Leads abort() back to before_abort while this lives.
class AbortCaught
{
public:
  AbortCaught()
  {
    starting_thread = pthread_self();
    struct sigaction leaving = {};
    leaving.sa_handler = leave_abort;
    sigemptyset(&leaving.sa_mask);
    sigaction(SIGABRT, &leaving, &before_);
  }
  ~AbortCaught() { sigaction(SIGABRT, &before_, nullptr); }
  AbortCaught(const AbortCaught &) = delete;
  AbortCaught &operator=(const AbortCaught &) = delete;

private:
  struct sigaction before_ = {};
};

/// Of "Error: <reason> Raised by Kokkos::initialize().", and what may follow, the reason.
std::string reason_in(const std::string &text)
{
  std::string reason = text;
  if (const auto end = reason.find(" Raised by Kokkos"); end != std::string::npos) reason.erase(end);
  if (const auto start = reason.rfind("Error: "); start != std::string::npos) reason.erase(0, start + 7);
  return reason.empty() ? "it gave no reason" : reason;
}

} // namespace

std::string kokkos_spelling(const std::string &option)
{
#if __has_include(<impl/Kokkos_InitializationSettings.hpp>) // which came with the new names
  const std::string known = "--kokkos-num-threads", other = "--kokkos-threads";
#else
  const std::string known = "--kokkos-threads", other = "--kokkos-num-threads";
#endif
  const auto end = option.find('=');
  if (option.substr(0, end) != other) return option;
  return known + (end == std::string::npos ? "" : option.substr(end));
}

void start_or_throw(const std::function<void()> &start)
{
  KeptErrors errors;
  {
    const AbortCaught caught;
    // The second time abort() has been called; what Kokkos had made until then stays behind.
    if (sigsetjmp(before_abort, 1) != 0) throw std::runtime_error(reason_in(errors.text()));
    start();
  }
  std::istringstream lines(errors.text());
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("Warning: command line argument", 0) != 0) std::cerr << line << '\n';
}

} // namespace rpc
