// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/convex_functional.hpp"
#include "rpc/contact/smoothed_points.hpp"

#include <memory>
#include <vector>

namespace rpc::contact
{

/// The functional along a line t -> u + t d: piecewise quadratic.                                       doc/theory.md (4.3)
///
///     slope(t) = slope(0) + curvature t + sum_i (f_i(u + t d) - f_i(u)) . d_i
///
/// with f_i the force of point i. The difference form keeps its digits when slope(0) is small against its parts.
/// @param slope_at_0, elastic_curvature  d . F and d . K d [J]
std::unique_ptr<LineFunction> line_model(RCP<const Comm> comm, double slope_at_0, double elastic_curvature,
                                         const SmoothedPoints &points, const Vector &u, const Vector &d);

/// The functional on u + sum_k a_k d_k: piecewise quadratic.                                             doc/theory.md (4.4a)
///
///     gradient_k(a) = gradient_k(0) + sum_l A_kl a_l + sum_i (f_i(u + sum_l a_l d_l) - f_i(u)) . d_ik
///
/// with A_kl = d_k . K d_l, in the difference form of line_model().
/// @param at_0     (directions) gradient [J]
/// @param elastic  (directions x directions) A [J]
std::unique_ptr<SubspaceFunction> subspace_model(RCP<const Comm> comm, std::vector<double> at_0,
                                                 std::vector<double> elastic, const SmoothedPoints &points,
                                                 const Vector &u, const std::vector<RCP<const Vector>> &directions);

} // namespace rpc::contact
