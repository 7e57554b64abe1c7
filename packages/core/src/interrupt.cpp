#include "rpc/core/interrupt.hpp"

#include "rpc/core/error.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <csignal>
#include <initializer_list>

namespace rpc
{
namespace
{

volatile std::sig_atomic_t received = 0; // on this rank
int agreed = 0;                          // on all ranks

struct sigaction action_of(void (*handler)(int))
{
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART; // writes and messages go on
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaddset(&action.sa_mask, signal); // the second one waits for the first
  return action;
}

void remember(const int signal)
{
  received = signal;
  const struct sigaction by_default = action_of(SIG_DFL);
  for (const int other : {SIGINT, SIGTERM}) sigaction(other, &by_default, nullptr);
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
  if (agreed == 0) Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, static_cast<int>(received), Teuchos::outArg(agreed));
  return agreed != 0;
}

std::string interruption()
{
  return std::string("interrupted by ") + (agreed == SIGINT ? "SIGINT" : "SIGTERM");
}

void throw_if_interrupted(const Teuchos::Comm<int> &comm, const std::string &state)
{
  if (interrupted(comm)) throw Error(ExitCode::not_converged, interruption() + " " + state);
}

} // namespace rpc
