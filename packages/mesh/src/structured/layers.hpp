// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sheets.hpp"

#include <vector>

namespace rpc::mesh
{

/// Sheets in the order in which they follow each other, as the layers of a block do in one direction, and how they are joined to coarser ones.
///
/// Two sheets follow each other where all cells on the one side of the first meet the second across their facets, and all on that side of the
/// second meet the first. A coarser mesh that drops the nodes between them then fits. Where a block of the body, a side or a named point ends
/// between them they do not: coarser meshes have the same.
struct Layers {
  std::vector<int> stack;        ///< (sheets) the longest list of sheets that follow each other, a number
  std::vector<int> number;       ///< (sheets) in the stack, from 0
  std::vector<signed char> sign; ///< (sheets) 1 where the edges are directed along the stack, else -1
  std::vector<int> length;       ///< (stacks)
  std::vector<int> group;        ///< (sheets) joined ones have the same number
  std::vector<double> begin;     ///< (sheets) part of the group's thickness at which the sheet begins, along the stack
  std::vector<double> end;       ///< (sheets) and at which it ends
  bool coarser = false;          ///< whether any are joined
};

/// Joins two sheets each, of an odd number the last three, in the stacks in which cells are thinnest, up to 1.7 times the least thickness of those
/// that they cross and that have more than one sheet. So anisotropic cells become square ones first. Not where the body is one cell thick and no
/// thicker than 1.7 times the cells' length: a coarser mesh would be too stiff when it bends.
/// @param facets  of the mesh's cells
Layers layers_of(const MeshData &mesh, const Entities &facets, const Sheets &sheets);

} // namespace rpc::mesh
