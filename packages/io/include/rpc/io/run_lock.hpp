// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rpc::io
{

/// Keeps two runs of one name from writing into one folder: a file `.NAME.lock` there, locked as long as this lives. A process that
/// ends, however that comes, holds no lock. On a file system without locks there is none. One rank only.
class RunLock
{
public:
  /// @throws rpc::Error (bad_input) with the remedy if another process holds it
  RunLock(const std::string &folder, const std::string &name);
  ~RunLock();
  RunLock(const RunLock &) = delete;
  RunLock &operator=(const RunLock &) = delete;
  bool held() const { return fd_ >= 0; }

private:
  std::string path_;
  int fd_ = -1;
};

} // namespace rpc::io
