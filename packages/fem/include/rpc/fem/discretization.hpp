#pragma once

#include "rpc/core/tpetra.hpp"
#include "rpc/fem/reference_element.hpp"
#include "rpc/mesh/mesh.hpp"

#include <memory>

namespace rpc::fem
{

/// Which nodes share a cell with each owned node: the pattern of every matrix, once per node instead of once per
/// unknown.
struct NodeGraph {
  DeviceView<std::size_t *> row; ///< (owned nodes + 1)
  DeviceView<LO *> col;          ///< (entries) overlap node lids, ascending in each row
};

/// A mesh with its displacement unknowns: `dim` per node, unknown c of node n is dim n + c in every numbering.
struct Discretization {
  std::shared_ptr<const mesh::Mesh> mesh;
  ReferenceElement reference;
  RCP<const Map> owned_dofs;    ///< rows
  RCP<const Map> overlap_dofs;  ///< columns
  RCP<const Import> dof_import; ///< owned -> overlap
  NodeGraph nodes;
  RCP<const CrsGraph> graph; ///< fill-complete, columns ascending

  int dim() const { return mesh->dim(); }
};

/// Collective.
Discretization discretize(std::shared_ptr<const mesh::Mesh> mesh);

/// Coordinates of the owned nodes, (owned nodes; dim) [m]: what multigrid partitions by.
RCP<MultiVector> node_coordinates(const Discretization &d);

/// Rigid body modes about the centroid, (owned dofs; 3 in 2D, 6 in 3D): the near-null space of elasticity.
RCP<MultiVector> rigid_body_modes(const Discretization &d);

} // namespace rpc::fem
