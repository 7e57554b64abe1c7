// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "expect_error.hpp"
#include "rpc/core/tpetra.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <optional>
#include <stdlib.h>
#include <string>
#include <sys/resource.h>

/// What tests of files share.
namespace rpc::test
{

/// A folder that goes away with its owner; rank 0 makes and removes it, all ranks know its name. Collective.
class Scratch
{
public:
  explicit Scratch(const Comm &comm) : comm_(comm), folder_("/tmp/rpc_io_test_XXXXXX")
  {
    if (comm_.getRank() == 0 && !::mkdtemp(folder_.data())) ADD_FAILURE() << "cannot create " << folder_;
    Teuchos::broadcast(comm_, 0, static_cast<int>(folder_.size()), folder_.data());
  }
  ~Scratch()
  {
    comm_.barrier();
    if (comm_.getRank() == 0) std::filesystem::remove_all(folder_);
  }
  Scratch(const Scratch &) = delete;
  Scratch &operator=(const Scratch &) = delete;

  const std::string &folder() const { return folder_; }
  std::string path(const std::string &name) const { return folder_ + "/" + name; }

  std::string write(const std::string &name, const std::string &text) const
  {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  int num_files() const
  {
    const std::filesystem::directory_iterator entries(folder_);
    return static_cast<int>(std::distance(begin(entries), end(entries)));
  }

private:
  const Comm &comm_;
  std::string folder_;
};

inline std::string text_of(const std::string &path)
{
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// While it lives no file may grow beyond `bytes`: writes fail as on a full disk.
class FileSizeLimit
{
public:
  explicit FileSizeLimit(const rlim_t bytes)
  {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &old_);
    rlimit limit = old_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit()
  {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, SIG_DFL);
  }

private:
  rlimit old_{};
};

} // namespace rpc::test
