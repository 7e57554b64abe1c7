// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/elasticity.hpp"

namespace rpc::fem
{

/// Strain energy that the limited accuracy of displacements and coordinates alone may give a body, even in a rigid motion.
///
///     R = sum over cells T of int_T (lambda + 2 mu) sum_a |grad N_a|^2 (delta max_T |u| + 32 eps |grad u| max_T |x|)^2
///
/// delta = 3e-11 is the relative accuracy of solves and eps that of a number. A strain energy or a squared error in the
/// energy norm that is no larger than R says nothing.                                               doc/theory.md (10.9)
/// @param u  (owned dofs) [m], prescribed ones included; collective
/// @return R [J], in 2D per m
double rounding_energy(const Discretization &d, const Materials &materials, const Vector &u);

} // namespace rpc::fem
