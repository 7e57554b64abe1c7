#pragma once

#include "rpc/core/error.hpp"

#include <functional>

namespace rpc
{

/// Runs `work` on rank 0 only; collective on comm.
/// @throws rpc::Error on every rank if work throws: with the code of its rpc::Error, with `default_code` for any other
/// exception
void on_root(const Teuchos::Comm<int> &comm, ExitCode default_code, const std::function<void()> &work);

} // namespace rpc
