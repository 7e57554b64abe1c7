// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"
#include "mesh_checks.hpp"

namespace rpc::mesh
{

/// The groups of facets. Those that lie inside the body become points, and those that belong to no cell are left out, with notes.
/// @param facets  of the draft's cells
/// @throws rpc::Error (bad_mesh) if a facet of a group that has others on the boundary belongs to no cell, or to two
void take_sides(const GmshContents &contents, const Entities &facets, TaggedMesh &draft);

/// Physical points, those that lie at nodes of cells: a circle's centre may lie at none. Of sets of nodes those of whole facets are sides.
void take_points(const GmshContents &contents, const Entities &facets, TaggedMesh &draft);

/// What the facets of the boundary lie on; elements inside the body, between two cells, do not count.
void take_geometry(const GmshContents &contents, const Entities &facets, TaggedMesh &draft);

} // namespace rpc::mesh
