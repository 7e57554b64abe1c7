#include "rpc/mesh/canonical_order.hpp"

#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>

namespace rpc::mesh
{

CanonicalOrder::CanonicalOrder(const RCP<const Comm> &comm, const HostView<const GO *> &ids, const std::string &what)
    : comm_(comm), owned_(ids.extent(0)), size_(sum_all(*comm, static_cast<GO>(ids.extent(0)))),
      ids_(gathered_by_root(*comm, ids.data(), ids.extent(0)))
{
  on_root(*comm, ExitCode::internal_error, [&] {
    std::vector<bool> seen(size_, false);
    for (const GO id : ids_) {
      RPC_REQUIRE_CODE(id >= 0 && id < size_ && !seen[id], ExitCode::internal_error,
                       "mesh: the " << what << " ids must be each of 0 .. " << size_ - 1 << " once, got " << id
                                    << (id >= 0 && id < size_ ? " twice" : ""));
      seen[id] = true;
    }
  });
}

template <class T>
std::vector<T> CanonicalOrder::gather(const T *values, const int width) const
{
  const std::vector<T> by_rank = gathered_by_root(*comm_, values, owned_ * width);
  std::vector<T> by_id(by_rank.size());
  for (std::size_t n = 0; n < ids_.size(); ++n)
    std::copy_n(by_rank.begin() + n * width, width, by_id.begin() + ids_[n] * width);
  return by_id;
}

template std::vector<double> CanonicalOrder::gather(const double *, int) const;
template std::vector<int> CanonicalOrder::gather(const int *, int) const;
template std::vector<GO> CanonicalOrder::gather(const GO *, int) const;

HostView<GO *> overlap_node_ids(const Mesh &mesh)
{
  if (mesh.comm().getSize() == 1) return mesh.node_id;
  using IdVector = Tpetra::Vector<GO, LO, GO, Node>;
  const auto overlap_nodes = mesh.overlap_nodes();
  IdVector owned(mesh.owned_nodes), overlap(overlap_nodes);
  {
    const auto view = owned.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LO n = 0; n < mesh.num_owned_nodes(); ++n) view(n, 0) = mesh.node_id(n);
  }
  overlap.doImport(owned, Import(mesh.owned_nodes, overlap_nodes), Tpetra::INSERT);
  HostView<GO *> ids("rpc::mesh::overlap_node_ids", mesh.num_local_nodes());
  const auto view = overlap.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO n = 0; n < mesh.num_local_nodes(); ++n) ids(n) = view(n, 0);
  return ids;
}

HostView<GO **> owned_facets(const Mesh &mesh, const Side &side, const HostView<GO *> &overlap_ids)
{
  const auto nodes = to_host(side.facets);
  const auto cell = to_host(side.cell);
  std::vector<LO> owned;
  for (LO f = 0; f < static_cast<LO>(cell.extent(0)); ++f)
    if (cell(f) < mesh.num_owned_cells) owned.push_back(f);
  HostView<GO **> facets("rpc::mesh::owned_facets", owned.size(), mesh.element.num_facet_nodes());
  for (std::size_t f = 0; f < owned.size(); ++f)
    for (std::size_t a = 0; a < facets.extent(1); ++a) facets(f, a) = overlap_ids(nodes(owned[f], a));
  return facets;
}

} // namespace rpc::mesh
