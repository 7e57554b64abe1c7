// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/friction.hpp"
#include "rpc/core/kokkos.hpp"

namespace rpc::contact
{

/// Friction at the contact points of this rank. A point whose displacement along the side is prescribed altogether, or whose normal
/// displacement is, has none: Dirichlet conditions hold it.
struct FrictionPoints {
  DeviceView<double *> coefficient; ///< (points) mu
  DeviceView<double *> bound;       ///< (points) s_0 [Pa]
  DeviceView<double *> limit;       ///< (points) s_max [Pa]
  DeviceView<double **> from;       ///< (points, dim) displacement along the side that slip counts from [m]
  DeviceView<char **> free;         ///< (points, dim) 0 where the displacement is prescribed
  bool anywhere = false;            ///< on any rank

  /// Whether this rank's points have friction, for kernels.
  KOKKOS_INLINE_FUNCTION bool exists() const { return coefficient.extent(0) > 0; }
  KOKKOS_INLINE_FUNCTION Friction operator()(const LO i) const { return {coefficient(i), bound(i), limit(i)}; }
};

} // namespace rpc::contact
