// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "middles.hpp"

#include <functional>

namespace rpc::mesh
{

/// Where a new node lies: (cell, node of the cell of order 2) -> dim coordinates [m].
using NewPlaces = std::function<void(int cell, int node, double *x)>;

/// Adds the nodes in the middle of edges, faces and cells that make a mesh of order 1 one of order 2, in the same cells. Those of the
/// boundary go to its shape, where it is curved. Nodes are renumbered in the order of the cells, so that neighbours lie close in memory; ids
/// of nodes stay, those of new ones follow them. Collective.
/// @param kinds  those that get nodes, see middles_of(); a cell has -1 in the place of the others
/// @param place  empty: in the middle of the vertices
/// @param file   the .geo of shapes without closed formulas
LocalMesh with_middle_nodes(const LocalMesh &mesh, const std::vector<Middles> &kinds, const NewPlaces &place,
                            const std::string &file);

} // namespace rpc::mesh
