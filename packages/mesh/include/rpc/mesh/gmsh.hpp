// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/box.hpp"
#include "rpc/mesh/mesh_data.hpp"
#include "rpc/mesh/size_field.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rpc::mesh
{

/// A side that a deck chooses among the facets of the boundary, by one of these.
struct SidePlace {
  struct Plane {
    int axis = 0;
    double at = 0; ///< [m]
  };
  std::string name;
  std::vector<int> surfaces;                 ///< gmsh's numbers; of curves in the plane
  std::vector<double> near;                  ///< a point [m]: the nearest surface
  std::optional<Plane> plane = std::nullopt; ///< normal to an axis
  std::vector<double> box;                   ///< lower and upper corner [m]
};

struct GmshContents;

/// A mesh that gmsh makes or made, or that of another file.
struct GmshOptions {
  std::string file; ///< a geometry that gmsh meshes (.geo, .step, ...), or a mesh (.msh, .e, ...), see mesh_formats.hpp
  double size_factor = 1; ///< of all cell sizes that a geometry or `sizes` ask for, > 0
  int order = 0;          ///< 1 or 2; 0: 2 for a geometry, for a mesh what it has
  std::optional<BoxOptions> box =
      std::nullopt; ///< no file then; if not `nested`, meshed by `sizes`, and its cells and `order` do not count
  std::shared_ptr<const SizeField> sizes = nullptr; ///< of cells, instead of those that a .geo asks for
  bool simplices = false; ///< by `sizes` a .geo that recombines triangles to quadrilaterals keeps the triangles
  /// Where curved cells bend too far all cells are made straight; else gmsh straightens those cells alone, which can take ten times as long
  /// as the mesh.
  bool straight_where_bent = false;
  int refinements = 0; ///< how often make_mesh() halves each cell, >= 0; with it a .geo's mesh has its geometry
  bool nested = false; ///< make_mesh() meets `sizes` by refined_to(), from base_mesh(): read_gmsh() is not to see them
  std::shared_ptr<const MeshData> base = nullptr; ///< base_mesh() of a nested one, on rank 0; null: not made yet

  double size = 0;                   ///< of the cells of a STEP, IGES, BREP or STL [m]; 0: a tenth of the body
  std::vector<SidePlace> sides = {}; ///< besides those that the file has
  bool list_surfaces = false;        ///< the mesh is to have its geometry
  /// Where gmsh_dimension() keeps what it has read of a file, for the first read_gmsh(); null: the file is read again.
  std::shared_ptr<GmshContents> contents = nullptr;
  std::string length_unit = {}; ///< of a deck that names it; empty: a note tells what a file of shapes is taken for

  bool needs_all_ranks = true; ///< else a mesh of fewer cells than ranks is on some of them; of no nested mesh

  bool needs_geometry() const { return refinements > 0 || nested; } ///< for new nodes on curved boundaries
};

/// Begins to load gmsh, which takes a tenth of a second, while this process does other things; the first mesh would do it.
/// Says nothing where that fails: the first mesh does. To be called in a thread that lives as long as meshes are made.
void start_gmsh_early();

/// Dimension of the body: 3 if there are volumes, else 2. Makes no mesh. One rank only.
/// @throws rpc::Error as read_gmsh() does, for the errors that can be seen this early
int gmsh_dimension(const GmshOptions &options);

/// Reads a mesh of triangles, quadrilaterals, tetrahedra or hexahedra, of order 1 or 2 (full: 9 and 27 nodes), curved where the
/// file's geometry is. Cells of several kinds, wedges and pyramids are divided into triangles or tetrahedra. One rank only.
///
/// A mesh is in space if there are volumes. Physical surfaces, in space volumes, become blocks and physical curves, in space
/// surfaces, sides, by their names, or where they have none by their numbers, in the order of their tags; groups of lower dimension
/// do not count, and cells outside every block are not part of the body. Without a block all cells are the body, the block
/// "body". Nodes keep gmsh's order. A box has the block and sides of make_box().
///
/// With `sizes`, a .geo's own cell sizes are out of play, but for an explicit Mesh.MeshSizeFromCurvature. Quadrilaterals
/// come from triangles, by recombination and division, unless `simplices` are asked for. Equal options give equal meshes, bit by bit.
/// @throws rpc::Error (bad_mesh) with file, group, cell or node concerned: gmsh's own complaint or end; no cells; cells of a plane mesh off the plane z = 0; cells of different orders or unsupported kinds, in two blocks,
///         degenerate, inverted or overlapping; a side with facets that belong to no cell or to two; nodes that no cell uses,
///         or two at one place; sizes that ask for too many cells (in space 2 million vertices); a field of sizes that are
///         not > 0 and finite, or that asks for more than 5 million cells, or is of another dimension than the body, or comes with a .geo that
///         divides curves by Transfinite or Layers.
///         (bad_input) if the file cannot be opened, a .msh comes with a size factor or another order, or a .geo with an
///         rpc that was built without gmsh: that only meshes, .msh files are read without it
MeshData read_gmsh(const GmshOptions &options);

} // namespace rpc::mesh
