// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/core/vectors.hpp"

#include <type_traits>

/// Products of the rows of nodes that follow each other, on the host, with its vectors.
namespace rpc::row_products
{
#ifdef RPC_HAS_VECTORS

/// Neighbours of one kind, for the loops below.
struct Stencil {
  const LO *offset;
  const double *value;
  LO size;
};

/// Rows as they lie in the matrix: those of a node follow each other and have the same columns, read from the first row.
struct NodeRows {
  const RepeatedRows::LocalMatrix::row_map_type::non_const_value_type *begin; // (rows + 1)
  const LO *column;                                                           // (entries)
  const double *value;                                                        // (entries)
};

template <int Dim>
using Dimension = std::integral_constant<int, Dim>;

/// The rows of nodes of one kind.
/// @param count  of nodes   @param x, y  at the first of the nodes
void multiply_run(Dimension<1>, const Stencil &stencil, LO count, const double *x, double *y);
void multiply_run(Dimension<2>, const Stencil &stencil, LO count, const double *x, double *y);
void multiply_run(Dimension<3>, const Stencil &stencil, LO count, const double *x, double *y);

/// The rows of nodes of no kind.
/// @param x  (columns)   @param y  at the first of the nodes
void multiply_alone(Dimension<1>, const NodeRows &rows, LO first_node, LO count, const double *x, double *y);
void multiply_alone(Dimension<2>, const NodeRows &rows, LO first_node, LO count, const double *x, double *y);
void multiply_alone(Dimension<3>, const NodeRows &rows, LO first_node, LO count, const double *x, double *y);

#endif
} // namespace rpc::row_products
