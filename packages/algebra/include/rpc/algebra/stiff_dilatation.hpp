// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

namespace rpc
{

/// What the dilatation adds to a stiffness that is soft in it, cell by cell:
///
///     K = K_0 + Z^T diag(s) Z                                                                    doc/theory.md (4.13)
///
/// A row of Z is one mode of one cell, made orthonormal there: (Z u)_m is the m-th coefficient of div u.
struct StiffDilatation {
  RCP<const CrsMatrix>
      modes; ///< Z, (modes of owned cells x owned dofs), 0 at prescribed unknowns [m^(dim/2 - 1)], of revolution [m^(1/2)]
  /// N, (modes of owned cells x owned nodes): the root of a split cell's volume at each of its vertices [m^(dim/2)], of revolution [m^(3/2)].
  /// Null where pressures that alternate from cell to cell have no equations of their own, (4.15a).
  RCP<const CrsMatrix> at_nodes;
  /// Whether each alternating pressure moves the body, if by little: so it is in P2 tetrahedra; in Q1 some move nothing.
  bool alternating_ones_move = false;
  DeviceView<double *> stiffness;    ///< (modes) s = lambda - lambda_0, 0 in cells whose stiffness is not split [Pa]
  DeviceView<double *> wave_modulus; ///< (modes) lambda_0 + 2 mu, of K_0 for waves that change the volume [Pa]
  DeviceView<double *>
      bulk_modulus; ///< (modes) lambda_0 + 2 mu/dim, the least of K_0 for a change of volume, dim = 3 of revolution [Pa]
};

} // namespace rpc
