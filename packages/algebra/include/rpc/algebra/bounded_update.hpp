// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"

#include <limits>

namespace rpc
{

/// What preconditioners take for the update: the symmetric part S of each block, bounded by the node's own stiffness.
///
///     S = sum_k mu_k e_k e_k^T  ->  sum_k clamp(mu_k, 0, most e_k.K_ii e_k) e_k e_k^T               doc/theory.md (4.7b)
///
/// For U = a w m m^T with a unit vector m it bounds a by `most` times own_stiffness(). Without a bound it is S.
/// @return (nodes, dim, dim)
DeviceView<double ***> bounded_update(const UpdatedOperator &H, double most = std::numeric_limits<double>::infinity());

/// The own blocks of H's nodes become those of K with an update.
/// @param[in,out] A  with K's graph   @param update  (nodes, dim, dim)
void write_update(CrsMatrix &A, const UpdatedOperator &H, const DeviceView<double ***> &update);

} // namespace rpc
