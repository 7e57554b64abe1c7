// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/on_root.hpp"

#include "rpc/core/interrupt.hpp"
#include "rpc/core/message.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <optional>
#include <string>

namespace rpc
{

namespace
{

/// What rank 0 tells the others, beside the code of an error.
enum Told : int { no_error = -1, are_you_asked_to_stop = -2 };

/// What work has thrown.
struct Failure {
  std::optional<std::string> message; // none: nothing
  ExitCode code;
};

Failure failure_of(const ExitCode default_code, const std::function<void()> &work)
{
  try {
    work();
  } catch (const Error &error) {
    return {error.what(), error.code()};
  } catch (const std::exception &error) {
    if (is_out_of_memory(error)) return {"out of memory", ExitCode::internal_error};
    return {error.what(), default_code};
  }
  return {std::nullopt, default_code};
}

} // namespace

void on_root(const Teuchos::Comm<int> &comm, const ExitCode default_code, const std::function<void()> &work)
{
  int shared_code = no_error;
  Failure failure{std::nullopt, default_code};
  if (comm.getRank() == 0) {
    std::optional<AskedOf> all_ranks; // of a comm of this rank alone it is for the one around it to ask
    if (comm.getSize() > 1)
      all_ranks.emplace([&comm] {
        int code = are_you_asked_to_stop;
        Teuchos::broadcast(comm, 0, Teuchos::outArg(code));
        return interrupted(comm);
      });
    failure = failure_of(default_code, work);
    if (failure.message) shared_code = static_cast<int>(failure.code);
  }
  Teuchos::broadcast(comm, 0, Teuchos::outArg(shared_code));
  while (shared_code == are_you_asked_to_stop) { // on the other ranks: rank 0 still works
    interrupted(comm);
    Teuchos::broadcast(comm, 0, Teuchos::outArg(shared_code));
  }
  if (shared_code >= 0) throw_if_any(comm, static_cast<ExitCode>(shared_code), failure.message);
}

void on_each(const Teuchos::Comm<int> &comm, const ExitCode default_code, const std::function<void()> &work)
{
  const Failure failure = failure_of(default_code, work);
  const int mine = failure.message ? comm.getRank() : comm.getSize();
  int first = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MIN, mine, Teuchos::outArg(first));
  if (first == comm.getSize()) return;
  int code = static_cast<int>(failure.code);
  Teuchos::broadcast(comm, first, Teuchos::outArg(code));
  throw Error(static_cast<ExitCode>(code), text_of_rank(comm, first, failure.message.value_or("")));
}

std::string text_of_root(const Teuchos::Comm<int> &comm, const ExitCode default_code,
                         const std::function<std::string()> &work)
{
  std::string text;
  on_root(comm, default_code, [&] { text = work(); });
  return text_of_rank(comm, 0, text);
}

std::string text_of_rank(const Teuchos::Comm<int> &comm, const int rank, std::string text)
{
  int length = static_cast<int>(text.size());
  Teuchos::broadcast(comm, rank, Teuchos::outArg(length));
  text.resize(length);
  if (length > 0) Teuchos::broadcast(comm, rank, length, text.data());
  return text;
}

} // namespace rpc
