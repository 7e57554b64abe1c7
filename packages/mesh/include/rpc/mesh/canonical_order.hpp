#pragma once

#include "rpc/core/tpetra.hpp"
#include "rpc/mesh/mesh.hpp"

#include <string>
#include <vector>

namespace rpc::mesh
{

/// Collects data of entities that each have one owner on rank 0, ordered by their rank-independent id.
///
/// The ids travel once; then one field at a time.
class CanonicalOrder
{
public:
  /// @param ids   (owned) 0-based; over all ranks each of 0 .. n-1 once
  /// @param what  for the message, "node"
  /// @throws rpc::Error (internal_error) on every rank if they are not; collective on comm
  CanonicalOrder(const RCP<const Comm> &comm, const HostView<const GO *> &ids, const std::string &what);

  GO size() const { return size_; } ///< n, over all ranks

  /// @param values  (owned, width), row by row, in the order of ids; T is double, int or GO
  /// @return rank 0: (n, width), row by row, ordered by id; empty elsewhere. Collective
  template <class T>
  std::vector<T> gather(const T *values, int width = 1) const;

private:
  RCP<const Comm> comm_;
  std::size_t owned_ = 0;
  GO size_ = 0;
  std::vector<GO> ids_; // of all ranks; rank 0 only
};

/// Rank-independent id of every local node: (overlap nodes) 0-based. Collective.
HostView<GO *> overlap_node_ids(const Mesh &mesh);

/// Facets of a side whose cell this rank owns, as rank-independent node ids: (facets, facet nodes).
/// Over all ranks each facet of the side appears once.
/// @param overlap_ids  see overlap_node_ids()
HostView<GO **> owned_facets(const Mesh &mesh, const Side &side, const HostView<GO *> &overlap_ids);

} // namespace rpc::mesh
