// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/rule_registry.hpp"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace rpc::ablation
{

double replaced(const double value, const std::string &name, const std::string &settings)
{
  std::istringstream entries(settings);
  for (std::string entry; std::getline(entries, entry, ';');) {
    if (entry.compare(0, name.size() + 1, name + "=") != 0) continue;
    const std::string number = entry.substr(name.size() + 1);
    std::size_t read = 0;
    double result = 0;
    try {
      result = std::stod(number, &read);
    } catch (const std::exception &) {
      read = 0;
    }
    if (read == 0 || read != number.size())
      throw std::invalid_argument("RPC_RULES: \"" + entry + "\" has no number after \"=\"");
    return result;
  }
  return value;
}

double registered(const double value, const char *name, const char *meaning, const char *source)
{
  const char *settings = std::getenv("RPC_RULES");
  if (settings == nullptr) return value;
  if (std::string(settings) != "list") return replaced(value, name, settings);
  std::printf("%s\t%.17g\t%s\t%s\n", name, value, meaning, source);
  return value;
}

} // namespace rpc::ablation
