// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc
{

/// Products of one vector with several others, read eight at a time: what Gram-Schmidt's orthogonalization takes. Each of them is bound by
/// memory; products of tall matrices in BLAS and Kokkos Kernels are made for other shapes. All vectors are on one map.

/// x_j . y for all j; collective, one sum over all ranks.
std::vector<double> dots(const std::vector<RCP<const Vector>> &x, const Vector &y);

/// y <- beta y + sum_j a_j x_j. What y holds is not read where beta is 0. Fences.
/// @param a  as many as x   @param x  none of them is y
void add_combination(const std::vector<double> &a, const std::vector<RCP<const Vector>> &x, double beta, Vector &y);

} // namespace rpc
