// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"
#include "rpc/mesh/element.hpp"
#include "rpc/mesh/geometry.hpp"
#include "rpc/mesh/ids.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace rpc::mesh
{

struct BoxOptions;

/// A named part of the boundary: those of its facets that touch a node which this rank owns, or belong to a cell which
/// it owns. Over all ranks each facet has an owned cell once.
struct Side {
  std::string name;
  DeviceView<LO **>
      facets; ///< (facets, facet nodes), overlap node lids; order gives the outward normal, see Element::facets
  DeviceView<LO *> cell;        ///< (facets) local cell that the facet belongs to
  DeviceView<int *> ordinal;    ///< (facets) which facet of that cell
  DeviceView<LO **> place = {}; ///< where nodes of facets lie, see Mesh::place

  /// (facets, facet nodes) Rows of Mesh::coords.
  const DeviceView<LO **> &places() const { return place.extent(0) > 0 ? place : facets; }
};

/// Named nodes that are no side: a corner of a box, physical points of gmsh.
struct PointSet {
  std::string name;
  std::vector<LO> node; ///< this rank's owned nodes among them, ascending
};

struct Mesh;

/// Kinds of children of a cell: (kinds, vertices) reference coordinates of the parent where the child's vertices lie; those beyond the
/// dimension are 0.
using ChildVertices = std::vector<std::vector<std::array<double, 3>>>;

/// The mesh that another one was refined from, see refined(), of joined cells, see distribute_with_parents(), or of contracted edges, see
/// distribute_with_contracted().
struct Parents {
  std::shared_ptr<const Mesh> mesh;
  std::vector<LO> cell;   ///< (local cells) the parent's local cell; others' may be -1: not here
  std::vector<int> kind;  ///< (local cells) which kind of child of it this is
  ChildVertices vertices; ///< of each kind
  bool nested =
      true; ///< whether cells are parts of its cells; else only `mesh` is known, and a search tells where nodes lie in it
};

/// One rank's part of a mesh.
///
/// A rank holds every cell that touches a node which it owns, so that it fills its own matrix rows without
/// communication; the cells that it owns itself (each cell has one owner) come first. Overlap node lids run over the
/// owned nodes first, so that an owned node has one lid in both maps. Node gids are consecutive on each rank; `node_id`
/// and `cell_id` number the mesh independently of the number of ranks, 0-based; output is ordered by them.
///
/// In a periodic box a node of a lower side is also that of the upper side. Such a node has a place more, its image on the upper side, and
/// cells there lie between images. Kernels read coordinates of cells and facets at places(), all else at nodes.
struct Mesh {
  Element element;
  RCP<const Map> owned_nodes;   ///< one-to-one
  std::vector<GO> ghosts;       ///< gids of the overlap nodes that other ranks own, in the order of their lids
  DeviceView<double **> coords; ///< (overlap nodes, in a periodic box then images of nodes; dim) [m]
  DeviceView<LO **> cells;      ///< (local cells, nodes per cell) overlap node lids
  DeviceView<LO **> place = {}; ///< (local cells, nodes per cell) rows of coords; empty: where the nodes themselves lie
  DeviceView<int *> block;      ///< (local cells) index into blocks
  Ids node_id;                  ///< (owned nodes)
  Ids cell_id;                  ///< (owned cells); over the whole mesh they run block by block
  LO num_owned_cells = 0;
  std::vector<std::string> blocks;       ///< names of the parts of the body, the same on all ranks
  std::vector<Side> sides;               ///< the same on all ranks, though a rank may have no facets of one
  std::vector<PointSet> points;          ///< the same on all ranks, though a rank may have no nodes of one
  std::shared_ptr<const BoxOptions> box; ///< of which the mesh was made; null if it is no box
  std::vector<BoundaryPart> geometry;    ///< what facets lie on, as far as it is known: those of a side would be listed
  std::string geometry_file;             ///< the .geo by which gmsh tells points of shapes without closed formulas
  std::vector<std::string> notes;        ///< on rank 0: what was mended, or left out, of a file
  std::shared_ptr<const Parents> parents; ///< null if it has no coarser one

  int dim() const { return element.dim; }
  /// (local cells, nodes per cell) Rows of coords.
  const DeviceView<LO **> &places() const { return place.extent(0) > 0 ? place : cells; }
  LO num_owned_nodes() const { return num_local(*owned_nodes); }
  LO num_local_nodes() const { return num_owned_nodes() + static_cast<LO>(ghosts.size()); }
  /// Of an overlap node. Owned ones have consecutive gids.
  GO node_gid(const LO lid) const
  {
    const LO num_owned = num_owned_nodes();
    return lid < num_owned ? owned_nodes->getMinGlobalIndex() + lid : ghosts[lid - num_owned];
  }
  /// The map of all nodes of local cells, owned first; in one process that of the owned ones. It lists them all: only matrices and
  /// Tpetra's imports ask for it. Collective.
  RCP<const Map> overlap_nodes() const;
  LO num_cells() const { return static_cast<LO>(cells.extent(0)); }
  const Comm &comm() const { return *owned_nodes->getComm(); }

  /// @throws rpc::Error (bad_input) naming `user` (a deck path) and listing the sides that exist
  const Side &side(const std::string &name, const std::string &user) const;
  /// The owned nodes of a side, or of points, ascending.
  /// @throws rpc::Error (bad_input) naming `user` and listing the sides and points that exist
  std::vector<LO> nodes_of(const std::string &name, const std::string &user) const;
};

/// The side of some facets of a mesh's local cells.
/// @param cell     (facets) local cell
/// @param ordinal  (facets) which facet of that cell
Side make_side(const std::string &name, const Mesh &mesh, const HostView<LO *> &cell, const HostView<int *> &ordinal);

/// Diagonal of the bounding box [m]; collective.
double diameter(const Mesh &mesh);

} // namespace rpc::mesh
