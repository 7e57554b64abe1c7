// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"

namespace rpc::fem
{

/// Values of finite element functions of a mesh at the nodes of one that was refined from it, by the parents of cells: without a search
/// or communication. Functions of the coarse mesh's reference coordinates, of its order or below, are exact in curved cells too.
/// @param coarse   the parents, or the mesh of order 1 on the same cells
/// @param fine     the children, or the mesh of order 1 on the same cells
/// @param parents  of the cells of `fine`
/// @return (fine owned nodes x coarse owned nodes), fill-complete; collective
RCP<CrsMatrix> interpolation_from_parents(const mesh::Mesh &coarse, const mesh::Mesh &fine,
                                          const mesh::Parents &parents);

} // namespace rpc::fem
