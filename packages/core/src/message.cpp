// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/message.hpp"

#include <cctype>
#include <new>

namespace rpc
{
namespace
{

constexpr std::size_t longest_message = 900, longest_end = 300; // bytes

/// The nearest place at or before `at` where no UTF-8 character is cut.
std::size_t character_start(const std::string &text, std::size_t at)
{
  for (int steps = 0; steps < 3 && at > 0 && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80; ++steps) --at;
  return at;
}

} // namespace

std::string for_terminal(std::string message)
{
  for (char &c : message) {
    if (c == '\t') c = ' ';
    if (std::iscntrl(static_cast<unsigned char>(c))) c = '?';
  }
  if (message.size() <= longest_message) return message;
  const std::string gap = " [...] ";
  const std::size_t begin = character_start(message, longest_message - longest_end - gap.size());
  return message.substr(0, begin) + gap + message.substr(character_start(message, message.size() - longest_end + 3));
}

bool is_out_of_memory(const std::exception &error)
{
  // Kokkos 3.4: "Kokkos failed to allocate ...", 4.5: "Kokkos ERROR: ... failed to allocate ..."
  const std::string text = error.what();
  return dynamic_cast<const std::bad_alloc *>(&error) ||
         (text.rfind("Kokkos", 0) == 0 && text.find("failed to allocate") != std::string::npos);
}

void pass_on_out_of_memory(const std::exception &error)
{
  if (is_out_of_memory(error)) throw;
}

} // namespace rpc
