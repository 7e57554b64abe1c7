// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/geometry.hpp"
#include "rpc/mesh/size_field.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace rpc::mesh
{

// What read_gmsh() and the program rpc_gmsh tell each other. The program knows nothing else of rpc.

/// A body to be meshed: a .geo or a file of shapes, or where `file` is empty a box. Or a mesh that gmsh reads.
struct GmshRequest {
  std::string folder; ///< in which relative paths begin
  std::string file;
  int box_dim = 2;                        ///< of the box, 2 or 3
  std::array<double, 3> lower{}, upper{}; ///< of the box
  bool quadrilaterals = false;            ///< in a plane box; a .geo has its own kind
  bool simplices = false;                 ///< by a field of sizes nothing is recombined to quadrilaterals
  double size_factor = 1;                 ///< of all cell sizes
  double size = 0;                        ///< of cells, of a file of shapes; 0: a tenth of the body
  int order = 2;
  int attempt = 0; ///< later ones than 0 straighten curved cells; by a field of sizes each breaks ties in another way
  bool straight_where_bent = false; ///< later attempts make all cells straight
  SizeField sizes;                  ///< without simplices: those that the .geo asks for
  bool dimension_only = false;      ///< no mesh is wanted
  bool geometry = false;            ///< of the boundary, besides the mesh
  /// Points that are wanted on the .geo's boundary instead of a mesh: near each of some, on a curve, in space on a surface, or on the
  /// curves that two surfaces share.
  std::vector<int> near_tags;      ///< (points, 2) the second is 0 where there is one
  std::vector<double> near_coords; ///< (points, 3)
};

/// Physical group of the body's parts, of its sides, or of points: of surfaces or curves, in space of volumes or surfaces.
struct GmshGroup {
  int dim = 0, tag = 0;
  std::string name; ///< empty: none
};

/// Name of the only block where no group says what the body is.
inline constexpr const char *whole_body = "body";

/// The elements of one type on one curve, surface or volume.
struct GmshElements {
  int group = 0;                  ///< index into GmshContents::groups
  int type = 0;                   ///< gmsh's number, see gmsh_type()
  std::vector<std::size_t> tags;  ///< (elements)
  std::vector<std::size_t> nodes; ///< (elements, nodes per element) tags
};

/// The elements of one type on a curve of a plane body, or on a surface of one in space.
struct GmshBoundary {
  BoundaryShape shape;
  int type = 0;                   ///< gmsh's number, see gmsh_type()
  std::vector<std::size_t> nodes; ///< (elements, nodes per element) tags
};

/// All tags are gmsh's numbers.
struct GmshContents {
  std::string complaint;         ///< gmsh's; nothing else counts if there is one
  bool again = false;            ///< whether another attempt may do better
  int dim = 2;                   ///< of the body: 3 if there are volumes
  std::vector<GmshGroup> groups; ///< of dimensions dim - 1 and dim, and of points with a name; by dimension, then tag
  std::vector<GmshElements> elements; ///< by group, then entity tag
  std::vector<std::size_t> node_tags;
  std::vector<double> coords;         ///< (nodes, 3) in the order of node_tags; or the points that were asked for
  std::vector<GmshBoundary> boundary; ///< by tag, where it was asked for
  std::vector<std::string> notes;     ///< what the user should know of how the file was read
  /// What messages call groups of points, curves, surfaces and volumes.
  std::array<std::string, 4> kind = {"physical point", "physical curve", "physical surface", "physical volume"};
  bool node_sets = false; ///< groups of points are sets of any nodes: those of whole facets are sides
  std::size_t last_node =
      std::size_t(-1); ///< tags beyond are nodes that the file lacks, in the middle of cells and faces
  std::vector<std::size_t> ungrouped_nodes; ///< of a .msh: tags of the nodes of cells that are not part of the body
};

} // namespace rpc::mesh
