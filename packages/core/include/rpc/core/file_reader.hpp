// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <functional>
#include <string>

namespace rpc
{

/// The bytes of a file that a deck's parameter names, on every rank; collective, unless it says otherwise.
/// @param parameter  its path in the deck, for messages
/// @throws rpc::Error (bad_input) on every rank where it cannot be read
using FileReader = std::function<std::string(const std::string &name, const std::string &parameter)>;

/// The bytes of a file; on this rank alone.
std::string bytes_of_file(const std::string &name, const std::string &parameter);

/// Reads files on rank 0 and gives them to all others.
/// @param folder  where names are looked for that are no whole paths, before the current folder
/// @param comm    which must outlive the reader
FileReader file_reader_of_root(const std::string &folder, const Comm &comm);

} // namespace rpc
