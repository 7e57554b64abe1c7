// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "facets.hpp"
#include "slot_exchange.hpp"

#include <vector>

namespace rpc::bound
{

/// Brings numbers that belong to the end of a facet at a vertex which another rank owns: this one does not have all cells around it. Of a
/// facet with both vertices elsewhere it may not have both cells, and so not the order of its ends: on the way a facet runs to its higher gid.
class FacetExchange
{
public:
  /// Collective.
  FacetExchange(const fem::Discretization &d, const Facets &facets);

  /// (facets, 2) which of fetch()'s rows belongs to an end; -1: its vertex is this rank's.
  const DeviceView<LO *[2]> &row() const { return row_; }
  /// (rows, width) Collective. @param values  (facets, 2 ends, width) of ends at owned vertices
  /// @param flip  factors of the entries where the facet runs the other way on the other rank
  DeviceView<double **> fetch(const DeviceView<double ***> &values, const std::vector<double> &flip) const;

private:
  std::vector<char> falls_; // (facets) it begins at its higher gid
  SlotExchange ends_;       // of facets that begin at their lower gid
  DeviceView<LO *[2]> row_;
};

} // namespace rpc::bound
