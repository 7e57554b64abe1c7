#include "rpc/core/on_root.hpp"

#include "rpc/core/message.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <optional>
#include <string>

namespace rpc
{

void on_root(const Teuchos::Comm<int> &comm, const ExitCode default_code, const std::function<void()> &work)
{
  std::optional<std::string> message;
  ExitCode code = default_code;
  if (comm.getRank() == 0) {
    try {
      work();
    } catch (const Error &error) {
      message = error.what();
      code = error.code();
    } catch (const std::exception &error) {
      const bool full = is_out_of_memory(error);
      message = full ? "out of memory" : error.what();
      if (full) code = ExitCode::internal_error;
    }
  }
  int shared_code = message ? static_cast<int>(code) : -1; // -1: no error
  Teuchos::broadcast(comm, 0, Teuchos::outArg(shared_code));
  if (shared_code >= 0) throw_if_any(comm, static_cast<ExitCode>(shared_code), message);
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
