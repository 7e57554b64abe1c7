// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <sys/resource.h>

namespace rpc::mesh
{

/// OpenCASCADE reads, and gmsh meshes, some damaged files for ever. Where such work takes longer than it may, SIGXCPU ends this process, which is
/// there for one file.
class TimeLimit
{
public:
  /// @param seconds  of processor time from now on, at most 1 more
  explicit TimeLimit(const double seconds)
      : is_known_(::getrlimit(RLIMIT_CPU, &before_) == 0), least_(seconds), begin_(used())
  {
    set(begin_ + least_);
  }
  ~TimeLimit()
  {
    if (is_known_) ::setrlimit(RLIMIT_CPU, &before_);
  }
  TimeLimit(const TimeLimit &) = delete;
  TimeLimit &operator=(const TimeLimit &) = delete;

  /// The work goes on: from now on it may take the same time, and `factor` times what it has taken so far.
  void renew(const double factor)
  {
    const double now = used();
    set(now + least_ + factor * (now - begin_));
  }

private:
  /// @return processor time of this process [s]
  static double used()
  {
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
  }
  void set(const double end) const
  {
    rlimit limit = before_;
    limit.rlim_cur = std::min(before_.rlim_cur, static_cast<rlim_t>(1 + end));
    if (is_known_) ::setrlimit(RLIMIT_CPU, &limit);
  }

  rlimit before_{};
  bool is_known_;
  double least_, begin_; // [s]
};

} // namespace rpc::mesh
