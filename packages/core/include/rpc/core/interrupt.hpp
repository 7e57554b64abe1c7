#pragma once

#include <Teuchos_Comm.hpp>
#include <string>

/// Interrupts end a run at its next safe point; results found so far are written.
namespace rpc
{

/// The first SIGINT or SIGTERM from here on only asks the run to stop; a second one has the default action, which ends
/// the process at once. What was ignored before stays ignored.
void install_interrupt_handlers();

/// Whether any rank has been asked to stop: the same on every rank, and true forever once it is; collective on comm.
bool interrupted(const Teuchos::Comm<int> &comm);

/// "interrupted by SIGTERM", after interrupted() has been true.
std::string interruption();

/// @throws rpc::Error (not_converged) on every rank if any of them has been asked to stop; collective on comm
/// @param state  how far the run is, for the message: "before ..., no results are written"
void throw_if_interrupted(const Teuchos::Comm<int> &comm, const std::string &state);

} // namespace rpc
