// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rpc::io
{

/// Without blanks at both ends.
std::string trimmed(const std::string &text);

/// "a, b, c"
std::string list_of(const std::vector<std::string> &names);

/// Whether the text is of the Teuchos type; types other than numbers and bool are left to Teuchos.
bool reads_as(const std::string &type, const std::string &text);

/// Whether "{...}" is an array of that type.
bool array_reads_as(const std::string &type, const std::string &text);

/// Whether the text is inf or nan.
bool is_infinite(const std::string &text);

/// @throws rpc::Error (bad_input): "deck: "path", line n: reason"
[[noreturn]] void refuse_line(const std::string &path, int line, const std::string &reason);

/// What to do with a text of another program, which it looks like an input of; empty where it looks like none.
std::string other_format(const std::string &text);
/// The same of a text that is no deck in XML, never empty.
std::string format_remedy(const std::string &text);

} // namespace rpc::io
