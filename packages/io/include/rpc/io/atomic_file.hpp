// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace rpc::io
{

/// An output file that appears whole or not at all: written under a temporary name in the same folder, then renamed.
///
/// One rank only; see on_root().
class AtomicFile
{
public:
  /// Creates the temporary file, empty.
  /// @throws rpc::Error: bad_input if the folder or an older file cannot be written to, internal_error otherwise (disk
  /// full)
  explicit AtomicFile(const std::string &path);
  /// Removes the temporary file unless commit() has run.
  ~AtomicFile();
  AtomicFile(const AtomicFile &) = delete;
  AtomicFile &operator=(const AtomicFile &) = delete;

  /// Where to write meanwhile: the path with the process id appended.
  const std::string &temporary() const { return temporary_; }

  /// Gives the file its name while it is still being written; an older file of that name is replaced. From now on it stays.
  /// @throws rpc::Error as the constructor does
  void publish();
  /// Flushes the file to disk. The writer has closed it before.
  /// @throws rpc::Error as the constructor does
  void sync() const;
  /// Flushes the file to disk and publishes it, if that has not been done. The writer has closed the file before.
  /// @throws rpc::Error as the constructor does
  void commit();

private:
  std::string path_;
  std::string temporary_;
  bool published_ = false;
};

class Descriptor;

/// A text file that grows line by line, and can be read meanwhile. A process that is killed leaves all that was appended.
///
/// One rank only.
class GrowingFile
{
public:
  /// Replaces an older file by one with a first text, whole or not at all.
  /// @throws rpc::Error as AtomicFile does
  GrowingFile(const std::string &path, const std::string &beginning);
  ~GrowingFile();
  /// @throws rpc::Error (internal_error) if the text cannot be written; nothing of it stays
  void append(const std::string &text);

private:
  std::unique_ptr<Descriptor> file_;
};

/// Removes temporary files that killed processes have left, those of require_writable_folder() too; for the owner of the RunLock alone.
/// @param is_ours  of the name of the file that one was to become
void remove_abandoned(const std::string &folder, const std::function<bool(const std::string &)> &is_ours);

/// Writes a whole text file or none; one rank only.
/// @throws rpc::Error: bad_input if the folder cannot be written to, internal_error otherwise (disk full)
void write_text(const std::string &path, const std::string &text);

/// Proves that nothing stands in the way of a file: no folder, pipe, socket or device of its name, no older file without
/// permission to write to it, which renaming would not respect, and no name that is too long, with what is appended to it
/// meanwhile; one rank only.
/// @throws rpc::Error (bad_input) with the system's reason and the remedy
void require_replaceable(const std::string &path);

/// Removes a file that an earlier run has left. What is no ordinary file stays; a missing file is no error. One rank only.
/// @throws rpc::Error (bad_input) with the system's reason and the remedy, if permission to write to the file is missing too
void remove_older(const std::string &path);

/// Makes the folder, and those above it, if it is missing, and proves that files can be made in it; one rank only.
/// @throws rpc::Error (bad_input) with the system's reason and the remedy
void require_writable_folder(const std::string &folder);

} // namespace rpc::io
