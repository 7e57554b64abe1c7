// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/run_lock.hpp"

#include "rpc/core/error.hpp"

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

namespace rpc::io
{
namespace
{

/// Whether a path is still the file that was opened: its owner may have removed it before it was locked here.
bool is_at(const std::string &path, const int fd)
{
  struct stat opened = {}, named = {};
  return ::fstat(fd, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

/// A lock for writing on the whole file, which belongs to the process.
struct flock whole_file()
{
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

/// The process that holds the lock, in words.
std::string owner(const int fd)
{
  struct flock lock = whole_file();
  return ::fcntl(fd, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK && lock.l_pid > 0
             ? " (process " + std::to_string(lock.l_pid) + ")"
             : "";
}

} // namespace

RunLock::RunLock(const std::string &folder, const std::string &name)
    : path_((std::filesystem::path(folder) / ("." + name + ".lock")).string())
{
  for (;;) {
    fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (fd_ < 0) return; // whether files can be made there is asked elsewhere
    struct flock lock = whole_file();
    if (::fcntl(fd_, F_SETLK, &lock) != 0) {
      const bool taken = errno == EACCES || errno == EAGAIN;
      const std::string who = taken ? owner(fd_) : "";
      ::close(fd_);
      fd_ = -1;
      RPC_REQUIRE(!taken, "output: another run"
                              << who << " writes results of \"" << name << "\" into the folder \"" << folder
                              << "\". Wait until it has ended, or choose another folder with --output=DIR.");
      return; // a file system without locks
    }
    if (is_at(path_, fd_)) break;
    ::close(fd_);
  }
}

RunLock::~RunLock()
{
  if (fd_ < 0) return;
  ::unlink(path_.c_str());
  ::close(fd_);
}

} // namespace rpc::io
