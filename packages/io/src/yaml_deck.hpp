// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

namespace rpc::io
{

/// Lines of the names in a YAML deck by their paths "Contact->Side", the name of the root left out.
///
/// Reads no more of YAML than lists within lists, by indentation or in braces.
/// @param path  of the file, for messages
/// @throws rpc::Error (bad_input) with path, line and what to write, on a tab, an indentation that fits no list, a missing colon, an
///         open bracket, a decimal comma within braces, and a name that is given twice
std::map<std::string, int> read_yaml_lines(const std::string &path, const std::string &text);

} // namespace rpc::io
