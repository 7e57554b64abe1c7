// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <malloc.h>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

namespace rpc
{
namespace
{

constexpr double unknown = std::numeric_limits<double>::infinity();

double of_machine()
{
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? static_cast<double>(pages) * static_cast<double>(page) : unknown;
}

/// What a file of one number says; `otherwise` if there is none.
double number_in(const std::string &path, const double otherwise)
{
  std::ifstream file(path);
  double number = 0;
  return file >> number ? number : otherwise;
}

/// Control groups of versions 2 and 1; "max" is no number.
double of_container()
{
  double least = unknown;
  for (const char *const path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (const double bytes = number_in(path, 0); bytes > 0) least = std::min(least, bytes);
  return least;
}

double of_shell()
{
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unknown;
  return static_cast<double>(limit.rlim_cur);
}

/// What a file of lines "key number" says; `otherwise` if it has no such key.
double number_of(const std::string &key, const std::string &path, const double otherwise)
{
  std::ifstream file(path);
  std::string name, line;
  for (double number = 0; file >> name && std::getline(file, line);)
    if (name == key && std::istringstream(line) >> number) return number;
  return otherwise;
}

/// "MemAvailable:  24000000 kB": what the system could give without swapping.
double available()
{
  return 1024 * number_of("MemAvailable:", "/proc/meminfo", unknown);
}

/// The copies of files that the system would drop first are not in use.
double left_in_container()
{
  const std::string folder = "/sys/fs/cgroup/", older = folder + "memory/";
  const double used = number_in(folder + "memory.current", number_in(older + "memory.usage_in_bytes", 0));
  const double files =
      number_of("inactive_file", folder + "memory.stat", number_of("total_inactive_file", older + "memory.stat", 0));
  return std::max(of_container() - std::max(used - files, 0.), 0.);
}

double left_in_shell()
{
  const double pages = number_in("/proc/self/statm", 0);
  return std::max(of_shell() - pages * static_cast<double>(sysconf(_SC_PAGESIZE)), 0.);
}

} // namespace

double memory_limit()
{
  return std::min({of_machine(), of_container(), of_shell()});
}

double memory_left()
{
  return std::min({available(), left_in_container(), left_in_shell()});
}

void return_freed_memory()
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

} // namespace rpc
