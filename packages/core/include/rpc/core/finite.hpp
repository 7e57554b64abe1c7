// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"
#include "rpc/core/tpetra.hpp"

#include <functional>
#include <string>

/// Where a computation leaves the numbers that can be computed with.
namespace rpc
{

/// The place of the entry that is NaN or infinite, or, if there is none, of the largest one, on all ranks the same:
/// "inf in direction Y of the node at (0.5, 1)"; collective.
/// @param v            (owned nodes * dim) unknown c of node n is dim n + c
/// @param coordinates  (owned nodes; dim) [m]
std::string find_not_finite(const Vector &v, const MultiVector &coordinates);

/// "a number that is not finite appeared first in <what>: <place>", with find_not_finite's place; collective.
std::string describe_not_finite(const std::string &what, const Vector &v, const MultiVector &coordinates);

/// Costs a norm as long as all is well; collective. A norm overflows with numbers beyond 1e154, with which nothing
/// sensible can be computed either.
/// @param what         where the numbers are, for the message
/// @param coordinates  as above, made only when needed
/// @throws rpc::Error (bad_input) on every rank if |v|_2 is not finite
void require_finite(const Vector &v, const std::string &what, const std::function<RCP<MultiVector>()> &coordinates);

/// The same for a matrix and its Frobenius norm; the place is that of the row.
void require_finite(const CrsMatrix &A, const std::string &what, const std::function<RCP<MultiVector>()> &coordinates);

/// Whether the sum of the squares of a matrix's entries stays finite for sure, as far as these rows tell: none is more than its share.
/// @param num_entries  of the whole matrix, at least
bool squares_are_finite(const CrsMatrix::local_matrix_device_type &rows, double num_entries);

} // namespace rpc
