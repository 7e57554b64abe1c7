// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/halo.hpp"

namespace rpc::solver
{

/// Interpolation P from a coarse mesh to a fine one that acts on each component of the displacement alike, and its transpose. The transpose
/// needs no rows of other ranks: each rank sums over its own fine nodes, and the sums meet at the owners of the coarse nodes.
class NodeInterpolation
{
public:
  using LocalMatrix = CrsMatrix::local_matrix_device_type;

  /// @param nodes  P (owned fine nodes x owned coarse nodes), fill-complete
  /// @param dim    unknowns of a node
  /// @param fine_prescribed, coarse_prescribed  (owned dofs, at least) 1 where results are to be 0; collective
  NodeInterpolation(const RCP<const CrsMatrix> &nodes, int dim, DeviceView<char *> fine_prescribed,
                    DeviceView<char *> coarse_prescribed);

  enum class Write { replace, add };
  /// fine <- P coarse, or fine + P coarse, but where displacements are prescribed, there it is 0 or what it was; collective.
  void prolong(const Vector &coarse, Vector &fine, Write how) const;
  /// coarse <- P^T fine, 0 where displacements are prescribed; collective.
  void restrict_to(const Vector &fine, Vector &coarse) const;

private:
  LocalMatrix nodes_, transposed_; // rows and columns of this rank
  int dim_;
  DeviceView<char *> fine_prescribed_, coarse_prescribed_;
  Halo halo_; // of the coarse nodes
};

} // namespace rpc::solver
