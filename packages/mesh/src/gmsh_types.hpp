// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rpc::mesh
{

/// What gmsh's number of an element type means.
struct GmshType {
  const char *shape;
  int dim, num_nodes;

  std::string name() const { return shape + (" " + std::to_string(num_nodes)); } ///< as gmsh calls it
};

/// nullptr for a number that is none, or rare.
const GmshType *gmsh_type(int number);

/// "Triangle 3", or the number of one that is unknown.
std::string name_of_gmsh_type(int number);

} // namespace rpc::mesh
