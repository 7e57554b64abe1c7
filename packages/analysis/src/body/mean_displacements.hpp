// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/problem.hpp"

#include <array>
#include <vector>

namespace rpc::analysis
{

/// Mean displacements of the places that the conditions of `Dirichlet` hold, in all components, free ones too: over the area of a side, of points over
/// the points.
class MeanDisplacements
{
public:
  /// Collective.
  explicit MeanDisplacements(const Problem &problem);
  /// @param u  (owned dofs) [m]
  /// @return of each condition [m]; collective
  std::vector<std::array<double, 3>> operator()(const Vector &u) const;

private:
  struct Place {
    std::vector<LO> nodes; // of this rank
    std::vector<double> weights;
  };
  const Comm &comm_;
  int dim_;
  std::vector<Place> places_; // of each condition
};

} // namespace rpc::analysis
