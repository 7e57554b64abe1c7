// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

namespace rpc::test
{

/// A file in a folder of its own, both removed at the end. Each rank has its own.
class ScratchFile
{
public:
  ScratchFile(const std::string &name, const std::string &text)
  {
    std::string folder = (std::filesystem::temp_directory_path() / "rpc_mesh_XXXXXX").string();
    if (!::mkdtemp(folder.data())) ADD_FAILURE() << "cannot create " << folder;
    folder_ = folder;
    path_ = (folder_ / name).string();
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~ScratchFile()
  {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ScratchFile(const ScratchFile &) = delete;
  ScratchFile &operator=(const ScratchFile &) = delete;

  const std::string &path() const { return path_; }

private:
  std::filesystem::path folder_;
  std::string path_;
};

} // namespace rpc::test
