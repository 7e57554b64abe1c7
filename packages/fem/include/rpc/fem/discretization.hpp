// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/dofs.hpp"
#include "rpc/core/halo.hpp"
#include "rpc/fem/kinematics.hpp"
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

/// The cells at each owned node, as offsets and list, ascending within a node. (Of a side: its facets.)
struct NodeToCells {
  DeviceView<std::size_t *> row; ///< (owned nodes + 1)
  DeviceView<LO *> cell;         ///< (entries) local cells
};

/// Kinds of congruent local cells: those of a kind are each other's translates, up to the rounding of coordinates. What
/// does not depend on a cell's place is computed once for each kind. No kinds where cells differ: then each is computed by itself.
struct CongruentCells {
  DeviceView<signed char *> of_cell; ///< (local cells) kind
  /// A cell of each kind by itself, its first node at 0: the same one on all ranks that have the kind, to the last digit. Else forces of
  /// cells that ranks have in common would not balance, and slender bodies bend by that.
  DeviceView<double **> coords; ///< (kinds * nodes, dim) [m]
  DeviceView<LO **> cells;      ///< (kinds, nodes) rows of coords

  int size() const { return static_cast<int>(cells.extent(0)); }
};

/// A mesh with its displacement unknowns, numbered as dofs.hpp says.
struct Discretization {
  std::shared_ptr<const mesh::Mesh> mesh;
  Kinematics kinematics = Kinematics::plane_strain;
  double diameter = 0;        ///< diagonal of the body's bounding box [m]
  double on_axis = 0;         ///< of an axisymmetric body: nodes with r up to this lie on the axis, where u_r = 0 [m]
  ReferenceElement reference; ///< of mixed elements none: their stiffness is that of Q2
  RCP<const Map> owned_dofs;  ///< rows; columns are the unknowns of the overlap nodes
  std::shared_ptr<const Halo> halo, node_halo; ///< of unknowns and of nodes; empty in one process
  CongruentCells congruent;
  NodeToCells node_to_cells;
  std::shared_ptr<NodeGraph> kept_nodes = std::make_shared<NodeGraph>(); ///< of all copies; empty: to be made

  /// Made where it is asked for, and kept until it is forgotten: a box without a matrix needs it but once, and it takes as much
  /// memory as four displacements.
  NodeGraph nodes() const;
  void forget_nodes() const { *kept_nodes = {}; }
  int dim() const { return mesh->dim(); }
  LO num_overlap_dofs() const { return num_dofs(dim(), mesh->num_local_nodes()); }
  bool axisymmetric() const { return kinematics == Kinematics::axisymmetric; }
  /// Whether forces, energies and areas are those of a slice of the body, per length across the plane.
  bool per_length() const { return dim() == 2 && !axisymmetric(); }
};

/// Collective.
/// @param kinematics  the default for a mesh in space
/// @throws rpc::Error (bad_input) if it is none for a mesh in space, (bad_mesh) on every rank if a node of an axisymmetric body lies at r < 0, naming the farthest
Discretization discretize(std::shared_ptr<const mesh::Mesh> mesh, Kinematics kinematics = Kinematics::plane_strain);

/// The nodes of an axisymmetric body that this rank owns on the axis, ascending.
DeviceView<LO *> nodes_on_axis(const Discretization &d);

/// The pattern of every matrix: fill-complete, columns ascending. Collective.
RCP<const CrsGraph> dof_graph(const Discretization &d);

/// The columns of every matrix. It lists all of this rank's unknowns: only matrices ask for it. Collective.
RCP<const Map> overlap_dofs(const Discretization &d);

/// Values with those of the neighbours' nodes, (overlap dofs), from those of the owned ones; collective. The same vector where
/// there are no neighbours: for reading, as long as the given vector exists and does not change.
RCP<const Vector> on_overlap(const Discretization &d, const Vector &owned);
RCP<const Vector> on_overlap(const Discretization &d, const Vector &&owned) = delete;

/// The same of values at nodes: (overlap nodes; columns) from (owned nodes; columns). The same table where there are no
/// neighbours; collective.
RCP<const MultiVector> nodes_on_overlap(const Discretization &d, const RCP<const MultiVector> &owned);

/// The map of such tables: of this rank alone, without a list.
RCP<const Map> overlap_rows(const Discretization &d);

/// Rows of the neighbours' nodes become what these have in theirs; collective.
/// @param table  on overlap_rows()
void fill_ghost_rows(const Discretization &d, MultiVector &table);

/// Coordinates of the owned nodes, (owned nodes; dim) [m]: multigrid partitions by them.
RCP<MultiVector> node_coordinates(const Discretization &d);

/// Rigid body modes about the centroid, (owned dofs; 3 in 2D, 6 in 3D): the near-null space of elasticity.
RCP<MultiVector> rigid_body_modes(const Discretization &d);

} // namespace rpc::fem
