#pragma once

#include "rpc/core/tpetra.hpp"

namespace rpc::solver
{

/// A matrix of nodes that acts on each component of the displacement alike: interpolation between meshes, or its transpose.
class NodeInterpolation
{
public:
  /// @param nodes       (owned nodes to x owned nodes from), fill-complete
  /// @param prescribed  (owned dofs to, at least) 1 where the result is to be 0
  /// @param from, to    maps of the unknowns; collective
  NodeInterpolation(RCP<const CrsMatrix> nodes, int dim, DeviceView<char *> prescribed, const RCP<const Map> &from,
                    RCP<const Map> to);

  enum class Write { replace, add };
  /// y <- P x, or y + P x, but where displacements are prescribed, there y is 0 or what it was; collective.
  void apply(const Vector &x, Vector &y, Write how) const;

private:
  RCP<const CrsMatrix> nodes_;
  int dim_;
  DeviceView<char *> prescribed_;
  RCP<const Map> to_;
  RCP<const Import> importer_; // null: the columns are the owned nodes
  RCP<Vector> columns_;
};

} // namespace rpc::solver
