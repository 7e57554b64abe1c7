// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Kokkos_Core.hpp>

/// Mathematical functions and limits for kernels, under one name for all versions of Kokkos.
namespace rpc::math
{

#if KOKKOS_VERSION >= 30700 // where they left the namespace Experimental
using Kokkos::acos;
using Kokkos::cos;
using Kokkos::fmax;
using Kokkos::fmin;
using Kokkos::sqrt;
#else
using Kokkos::Experimental::acos;
using Kokkos::Experimental::cos;
using Kokkos::Experimental::fmax;
using Kokkos::Experimental::fmin;
using Kokkos::Experimental::sqrt;
#endif

template <class T>
inline constexpr T infinity = Kokkos::Experimental::infinity<T>::value;
template <class T>
inline constexpr T largest = Kokkos::Experimental::finite_max<T>::value;

/// The larger one; a NaN where one of them is.
KOKKOS_INLINE_FUNCTION double larger(const double a, const double b)
{
  return a > b || a != a ? a : b;
}
KOKKOS_INLINE_FUNCTION double magnitude(const double x)
{
  return x < 0 ? -x : x;
}

} // namespace rpc::math
