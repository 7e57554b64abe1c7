// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "space_cells.hpp"

namespace rpc::bound
{

/// Additive Schwarz in space, on tractions that are in balance on each cell without loads: those on the facets of a ring. They are one force and
/// moment that all its facets hand on, and on each facet tractions without force and moment.               doc/bounds.md (13.9)
class RingSolves
{
public:
  /// Inverts the energy of each kind of rings: cells of the same kinds in the same places.
  /// @param exchanges  live longer
  RingSolves(const SpaceInput &in, const BoundaryTractions &boundary, const SpaceForms &forms,
             const SpaceExchanges &exchanges);
  /// z <- sum over the rings of what least energy answers to the derivative g with. Collective.
  /// @param g  right on facets that are whole
  void apply(const Tractions &g, const Tractions &z) const;
  int num_kinds() const { return static_cast<int>(first_.extent(0)); }

private:
  template <int K>
  void apply_of_order(const Tractions &g, const Tractions &z) const;

  SpaceInput in_;
  const SpaceExchanges &exchanges_;
  DeviceView<unsigned char *> free_; // (facets) which components are free, and what the facet can hand on
  DeviceView<int *> kind_;           // (rings)
  DeviceView<std::size_t *> first_;  // (kinds) where its inverse begins
  DeviceView<float *> inverse_;      // it only steers the descent
  DeviceView<float *> answer_;       // (6 rings + modes of facets)
  DeviceView<float **> shares_;      // (facets, numbers of a share)
};

} // namespace rpc::bound
