// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <array>
#include <vector>

namespace rpc::mesh
{

/// A facet on the boundary of the body, or between two of its blocks.
struct FeatureFacet {
  std::array<int, 3> vertex; ///< in the order that gives the normal out of its first cell; the last is -1 in the plane
  int label;                 ///< the same for facets of the same sides, and of the same blocks on both sides
};

/// Where the boundary of a mesh of triangles or tetrahedra has faces, edges and corners: by the names of sides, by blocks, and by angles.
struct Features {
  enum class Rank : char { inside, face, edge, corner };

  std::vector<FeatureFacet> facets;
  std::vector<std::vector<int>> sides;     ///< (labels) those that its facets belong to
  std::vector<Rank> rank;                  ///< (vertices)
  std::vector<std::vector<int>> next_edge; ///< (vertices) neighbours along edges of the boundary; in space
};

/// An edge lies where facets of unlike labels meet, more than two do, or their normals differ by more than 40 degrees. A corner is a vertex with
/// a name, with other than two such edges, with two that turn by more than 40 degrees, or in which parts of the boundary touch.
/// @param mesh  of order 1
Features features_of(const MeshData &mesh);

/// The normal of a facet, as long as its area, in space twice that.
std::array<double, 3> facet_normal(const MeshData &mesh, const std::array<int, 3> &vertex);

} // namespace rpc::mesh
