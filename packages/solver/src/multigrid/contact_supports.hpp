// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc::solver
{

/// Rows of a matrix whose columns are the nodes of a mesh.
struct SupportRows {
  std::vector<std::size_t> begin{0}; ///< (rows + 1)
  std::vector<GO> node;              ///< (entries) gids of the mesh's nodes
  std::vector<double> weight;        ///< (entries)

  int size() const { return static_cast<int>(begin.size()) - 1; }
};

/// The supports of this rank's contact nodes on a mesh, its rows of the matrix S (contact nodes x nodes of the mesh): the displacement
/// at contact node c is sum_n S_cn u(n). The contact nodes have a map of their own, with consecutive gids. A block U of contact node c
/// adds S_cm U S_cn to the mesh's matrix.
///
/// Or of blocks of a finer mesh's matrix in their stead, which couple node i with node j: then the rows are those of P at i, `column`
/// has those at j, and a block adds P_im U P_jn.
struct ContactSupports : SupportRows {
  RCP<const Map> contact;
  SupportRows column; ///< empty: the rows themselves
};

/// On the mesh whose nodes the contact nodes are; collective.
/// @param nodes  (n) owned nodes of the mesh   @param mesh  map of all of its nodes
ContactSupports contact_supports(const DeviceView<LO *> &nodes, const RCP<const Map> &mesh);

/// On the next coarser mesh, S P: a rank asks others for the rows of P that its supports need. Collective.
/// @param interpolation  P, (nodes of the mesh x nodes of the coarser one)
ContactSupports coarser(const ContactSupports &supports, const CrsMatrix &interpolation);

/// Those of blocks of the finer mesh's matrix. Each of them reaches a few nodes, however many contact nodes are behind it; collective.
/// @param row, column  (blocks) gids of their nodes on the finer mesh; rows ascend and are owned, and each column that is owned is a row
/// @param interpolation  P, (nodes of the finer mesh x nodes of this one)
ContactSupports supports_of_blocks(const std::vector<GO> &row, const std::vector<GO> &column,
                                   const CrsMatrix &interpolation);

/// The whole supports of those contact nodes, of any rank, that have an entry at a node that this rank owns; ascending by gid.
struct NearSupports : SupportRows {
  RCP<const Import> importer; ///< from the contact nodes to these
  SupportRows column;         ///< empty: the rows themselves
};

/// Collective. @param mesh  map of the nodes of the mesh that the supports are on
NearSupports near_supports(const ContactSupports &supports, const Map &mesh);

} // namespace rpc::solver
