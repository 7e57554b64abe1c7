#pragma once

#include "rpc/core/error.hpp"

#include <functional>

namespace rpc
{

/// Runs `work` on rank 0 only; collective on comm.
/// @throws rpc::Error on every rank if work throws: with its own code if it is an rpc::Error, internal_error if memory
/// ran out, else `default_code`
void on_root(const Teuchos::Comm<int> &comm, ExitCode default_code, const std::function<void()> &work);

} // namespace rpc
