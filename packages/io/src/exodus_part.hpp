// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exodus_writer.hpp"
#include "rpc/mesh/ghost_values.hpp"
#include "rpc/mesh/mesh.hpp"

#include <string>
#include <vector>

namespace rpc::io
{

/// What a file of one rank's own has of a mesh: the cells that the rank owns, block by block, and their nodes, each ordered by its number in
/// the whole mesh. Private to io.
class ExodusPart
{
public:
  /// Collective. @param mesh  is to live as long as this does
  explicit ExodusPart(const mesh::Mesh &mesh);

  GO num_nodes() const { return static_cast<GO>(node_.size()); }
  std::vector<GO> block_sizes() const; ///< cells in each
  ExodusShare share() const;           ///< collective
  std::vector<double> coordinate(int direction) const;
  std::vector<int> connectivity() const; ///< (cells, nodes per cell) 1-based
  std::vector<SideSet> sides() const;    ///< of this rank's cells
  /// @param owned  (owned nodes)
  /// @return at the file's nodes; collective
  std::vector<double> at_nodes(const HostView<double *> &owned) const;
  /// @param owned  (owned cells)
  /// @return at the file's cells
  std::vector<double> at_cells(const HostView<double *> &owned) const;

private:
  /// What the constructor finds before it asks other ranks.
  struct Found {
    std::vector<LO> node, cell, ghosts;
    std::vector<int> place;
    std::vector<GO> id;
  };
  static Found find(const mesh::Mesh &mesh);
  ExodusPart(const mesh::Mesh &mesh, Found found);

  const mesh::Mesh &mesh_;
  std::vector<LO> node_;   // (file's nodes) overlap lids
  std::vector<GO> id_;     // (file's nodes) in the whole mesh
  std::vector<LO> cell_;   // (file's cells) local cells
  std::vector<int> place_; // (overlap nodes) in the file, -1 for others
  std::vector<LO> ghosts_; // places in Mesh::ghosts of the file's nodes that other ranks own, ascending
  mesh::GhostValues ghost_values_;
};

} // namespace rpc::io
