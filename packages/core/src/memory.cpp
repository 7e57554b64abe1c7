#include "rpc/core/memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
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

/// Control groups of versions 2 and 1; "max" is no number.
double of_container()
{
  double least = unknown;
  for (const char *const path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::ifstream file(path);
    double bytes = 0;
    if (file >> bytes && bytes > 0) least = std::min(least, bytes);
  }
  return least;
}

double of_shell()
{
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unknown;
  return static_cast<double>(limit.rlim_cur);
}

} // namespace

double memory_limit()
{
  return std::min({of_machine(), of_container(), of_shell()});
}

} // namespace rpc
