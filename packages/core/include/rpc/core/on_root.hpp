// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"

#include <functional>
#include <string>

namespace rpc
{

/// Runs `work` on rank 0 only; collective on comm.
/// @throws rpc::Error on every rank if work throws: with its own code if it is an rpc::Error, internal_error if memory
/// ran out, else `default_code`
void on_root(const Teuchos::Comm<int> &comm, ExitCode default_code, const std::function<void()> &work);

/// Runs `work` on every rank, where ranks meet with different things, such as their own files; collective on comm. `work` itself is not.
/// @throws rpc::Error on every rank if work throws on any: what the lowest of these ranks met with, as on_root() does
void on_each(const Teuchos::Comm<int> &comm, ExitCode default_code, const std::function<void()> &work);

/// What `work` returns on rank 0, where alone it runs, on every rank; collective on comm. For what each rank would find
/// differently, such as files on its own disk.
/// @throws rpc::Error on every rank, as on_root() does
std::string text_of_root(const Teuchos::Comm<int> &comm, ExitCode default_code,
                         const std::function<std::string()> &work);

/// The text that one rank has, on every rank; collective on comm.
/// @param text  of other ranks: any
std::string text_of_rank(const Teuchos::Comm<int> &comm, int rank, std::string text);

} // namespace rpc
