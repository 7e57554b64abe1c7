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
  /// Factors the energies of all stars.
  StarSolves(const CellInput &in, const BoundaryTractions &boundary, const CellForms &forms,
             const FacetExchange &exchange);
  /// z <- sum over the stars of the minimizers of their energy for the derivative g.
  /// Collective.
  void apply(const Tractions &g, const Tractions &z) const;

private:
  CellInput in_;
  BoundaryTractions boundary_;
  const FacetExchange &exchange_;
  DeviceView<std::size_t *> first_; // (nodes + 1) where the factor of a star begins
  DeviceView<double *> factor_;     // row by row
  DeviceView<double *> answer_;     // (3 nodes + modes of spokes)
};

} // namespace rpc::bound
