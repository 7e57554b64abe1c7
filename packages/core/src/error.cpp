#include "rpc/core/error.hpp"

#include <Teuchos_CommHelpers.hpp>

namespace rpc
{

void throw_if_any(const Teuchos::Comm<int> &comm, const ExitCode code, const std::optional<std::string> &message)
{
  const int mine = message ? comm.getRank() : comm.getSize();
  int first = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MIN, mine, Teuchos::outArg(first));
  if (first == comm.getSize()) return;
  std::string text = message.value_or("");
  int length = static_cast<int>(text.size());
  Teuchos::broadcast(comm, first, Teuchos::outArg(length));
  text.resize(length);
  if (length > 0) Teuchos::broadcast(comm, first, length, text.data());
  throw Error(code, text);
}

} // namespace rpc
