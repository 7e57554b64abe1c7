#pragma once

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

  /// Flushes the temporary file to disk and gives it its name; an older file of that name is replaced.
  /// The writer has closed the file before.
  /// @throws rpc::Error as the constructor does
  void commit();

private:
  std::string path_;
  std::string temporary_;
  bool committed_ = false;
};

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
