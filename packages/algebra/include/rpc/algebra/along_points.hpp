// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/node_points.hpp"
#include "rpc/algebra/stiffness_operator.hpp"

namespace rpc
{

/// (points) m . K_ii m / (w m . m) with the own block of the point's node: the stiffness of the node alone. 0 where the
/// direction m is 0.
DeviceView<double *> own_stiffness(const StiffnessOperator &K, const NodePoints &points);

/// (points) kappa_i = sum_j |m_i| . |K_ij| |m_j| / (|m_i|^3 |m_j|) over all points j, with absolute values entry by entry:
/// the energy of moves s_i m_i/|m_i|^2 of all points at once is at most sum_i kappa_i s_i^2/2. Collective.        (4.6)
DeviceView<double *> coupled_stiffness(const StiffnessOperator &K, const NodePoints &points);

} // namespace rpc
