#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rpc::mesh
{

// What read_gmsh() and the module rpc_gmsh tell each other. The module is loaded at the first use of gmsh, whose own
// libraries take a tenth of a second to load; it knows nothing else of rpc.

/// A .geo to be meshed.
struct GmshRequest {
  std::string file;
  double size_factor = 1; ///< of all cell sizes
  int order = 2;
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
  bool solid = false;                 ///< whether there are elements of dimension 3
  std::vector<GmshGroup> groups;      ///< by dimension, then tag
  std::vector<GmshElements> elements; ///< by group, then entity tag
  std::vector<std::size_t> node_tags;
  std::vector<double> coords;               ///< (nodes, 3) in the order of node_tags
  std::vector<std::size_t> ungrouped_nodes; ///< tags of the nodes of cells outside every physical surface
};

/// The module's only symbol.
using LoadGmsh = void(const GmshRequest &request, GmshContents &contents) noexcept;
constexpr const char *load_gmsh_symbol = "rpc_load_gmsh";

} // namespace rpc::mesh
