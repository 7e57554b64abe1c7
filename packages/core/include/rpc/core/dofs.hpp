// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

/// How unknowns (degrees of freedom, dofs) are numbered: `dim` per node, those of one node next to each other.
///
/// The same formula holds in every numbering: owned and overlap local ids, global ids, and the nodes of one cell. Nothing
/// else in the program computes the number of an unknown.
namespace rpc
{

/// Number of unknowns of `num_nodes` nodes.
template <class Ordinal>
KOKKOS_INLINE_FUNCTION constexpr Ordinal num_dofs(const int dim, const Ordinal num_nodes)
{
  return dim * num_nodes;
}

/// The unknown for one component of the displacement of a node.
/// @param component  0 to dim - 1
template <class Ordinal>
KOKKOS_INLINE_FUNCTION constexpr Ordinal dof(const int dim, const Ordinal node, const int component)
{
  return dim * node + component;
}

/// The node that an unknown belongs to.
template <class Ordinal>
KOKKOS_INLINE_FUNCTION constexpr Ordinal node_of(const int dim, const Ordinal dof)
{
  return dof / dim;
}

/// The component that an unknown stands for, 0 to dim - 1.
template <class Ordinal>
KOKKOS_INLINE_FUNCTION constexpr int component_of(const int dim, const Ordinal dof)
{
  return static_cast<int>(dof % dim);
}

} // namespace rpc
