// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/point.hpp"
#include "rpc/fem/discretization.hpp"

#include <vector>

namespace rpc::fem
{

/// Values that nodes have, at points of the body, by the shape functions of the cells in which these lie; see interpolation(). A point outside
/// of the mesh takes those of the point of the mesh that is nearest, by reference coordinates.
class AtPoints
{
public:
  /// Collective. @param points  of the undeformed body [m]; those of rank 0 count
  AtPoints(const Discretization &d, const std::vector<Point> &points);

  /// Collective. @param at_nodes  (owned nodes; columns)
  /// @return (points, columns) on rank 0, no rows elsewhere
  std::vector<std::vector<double>> of(const MultiVector &at_nodes) const;
  /// How far each point lies from that of the mesh which stands for it: (points) on rank 0 [m]. Collective.
  std::vector<double> distances() const;

private:
  const Discretization &d_;
  std::vector<Point> points_;
  RCP<const CrsMatrix> from_nodes_;
};

} // namespace rpc::fem
