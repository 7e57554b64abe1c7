// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/core/math.hpp"

/// The foundation between contact points: its parameters as numbers that interpolate.
namespace rpc::contact
{

/// Number of columns in which a law is interpolated.
constexpr int law_columns = 3;

/// @param most  takes the place of a yield stress above it, which may be infinite [Pa]   @param column  (law_columns) out
template <class Column>
KOKKOS_INLINE_FUNCTION void to_columns(const Foundation &f, const double most, const Column &column)
{
  column(0) = f.yield < most ? f.yield : most;
  column(1) = f.hardening;
  column(2) = f.compliance;
}
/// The columns of a foundation that no pressure up to `most` makes yield.
template <class Column>
KOKKOS_INLINE_FUNCTION void to_columns_of_rigid(const double most, const Column &column)
{
  to_columns(Foundation{most, 0, 0}, most, column);
}

/// The law of interpolated columns; quadratic interpolants may be negative, and count as 0 then.
KOKKOS_INLINE_FUNCTION Foundation from_columns(const double *const column)
{
  return Foundation{math::fmax(0., column[0]), math::fmax(0., column[1]), math::fmax(0., column[2])};
}

/// The pressure at which the foundation begins to give way, at the dents that are there already [Pa].
KOKKOS_INLINE_FUNCTION double yield_limit(const Foundation &f)
{
  return f.yield;
}

} // namespace rpc::contact
