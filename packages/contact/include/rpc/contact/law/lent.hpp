// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/contact/law/states.hpp"
#include "rpc/core/math.hpp"

namespace rpc::contact
{

/// What a point without weight has of its neighbours' pressures and new dents on a foundation that hardens.                 doc/theory.md, 3.4
struct Lent {
  double pressure = 0; ///< [Pa]
  double dent = 0;     ///< new [m]
};

/// A dent where the pressure reaches the yield limit, and no more pressure than the limit with that dent. The dent that the pressure alone
/// would tell, (p - xi)/H, makes much of little where H is small.
/// @param pressure, dent  that the neighbours' make at the point
KOKKOS_INLINE_FUNCTION Lent lent(const double pressure, const double dent, const Foundation &f)
{
  const double made = pressure >= f.yield && dent > 0 ? dent : 0;
  return {math::fmin(pressure, f.yield + f.hardening * made), made};
}

/// How deep a point without weight is pressed in, as the pressure and the dent that it is lent tell [m].                     (3.5b)
/// @param v  where its displacement has it [m]
KOKKOS_INLINE_FUNCTION double lent_penetration(const double v, const double dent, const double p, const Foundation &f)
{
  if (p > 0) return dent + resting_penetration(p, f);
  return math::fmin(v, dent);
}

} // namespace rpc::contact
