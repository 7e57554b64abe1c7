// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/mesh.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rpc::io
{

class ExodusReader;
struct ExodusHeader;

/// A nodal variable of an output file.
struct NodalField {
  std::string name;          ///< at most 32 characters; ParaView joins disp_x and disp_y to a vector
  HostView<double *> values; ///< (owned nodes)
};

/// A variable of an output file that each cell has one value of.
struct CellField {
  std::string name;          ///< at most 32 characters
  HostView<double *> values; ///< (owned cells)
};

/// Numbers of an output file that belong to no node, as many as there are.
struct NamedArray {
  std::string name;           ///< at most 32 characters; the same on all ranks
  std::vector<double> values; ///< rank 0 only
};

/// Whether an Exodus file has the whole mesh, or each rank writes a file of its own cells and their nodes.
enum class ExodusFiles { joined, split };

/// The file of one rank, as `epu` and ParaView take them: "beam.e.16.03" is that of rank 3 of 16.
std::string exodus_file_of(const std::string &path, int num_ranks, int rank);

/// An Exodus file of a mesh with fields at several times; all members are collective. It appears whole or not at all, or, once it is
/// published, grows from time to time: then it can be read meanwhile, and a process that is killed leaves all times but the last.
///
/// Joined, rank 0 writes, in the order of Mesh::node_id and Mesh::cell_id, so that the file does not depend on the number of
/// ranks: the mesh's blocks and, as side sets, its sides with their names. Coordinates and fields are collected a piece at a time.
/// Split, each rank writes its own cells with their nodes, in the same order, their numbers in the whole mesh and all blocks and sides,
/// some of them empty; a file that one rank cannot write is an error on all of them.
/// No date is written: equal results give equal files. 64-bit offsets, for files beyond 2 GiB.
class ExodusFile
{
public:
  /// Writes the mesh, under a temporary name.
  /// @param title   cut at 80 characters
  /// @param mesh    is to live as long as this does
  /// @param fields  names, the same at all times
  /// @param info    information records, each cut at 80 characters
  /// @param arrays  those of rank 0 are written; readers see node sets. None with split files
  /// @param cell_fields  names of those that cells have, the same at all times
  /// @throws rpc::Error on every rank: bad_input for a folder that cannot be written to, internal_error for a name that is too
  ///         long or a failed write
  ExodusFile(const std::string &path, const std::string &title, const mesh::Mesh &mesh,
             const std::vector<std::string> &fields, const std::vector<std::string> &info = {},
             const std::vector<NamedArray> &arrays = {}, ExodusFiles files = ExodusFiles::joined,
             const std::vector<std::string> &cell_fields = {});
  /// Removes the file unless commit() has run.
  ~ExodusFile();

  /// Adds a time, larger than those before it, with its fields.
  /// @throws rpc::Error (internal_error) on every rank for other fields, one of the wrong length or a failed write
  void write(double time, const std::vector<NodalField> &fields, const std::vector<CellField> &cell_fields = {});
  /// Adds times of an older file of the same mesh and fields, in their order; nothing if it is not such a file, joined or split as this.
  /// @param wanted  rising; those that the older file has too are added
  /// @return how many were
  int take_times(const std::string &older, const std::vector<double> &wanted);
  /// Gives the file its name; each time that is written is in it from now on.
  void publish();
  /// Closes the file and gives it its name, if it has none yet.
  void commit();

private:
  struct Impl;
  void begin_joined(const std::string &path, const ExodusHeader &header, const std::vector<NamedArray> &arrays);
  void begin_split(const std::string &path, const ExodusHeader &header);
  void on_writers(const std::function<void()> &work);
  template <class Fields, class Order, class Mine, class Put>
  void write_fields(const Fields &fields, const Order &order, const Mine &mine, const Put &put);
  bool is_of_this_mesh(const ExodusReader *file);
  const mesh::Mesh &mesh_;
  std::unique_ptr<Impl> impl_;
};

/// The times of an Exodus file, of split ones those that all ranks' files have; none if it cannot be read. Collective.
std::vector<double> exodus_times(const std::string &path, const Comm &comm, ExodusFiles files = ExodusFiles::joined);
/// Makes an Exodus file that nobody writes end after some of its times, from the first. Collective.
void end_exodus_after(const std::string &path, int number, const Comm &comm, ExodusFiles files = ExodusFiles::joined);

/// A file with one time.
void write_exodus(const std::string &path, const std::string &title, const mesh::Mesh &mesh, double time,
                  const std::vector<NodalField> &fields, const std::vector<std::string> &info = {},
                  ExodusFiles files = ExodusFiles::joined);

} // namespace rpc::io
