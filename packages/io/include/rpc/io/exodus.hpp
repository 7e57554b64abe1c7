#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/mesh.hpp"

#include <string>
#include <vector>

namespace rpc::io
{

/// A nodal variable of an output file.
struct NodalField {
  std::string name;          ///< at most 32 characters; ParaView joins disp_x and disp_y to a vector
  HostView<double *> values; ///< (owned nodes)
};

/// Writes mesh and fields as one Exodus file, whole or not at all; collective.
///
/// Rank 0 writes, in the order of Mesh::node_id and Mesh::cell_id, so that the file does not depend on the number of
/// ranks: the mesh's blocks and, as side sets, its sides with their names, one time step at time 0.
/// Coordinates and fields are collected one at a time. No date is written: equal results give equal files. 64-bit
/// offsets, for files beyond 2 GiB.
/// @param title  cut at 80 characters
/// @param info   information records, each cut at 80 characters
/// @throws rpc::Error on every rank: bad_input for a folder that cannot be written to, internal_error for a name that
/// is too
///         long, a field of the wrong length or a failed write
void write_exodus(const std::string &path, const std::string &title, const mesh::Mesh &mesh,
                  const std::vector<NodalField> &fields, const std::vector<std::string> &info = {});

} // namespace rpc::io
