#pragma once

#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/core/vectors.hpp"

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

/// The rows of nodes of one kind.
/// @param count  of nodes   @param x, y  at the first of the nodes
template <int Dim>
void multiply_run(const Stencil &stencil, LO count, const double *x, double *y);

/// The rows of nodes of no kind.
/// @param x  (columns)   @param y  at the first of the nodes
template <int Dim>
void multiply_alone(const NodeRows &rows, LO first_node, LO count, const double *x, double *y);

#endif
} // namespace rpc::row_products
