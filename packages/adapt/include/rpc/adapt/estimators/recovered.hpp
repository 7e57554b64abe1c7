// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/estimator.hpp"

namespace rpc::adapt
{

/// The error by recovered stresses; collective.                                                 doc/theory.md (10.1)
///
///     eta_T^2 = int_T (s* - s_h) : C^-1 (s* - s_h)                                             recovery                (10.2)
///             + sum over contact facets of T, h / (3 (lambda + 2 mu)) int |s* n + p nu - t|^2  contact_equilibrium     (10.3)
///             + 2 int (xi - p) v+ + p v-                                                       contact_complementarity (10.4)
///             + what it takes to push T out where no contact point sees the foundation         unseen_contact          (10.4b)
///
/// with s* the recovered stress, s_h that of u_h, p the contact pressure and v the penetration between the nodes, t the
/// applied traction and h the facet's length. Yielded parts carry p = xi, open ones p = 0.
ErrorEstimate recovered_estimate(const EstimateInput &of);

} // namespace rpc::adapt
