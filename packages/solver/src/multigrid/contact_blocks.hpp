// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multigrid/contact_supports.hpp"
#include "rpc/algebra/repeated_rows.hpp"

namespace rpc::solver
{

/// Where contact adds to a coarse mesh's matrix: its blocks, by rows, and what each contact node contributes to them. Of this rank, on
/// the host.
struct ContactBlocks {
  std::vector<LO> nodes;             ///< owned ones around the contact nodes, ascending
  std::vector<LO> row, column;       ///< (blocks) owned node; column's node
  std::vector<LO> place;             ///< (blocks) which one of its node's blocks it is
  std::vector<double> base;          ///< (blocks * dim * dim) the matrix as it is
  std::vector<std::size_t> own;      ///< (nodes) their blocks on the diagonal
  std::vector<std::size_t> begin{0}; ///< (blocks + 1) where a block's parts begin
  std::vector<int> contact;          ///< (parts) near contact node, ascending in each block
  std::vector<double> coefficient;   ///< (parts) product of the weights at both nodes
  std::size_t bounded = 0;           ///< couplings that the matrix has no room for
};

/// Couplings of nodes that share no cell of the mesh become their bound on the diagonal, 2 a b <= a^2 + b^2.
/// @param A  the matrix   @param rows, columns  its maps
ContactBlocks contact_blocks(const NearSupports &supports, const RepeatedRows &A, const Map &rows, const Map &columns);

} // namespace rpc::solver
