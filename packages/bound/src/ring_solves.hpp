// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "space_cells.hpp"

#include <utility>

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
  /// shares += a times what a derivative g has of each facet for its rings; g is right on facets that are whole, in single or double precision.
  /// @param[in,out] shares  of g's size
  template <class Derivative>
  void add_shares(double a, const Derivative &g, const DeviceView<float *> &shares) const;
  /// Finds what least energy answers to a derivative with, ring by ring; combine() reads it.
  /// @return the work of this rank's answers with the derivative
  double solve(const DeviceView<float *> &shares) const;
  /// d <- a d + b z with the sum z of the answers. Collective.
  void combine(double a, const Tractions &d, double b) const;
  /// z <- the sum of the answers to g. Collective.
  void apply(const Tractions &g, const Tractions &z) const;
  /// (tractions) Memory that is free from combine() on to the next solve().
  DeviceView<float *> work_space() const { return Kokkos::subview(answer_, std::make_pair(std::size_t(0), size_)); }
  int num_kinds() const { return static_cast<int>(first_.extent(0)); }

private:
  template <class Function>
  void for_order(const Function &f) const; // of the elements, as a constant

  SpaceInput in_;
  const SpaceExchanges &exchanges_;
  DeviceView<unsigned char *> free_; // (facets) which components are free, and what the facet can hand on
  DeviceView<int *> kind_;           // (rings)
  DeviceView<std::size_t *> first_;  // (kinds) where its inverse begins
  DeviceView<float *> inverse_;      // it only steers the descent
  DeviceView<float *> answer_;       // (6 rings + modes of facets)
  DeviceView<float *> large_;        // as answer_, where a ring has many facets; else empty
  bool lower_ = false;               // whether inverses are the rows of lower triangles
  std::size_t size_ = 0;             // of tractions
};

} // namespace rpc::bound
