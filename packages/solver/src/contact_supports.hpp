#pragma once

#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc::solver
{

/// The supports of this rank's contact nodes on a mesh, its rows of the matrix S (contact nodes x nodes of the mesh): the displacement
/// at contact node c is sum_n S_cn u(n). The contact nodes have a map of their own, with consecutive gids.
struct ContactSupports {
  RCP<const Map> contact;
  std::vector<std::size_t> begin{0}; ///< (own contact nodes + 1)
  std::vector<GO> node;              ///< (entries) gids of the mesh's nodes
  std::vector<double> weight;        ///< (entries)

  int size() const { return static_cast<int>(begin.size()) - 1; }
};

/// On the mesh whose nodes the contact nodes are; collective.
/// @param nodes  (n) owned nodes of the mesh   @param mesh  map of all of its nodes
ContactSupports contact_supports(const DeviceView<LO *> &nodes, const RCP<const Map> &mesh);

/// On the next coarser mesh, S P: a rank asks others for the rows of P that its supports need. Collective.
/// @param interpolation  P, (nodes of the mesh x nodes of the coarser one)
ContactSupports coarser(const ContactSupports &supports, const CrsMatrix &interpolation);

/// The whole supports of those contact nodes, of any rank, that have an entry at a node that this rank owns; ascending by gid.
struct NearSupports {
  RCP<const Import> importer;        ///< from the contact nodes to these
  std::vector<std::size_t> begin{0}; ///< (near contact nodes + 1)
  std::vector<GO> node;              ///< (entries) gids of the mesh's nodes
  std::vector<double> weight;        ///< (entries)

  int size() const { return static_cast<int>(begin.size()) - 1; }
};

/// Collective. @param mesh  map of the nodes of the mesh that the supports are on
NearSupports near_supports(const ContactSupports &supports, const Map &mesh);

} // namespace rpc::solver
