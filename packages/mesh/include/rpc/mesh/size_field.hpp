#pragma once

#include <vector>

namespace rpc::mesh
{

/// Cell sizes that a mesh is to have, given at the nodes of another plane mesh of about the same body: linear in each of
/// its triangles; outside of all of them (curved boundaries) that of the nearest point.
///
/// A mesh follows it well where sizes grow by up to a fifth of the distance, and has up to a half more cells where they grow by a
/// half.
struct SizeField {
  std::vector<double> coords; ///< (nodes, 2) [m]
  std::vector<int> triangles; ///< (triangles, 3) nodes, 0-based
  std::vector<double> size;   ///< (nodes) edge lengths [m], > 0
};

/// About how many triangles a mesh of the field's triangles has: the integral of 4 / (sqrt(3) size^2).
double expected_cells(const SizeField &field);

} // namespace rpc::mesh
