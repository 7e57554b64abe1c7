// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/interrupt.hpp"

#include "rpc/core/error.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <thread>
#include <utility>

#ifdef HAVE_MPI
#include <mpi.h>
#endif

namespace rpc
{
namespace
{

std::atomic<int> received(0); // on this rank; signal handlers set it
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not wait for a lock");
int agreed = 0;           // on all ranks
bool left_behind = false; // work goes on
std::function<bool()> asked_of = [] { return received.load() != 0; };

struct sigaction action_of(void (*handler)(int))
{
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART; // writes and messages go on
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaddset(&action.sa_mask, signal); // the second one waits for the first
  return action;
}

/// Two threads may run it at the same time: the mask of a handler holds in its own thread alone.
void remember(const int signal)
{
  const bool is_second = received.exchange(signal) != 0;
  const struct sigaction by_default = action_of(SIG_DFL);
  for (const int other : {SIGINT, SIGTERM}) sigaction(other, &by_default, nullptr);
  if (is_second) raise(signal); // ends the process as soon as this handler returns
}

bool allows_threads(const Teuchos::Comm<int> &comm)
{
  if (comm.getSize() == 1) return true; // the other thread waits
#ifdef HAVE_MPI
  int level = 0;
  MPI_Query_thread(&level);
  return level >= MPI_THREAD_MULTIPLE;
#else
  return true;
#endif
}

} // namespace

void install_interrupt_handlers()
{
  const struct sigaction action = action_of(remember);
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

bool interrupted(const Teuchos::Comm<int> &comm)
{
  if (agreed == 0) Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, received.load(), Teuchos::outArg(agreed));
  return agreed != 0;
}

std::string interruption()
{
  if ((agreed != 0 ? agreed : received.load()) == SIGINT) return "interrupted by SIGINT";
  const bool below_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr; // of Open MPI, which passes no SIGINT on
  return std::string("interrupted by SIGTERM") + (below_mpirun ? " (mpirun sends it for Ctrl-C, too)" : "");
}

void throw_if_interrupted(const Teuchos::Comm<int> &comm, const std::string &state)
{
  if (interrupted(comm)) throw Error(ExitCode::not_converged, interruption() + " " + state);
}

void throw_if_asked(const std::string &state)
{
  if (asked_of()) throw Error(ExitCode::not_converged, interruption() + " " + state);
}

AskedOf::AskedOf(std::function<bool()> any) : before_(std::exchange(asked_of, std::move(any))) {}

AskedOf::~AskedOf()
{
  asked_of = std::move(before_);
}

bool ended_before_interrupt(const Teuchos::Comm<int> &comm, const std::function<void()> &work)
{
  if (!allows_threads(comm)) {
    work();
    return true;
  }
  constexpr std::chrono::milliseconds first_look(1), most_between_looks(200);
  const auto ended = std::make_shared<std::atomic<bool>>(false);
  std::thread thread([work, ended] {
    work();
    ended->store(true);
  });
  auto between_looks = first_look;
  for (;;) {
    const int mine = ended->load() ? 1 : 0;
    int all = 0;
    Teuchos::reduceAll(comm, Teuchos::REDUCE_MIN, mine, Teuchos::outArg(all));
    if (all == 1) break;
    if (interrupted(comm)) {
      left_behind = true;
      thread.detach();
      return false;
    }
    std::this_thread::sleep_for(between_looks);
    between_looks = std::min(2 * between_looks, most_between_looks);
  }
  thread.join();
  return true;
}

bool work_goes_on()
{
  return left_behind;
}

} // namespace rpc
