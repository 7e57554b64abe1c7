// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_Comm.hpp>
#include <functional>
#include <string>

/// Interrupts end a run at its next safe point; results found so far are written.
namespace rpc
{

/// The first SIGINT or SIGTERM from here on only asks the run to stop; a second one has the default action, which ends
/// the process at once. What was ignored before stays ignored.
void install_interrupt_handlers();

/// Whether any rank has been asked to stop: the same on every rank, and true forever once it is; collective on comm.
bool interrupted(const Teuchos::Comm<int> &comm);

/// "interrupted by SIGTERM", after interrupted() has been true or throw_if_asked() has thrown: what this process has got. Below Open MPI's mpirun that may have been
/// SIGINT, and is said.
std::string interruption();

/// @throws rpc::Error (not_converged) on every rank if any of them has been asked to stop; collective on comm
/// @param state  how far the run is, for the message: "before ..., no results are written"
void throw_if_interrupted(const Teuchos::Comm<int> &comm, const std::string &state);

/// The same for work of one rank that waits for another process: within on_root() of all ranks of its comm, else of this rank alone.
void throw_if_asked(const std::string &state);

/// While it lives, `any` tells throw_if_asked() whether a rank has been asked to stop.
class AskedOf
{
public:
  explicit AskedOf(std::function<bool()> any);
  ~AskedOf();
  AskedOf(const AskedOf &) = delete;
  AskedOf &operator=(const AskedOf &) = delete;

private:
  std::function<bool()> before_;
};

/// Does work that cannot look for a request to stop itself, such as a library's, and looks meanwhile: the work has a thread of its own.
/// On several ranks that takes an MPI that allows calls from several threads; else the request is seen after the work. Collective on comm.
/// @param work  owns all that it uses, and throws nothing; it may use MPI, but for comm
/// @return whether the work has ended; if not, the run has been asked to stop, and the work goes on by itself
bool ended_before_interrupt(const Teuchos::Comm<int> &comm, const std::function<void()> &work);

/// Whether such work goes on. Then the process has to end without MPI_Finalize and destructors of static objects, by std::_Exit.
bool work_goes_on();

} // namespace rpc
