#pragma once

#include "rpc/mesh/size_field.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace rpc::mesh
{

// What read_gmsh() and the program rpc_gmsh tell each other. The program knows nothing else of rpc.

/// A body to be meshed: a .geo, or where `file` is empty a box.
struct GmshRequest {
  std::string folder; ///< in which relative paths begin
  std::string file;
  std::array<double, 2> lower{}, upper{}; ///< of the box
  bool quadrilaterals = false;            ///< in the box; a .geo has its own kind
  double size_factor = 1;                 ///< of all cell sizes
  int order = 2;
  int attempt = 0; ///< by a field of sizes: each breaks ties in another way
  SizeField sizes; ///< without triangles: those that the .geo asks for
};

/// Physical group of curves or surfaces.
struct GmshGroup {
  int dim = 0, tag = 0;
  std::string name;
};

/// The elements of one type on one curve or surface.
struct GmshElements {
  int group = 0;                  ///< index into GmshContents::groups
  int type = 0;                   ///< gmsh's number, see gmsh_type()
  std::vector<std::size_t> tags;  ///< (elements)
  std::vector<std::size_t> nodes; ///< (elements, nodes per element) tags
};

/// All tags are gmsh's numbers.
struct GmshContents {
  std::string complaint;              ///< gmsh's; nothing else counts if there is one
  bool again = false;                 ///< whether another attempt may do better
  bool solid = false;                 ///< whether there are elements of dimension 3
  std::vector<GmshGroup> groups;      ///< by dimension, then tag
  std::vector<GmshElements> elements; ///< by group, then entity tag
  std::vector<std::size_t> node_tags;
  std::vector<double> coords;               ///< (nodes, 3) in the order of node_tags
  std::vector<std::size_t> ungrouped_nodes; ///< tags of the nodes of cells outside every physical surface
};

} // namespace rpc::mesh
