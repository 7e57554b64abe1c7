// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"

#include "rpc/core/on_root.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <cctype>
#include <regex>
#include <vector>

namespace rpc
{

void throw_if_any(const Teuchos::Comm<int> &comm, const ExitCode code, const std::optional<std::string> &message)
{
  const int mine = message ? comm.getRank() : comm.getSize();
  int first = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MIN, mine, Teuchos::outArg(first));
  if (first == comm.getSize()) return;
  throw Error(code, text_of_rank(comm, first, message.value_or("")));
}

std::string one_line(const std::string &what)
{
  static const std::regex noise(R"(^(Throw (number|test)|Traceback|Lists? of)|^error: |^-+$|^\s*$)");
  static const std::regex clutter(
      R"(^\S+\.([ch]pp|[CH]):\d+:\s*(Error - )?|^XML parse error at line \d+: |^Error[,!] +|^in the parameter \(sub\)list "ANONYMOUS"$)");
  static const std::regex pointer(R"(\s*\^)");
  std::vector<std::string> lines;
  std::istringstream in(what);
  for (std::string line; std::getline(in, line);) lines.push_back(line);

  std::string text;
  bool listing = false;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    if (lines[n].rfind("Lexer text", 0) == 0) break; // nothing but the parser's state from here on
    if (lines[n].rfind("The valid parameters and types are:", 0) == 0) listing = true;
    if (listing) {
      listing = lines[n].rfind("  }", 0) != 0;
      continue;
    }
    const bool echo = n + 1 < lines.size() && n > 0 && std::regex_match(lines[n + 1], pointer);
    if (echo) ++n;
    if (echo || std::regex_search(lines[n], noise)) continue;
    const std::string rest = std::regex_replace(lines[n], clutter, "");
    if (!rest.empty()) text += (text.empty() ? "" : " ") + rest;
  }
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

} // namespace rpc
