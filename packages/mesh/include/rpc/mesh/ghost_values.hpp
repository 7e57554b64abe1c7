// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/exchange.hpp"
#include "rpc/mesh/mesh.hpp"

#include <vector>

namespace rpc::mesh
{

/// Host values of nodes that other ranks own: the owners are asked once for the nodes, then for one array after another. For output and
/// the like; vectors of a solve have a Halo.
class GhostValues
{
public:
  /// Collective.
  /// @param mesh    is to live as long as this does
  /// @param ghosts  places in Mesh::ghosts of those that are wanted
  GhostValues(const Mesh &mesh, const std::vector<LO> &ghosts);

  /// @param owned  (owned nodes)
  /// @return (wanted ghosts); collective
  std::vector<double> of(const double *owned) const;

private:
  struct Questions {
    std::vector<std::size_t> order; // of the wanted ghosts: by the ranks that are asked
    std::vector<int> counts;        // (ranks)
    std::vector<double> node;       // in that order, local number at the owner
  };
  static Questions questions(const Mesh &mesh, const std::vector<LO> &ghosts);
  GhostValues(const Mesh &mesh, const Questions &questions);

  std::vector<std::size_t> order_;
  Exchange exchange_;
  std::vector<LO> asked_; // owned nodes that other ranks want
};

} // namespace rpc::mesh
