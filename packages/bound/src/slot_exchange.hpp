// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/exchange.hpp"
#include "rpc/fem/discretization.hpp"

#include <optional>
#include <vector>

namespace rpc::bound
{

/// Rows of numbers that belong to slots of facets, such as their edges or ends. A slot belongs to the rank of one node of its facet, which has
/// all cells around that; other ranks that have the facet get its numbers from there.
class SlotExchange
{
public:
  /// Collective.
  /// @param node  (facets, nodes of one) vertices first, in an order that all ranks agree on
  /// @param node_of  (slots) the node whose rank has the numbers
  SlotExchange(const mesh::Mesh &mesh, const DeviceView<LO **> &node, const std::vector<int> &node_of);

  /// Where the numbers of slots are, for kernels.
  struct Rows {
    DeviceView<LO **> of; ///< (facets, slots) -1: this rank's own; empty: all are
    KOKKOS_INLINE_FUNCTION LO operator()(const LO facet, const int slot) const
    {
      return of.extent(0) > 0 ? of(facet, slot) : -1;
    }
  };
  const Rows &rows() const { return rows_; }
  bool on_one_rank() const { return !exchange_; } ///< then there is nothing to fetch
  /// (served, 2) facet and slot of this rank's numbers that others ask for.
  const DeviceView<LO *[2]> &served() const { return served_; }
  /// (rows(), width) Collective. @param values  (served, width)
  DeviceView<double **> fetched(const DeviceView<double **> &values) const;

private:
  RCP<const Comm> comm_;
  Rows rows_;
  DeviceView<LO *[2]> served_;
  std::optional<Exchange> exchange_; ///< of rows that this rank asks for; none on one rank
};

} // namespace rpc::bound
