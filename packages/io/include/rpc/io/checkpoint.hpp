// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/io/exodus.hpp"

#include <string>
#include <vector>

namespace rpc::io
{

/// Writes nodal fields, a text and arrays as an Exodus file, whole or not at all, so that a run can go on from it. The file also holds
/// the version of the program, and numbers that stand for the mesh, the fields and each array. Collective.
/// @param text    in UTF-8
/// @param arrays  what belongs to no node; rank 0's are written
/// @throws rpc::Error on every rank as ExodusFile does
void write_checkpoint(const std::string &path, const mesh::Mesh &mesh, double time,
                      const std::vector<NodalField> &fields, const std::string &text,
                      const std::vector<NamedArray> &arrays = {});

/// What write_checkpoint() was given. Rank 0 reads, fields a piece at a time; any number of ranks may have written. Collective.
class Checkpoint
{
public:
  /// @throws rpc::Error (bad_input) on every rank if the file cannot be read, is no checkpoint, is damaged, or of another version
  Checkpoint(const std::string &path, const RCP<const Comm> &comm);

  double time() const { return time_; }
  const std::string &text() const { return text_; }
  /// The names on all ranks, the values on rank 0 only.
  const std::vector<NamedArray> &arrays() const { return arrays_; }
  /// Whether the file belongs to a mesh. Collective.
  bool is_of(const mesh::Mesh &mesh) const;
  /// The fields on a mesh, in the order in which they were written.
  /// @throws rpc::Error (bad_input) on every rank if the file belongs to another mesh, or its fields are damaged
  std::vector<NodalField> fields(const mesh::Mesh &mesh) const;

private:
  std::string path_;
  RCP<const Comm> comm_;
  double time_ = 0;
  std::string text_, mesh_number_, fields_number_;
  std::vector<std::string> names_;
  std::vector<NamedArray> arrays_;
};

} // namespace rpc::io
