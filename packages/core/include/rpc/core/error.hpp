// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_Comm.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

namespace rpc
{

/// What a run of the program ends with.
enum class ExitCode {
  converged = 0,
  internal_error = 1,
  bad_input = 2,
  bad_mesh = 3,
  not_converged = 4,
  no_solution = 5
};

/// The one exception of this project: a message for the user and the exit code that it leads to.
///
/// The message says where, which, the rule with its unit, the value, and the remedy when there is one. Thrown on all
/// ranks or before any collective, never on some of the ranks.
class Error : public std::runtime_error
{
public:
  Error(ExitCode code, const std::string &message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const noexcept { return code_; }

private:
  ExitCode code_;
};

/// Throws on every rank, with the lowest rank's message, if any rank brings one; collective on comm.
void throw_if_any(const Teuchos::Comm<int> &comm, ExitCode code, const std::optional<std::string> &message);

/// A library's error in one line: without its source files, counters, conditions, echoes of the input, parser states
/// and lists of everything that would be valid.
std::string one_line(const std::string &what);

} // namespace rpc

/// Always-on O(1) host check of a user's input: RPC_REQUIRE(x > 0, "\"Material->x\" must be > 0 [Pa], got " <<
/// x).
#define RPC_REQUIRE(condition, stream) RPC_REQUIRE_CODE(condition, ::rpc::ExitCode::bad_input, stream)

/// The same with another exit code.
#define RPC_REQUIRE_CODE(condition, exit_code, stream)                                                                 \
  do {                                                                                                                 \
    if (!(condition)) {                                                                                                \
      std::ostringstream rpc_message;                                                                                  \
      rpc_message << stream;                                                                                           \
      throw ::rpc::Error(exit_code, rpc_message.str());                                                                \
    }                                                                                                                  \
  } while (false)
