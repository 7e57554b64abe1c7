// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/atomic_file.hpp"

#include "rpc/core/error.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace rpc::io
{
namespace
{

const std::string temporary_mark = ".tmp."; // with the process id after it
const std::string probe = ".rpc";           // by whose temporary file folders are tried
constexpr const char *remedy = "; choose a folder that can be written to with --output=DIR";
constexpr const char *remedy_in_the_way = "; remove it, or choose another folder with --output=DIR";
constexpr const char *remedy_long = "; give the deck a shorter name, or choose another folder with --output=DIR";

/// Whether the user's choice of folder is at fault rather than the machine.
bool is_bad_folder(const int error)
{
  switch (error) {
  case EACCES:
  case EPERM:
  case EROFS:
  case ENOENT:
  case ENOTDIR:
  case EISDIR:
  case EEXIST:
  case ELOOP:
  case ENAMETOOLONG:
    return true;
  default:
    return false;
  }
}

[[noreturn]] void fail(const int error, const std::string &action, const std::string &path)
{
  const bool bad_folder = is_bad_folder(error);
  const char *const help = error == EISDIR ? remedy_in_the_way : error == ENAMETOOLONG ? remedy_long : remedy;
  throw Error(bad_folder ? ExitCode::bad_input : ExitCode::internal_error,
              "output: cannot " + action + " \"" + path + "\": " + std::strerror(error) + (bad_folder ? help : ""));
}

/// What is no ordinary file, in words.
const char *kind_of(const mode_t mode)
{
  return S_ISFIFO(mode)   ? "a pipe"
         : S_ISSOCK(mode) ? "a socket"
         : S_ISCHR(mode)  ? "a device"
         : S_ISBLK(mode)  ? "a device"
                          : "of another kind";
}

std::string temporary_name(const std::string &path)
{
  return path + temporary_mark + std::to_string(::getpid());
}

} // namespace

/// Owns a file descriptor; close() reports errors, which the destructor would swallow.
class Descriptor
{
public:
  /// @param path  the name that the user gave
  Descriptor(const std::string &file, const std::string &path, const int flags)
      : path_(path), fd_(::open(file.c_str(), flags | O_CLOEXEC, 0666))
  {
    if (fd_ < 0) fail(errno, flags & O_CREAT ? "create" : "open", path_);
  }
  ~Descriptor()
  {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor &) = delete;
  Descriptor &operator=(const Descriptor &) = delete;

  void write(const std::string &text)
  {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t written = ::write(fd_, text.data() + done, text.size() - done);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(errno, "write", path_);
      done += static_cast<std::size_t>(written);
    }
  }
  void sync()
  {
    if (::fsync(fd_) != 0 && errno != EINVAL) fail(errno, "write", path_); // EINVAL: a file system without fsync
  }
  void close()
  {
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0) fail(errno, "write", path_);
  }

  off_t length() const
  {
    struct stat found = {};
    return ::fstat(fd_, &found) == 0 ? found.st_size : 0;
  }
  /// What lies beyond a length goes.
  void cut(const off_t length)
  {
    while (::ftruncate(fd_, length) != 0 && errno == EINTR) {
    }
  }

private:
  std::string path_;
  int fd_;
};

AtomicFile::AtomicFile(const std::string &path) : path_(path), temporary_(temporary_name(path))
{
  require_replaceable(path_);
  Descriptor(temporary_, path_, O_WRONLY | O_CREAT | O_TRUNC).close();
}

AtomicFile::~AtomicFile()
{
  if (!published_) ::unlink(temporary_.c_str());
}

void AtomicFile::publish()
{
  if (published_) return;
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(errno, "replace", path_);
  published_ = true;
}

void AtomicFile::sync() const
{
  Descriptor file(published_ ? path_ : temporary_, path_, O_RDWR);
  file.sync();
  file.close();
}

void AtomicFile::commit()
{
  sync();
  publish();
}

GrowingFile::GrowingFile(const std::string &path, const std::string &beginning)
{
  write_text(path, beginning);
  file_ = std::make_unique<Descriptor>(path, path, O_WRONLY | O_APPEND);
}

GrowingFile::~GrowingFile() = default;

void GrowingFile::append(const std::string &text)
{
  const off_t length = file_->length();
  try {
    file_->write(text);
  } catch (const Error &) {
    file_->cut(length);
    throw;
  }
}

void write_text(const std::string &path, const std::string &text)
{
  AtomicFile output(path);
  Descriptor file(output.temporary(), path, O_WRONLY);
  file.write(text);
  file.close();
  output.commit();
}

void require_replaceable(const std::string &path)
{
  struct stat found = {};
  if (::lstat(temporary_name(path).c_str(), &found) != 0 && errno == ENAMETOOLONG) fail(errno, "create", path);
  if (::stat(path.c_str(), &found) != 0) { // no such file, or one that creating it will tell more about
    if (errno == ENAMETOOLONG) fail(errno, "create", path);
    return;
  }
  if (S_ISDIR(found.st_mode)) fail(EISDIR, "replace", path);
  RPC_REQUIRE(S_ISREG(found.st_mode), "output: cannot replace \"" << path << "\": it is " << kind_of(found.st_mode)
                                                                  << ", not a file" << remedy_in_the_way);
  const int reason = ::access(path.c_str(), W_OK) == 0 ? 0 : errno;
  if (reason == EACCES || reason == EPERM || reason == EROFS) fail(reason, "replace", path);
}

void remove_older(const std::string &path)
{
  struct stat found = {};
  if (::lstat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return;
  if (::access(path.c_str(), W_OK) != 0) fail(errno, "remove", path); // a permission that unlink would not respect
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) fail(errno, "remove", path);
}

void remove_abandoned(const std::string &folder, const std::function<bool(const std::string &)> &is_ours)
{
  std::error_code none;
  std::vector<std::filesystem::path> abandoned;
  for (const auto &entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, none)) {
    const std::string name = entry.path().filename().string();
    const auto mark = name.rfind(temporary_mark);
    if (mark == std::string::npos) continue;
    const std::string of = name.substr(0, mark);
    if (of != probe && !is_ours(of)) continue;
    const std::string process = name.substr(mark + temporary_mark.size());
    if (!process.empty() && process.find_first_not_of("0123456789") == std::string::npos)
      abandoned.push_back(entry.path());
  }
  for (const auto &path : abandoned) std::filesystem::remove(path, none);
}

void require_writable_folder(const std::string &folder)
{
  const std::filesystem::path path = folder.empty() ? "." : folder;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  RPC_REQUIRE(!error, "output: cannot create the folder \"" << path.string() << "\": " << error.message() << remedy);
  RPC_REQUIRE(std::filesystem::is_directory(path, error),
              "output: \"" << path.string() << "\" is not a folder" << remedy);
  const std::string file = temporary_name((path / probe).string());
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  RPC_REQUIRE(fd >= 0,
              "output: cannot write to the folder \"" << path.string() << "\": " << std::strerror(errno) << remedy);
  ::close(fd);
  ::unlink(file.c_str());
}

} // namespace rpc::io
