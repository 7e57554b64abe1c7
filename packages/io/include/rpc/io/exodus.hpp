#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/mesh.hpp"

#include <memory>
#include <string>
#include <vector>

namespace rpc::io
{

/// A nodal variable of an output file.
struct NodalField {
  std::string name;          ///< at most 32 characters; ParaView joins disp_x and disp_y to a vector
  HostView<double *> values; ///< (owned nodes)
};

/// Numbers of an output file that belong to no node, as many as there are.
struct NamedArray {
  std::string name;           ///< at most 32 characters; the same on all ranks
  std::vector<double> values; ///< rank 0 only
};

/// An Exodus file of a mesh with fields at several times; all members are collective. It appears whole or not at all, or, once it is
/// published, grows from time to time: then it can be read meanwhile, and a process that is killed leaves all times but the last.
///
/// Rank 0 writes, in the order of Mesh::node_id and Mesh::cell_id, so that the file does not depend on the number of
/// ranks: the mesh's blocks and, as side sets, its sides with their names. Coordinates and fields are collected one at a time.
/// No date is written: equal results give equal files. 64-bit offsets, for files beyond 2 GiB.
class ExodusFile
{
public:
  /// Writes the mesh, under a temporary name.
  /// @param title   cut at 80 characters
  /// @param mesh    is to live as long as this does
  /// @param fields  names, the same at all times
  /// @param info    information records, each cut at 80 characters
  /// @param arrays  those of rank 0 are written; readers see node sets
  /// @throws rpc::Error on every rank: bad_input for a folder that cannot be written to, internal_error for a name that is too
  ///         long or a failed write
  ExodusFile(const std::string &path, const std::string &title, const mesh::Mesh &mesh,
             const std::vector<std::string> &fields, const std::vector<std::string> &info = {},
             const std::vector<NamedArray> &arrays = {});
  /// Removes the file unless commit() has run.
  ~ExodusFile();

  /// Adds a time, larger than those before it, with its fields.
  /// @throws rpc::Error (internal_error) on every rank for other fields, one of the wrong length or a failed write
  void write(double time, const std::vector<NodalField> &fields);
  /// Adds times of an older file of the same mesh and fields, in their order; nothing if it is not such a file.
  /// @param wanted  rising; those that the older file has too are added
  /// @return how many were
  int take_times(const std::string &older, const std::vector<double> &wanted);
  /// Gives the file its name; each time that is written is in it from now on.
  void publish();
  /// Closes the file and gives it its name, if it has none yet.
  void commit();

private:
  struct Impl;
  const mesh::Mesh &mesh_;
  std::unique_ptr<Impl> impl_;
};

/// The times of an Exodus file; none if it cannot be read. One rank only.
std::vector<double> exodus_times(const std::string &path);
/// Makes an Exodus file that nobody writes end after some of its times, from the first. One rank only.
void end_exodus_after(const std::string &path, int number);

/// A file with one time.
void write_exodus(const std::string &path, const std::string &title, const mesh::Mesh &mesh, double time,
                  const std::vector<NodalField> &fields, const std::vector<std::string> &info = {});

} // namespace rpc::io
