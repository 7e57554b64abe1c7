// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "equilibration.hpp"
#include "facet_exchange.hpp"

namespace rpc::bound
{

/// Additive Schwarz on tractions that are in balance on each cell without loads: those on the spokes of a star. They are one force and
/// moment that all its spokes hand on, and on each spoke tractions without force and moment.                 doc/bounds.md (13.9)
class StarSolves
{
public:
  /// Factors the energy of each kind of stars: cells of the same kinds in the same places.
  StarSolves(const CellInput &in, const BoundaryTractions &boundary, const CellForms &forms,
             const FacetExchange &exchange);
  /// z <- sum over the stars of the minimizers of their energy for the derivative g.
  /// Collective.
  void apply(const Tractions &g, const Tractions &z) const;

private:
  CellInput in_;
  BoundaryTractions boundary_;
  const FacetExchange &exchange_;
  DeviceView<int *> kind_;          // (nodes)
  DeviceView<std::size_t *> first_; // (kinds) where its factor begins
  DeviceView<double *> factor_;     // rows of lower triangles
  DeviceView<double *> answer_;     // (3 nodes + modes of spokes)
};

} // namespace rpc::bound
