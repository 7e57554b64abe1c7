// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"
#include "rpc/mesh/mesh.hpp"

#include <functional>
#include <string>
#include <vector>

namespace rpc::mesh
{

/// Takes data of entities that each have one owner to rank 0, ordered by their rank-independent id, and back.
///
/// One piece of the ids travels at a time, so that rank 0 holds at most one piece of other ranks' values.
class CanonicalOrder
{
public:
  /// @param ids   (owned) 0-based; over all ranks each of 0 .. n-1 once
  /// @param what  for the message, "node"
  /// @throws rpc::Error (internal_error) on every rank if they are not; collective on comm
  CanonicalOrder(const RCP<const Comm> &comm, const Ids &ids, const std::string &what);

  GO size() const { return size_; } ///< n, over all ranks

  /// Calls `take` on rank 0 for one piece after another; collective.
  /// @param values  (owned, width), row by row, in the order of ids; T is double, int or GO
  /// @param take    gets the first id of a piece, and (ids of the piece, width) row by row, ordered by id
  /// @throws rpc::Error on every rank if `take` throws, as on_root() does
  template <class T>
  void in_pieces(const T *values, int width,
                 const std::function<void(GO first, const std::vector<T> &piece)> &take) const;
  /// The other way round: rank 0 is asked for one piece after another; collective.
  /// @param give    is told the first id of a piece and how many it has
  /// @param values  (owned) in the order of ids, out
  /// @throws rpc::Error on every rank if `give` throws, as on_root() does
  void from_pieces(const std::function<std::vector<double>(GO first, GO count)> &give, double *values) const;
  /// All pieces: for what rank 0 needs as a whole.
  /// @return rank 0: (n, width), row by row, ordered by id; empty elsewhere. Collective
  template <class T>
  std::vector<T> gather(const T *values, int width = 1) const;

private:
  GO num_pieces() const;
  /// This rank's ids in a piece, seen from the piece's first id.
  Teuchos::ArrayView<const int> places_in(GO piece) const
  {
    return {places_.data() + piece_[piece], piece_[piece + 1] - piece_[piece]};
  }

  RCP<const Comm> comm_;
  GO size_ = 0;
  std::vector<LO> owned_;       // by pieces
  std::vector<int> places_;     // of owned_, each in its piece
  std::vector<LO> piece_;       // (pieces + 1) where each begins in owned_
  std::vector<LO> piece_sizes_; // (ranks, pieces) of all ranks; rank 0 only
};

/// Rank-independent id of every local node: (overlap nodes) 0-based. Collective.
HostView<GO *> overlap_node_ids(const Mesh &mesh);

/// Facets of a side whose cell this rank owns, as rank-independent node ids: (facets, facet nodes).
/// Over all ranks each facet of the side appears once, but for those of a periodic box that end in images of nodes.
/// @param overlap_ids  see overlap_node_ids()
HostView<GO **> owned_facets(const Mesh &mesh, const Side &side, const HostView<GO *> &overlap_ids);

} // namespace rpc::mesh
