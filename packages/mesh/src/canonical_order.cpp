#include "rpc/mesh/canonical_order.hpp"

#include "rpc/core/exchange.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <numeric>

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

/// The owners of the ghosts are asked.
HostView<GO *> overlap_node_ids(const Mesh &mesh)
{
  if (mesh.comm().getSize() == 1) return mesh.node_id;
  const LO num_owned = mesh.num_owned_nodes();
  HostView<GO *> ids("rpc::mesh::overlap_node_ids", mesh.num_local_nodes());
  for (LO n = 0; n < num_owned; ++n) ids(n) = mesh.node_id(n);
  const auto size = static_cast<Teuchos_Ordinal>(mesh.ghosts.size());
  std::vector<int> rank(size), node(size), order(size), counts(mesh.comm().getSize());
  mesh.owned_nodes->getRemoteIndexList(Teuchos::ArrayView<const GO>(mesh.ghosts.data(), size),
                                       Teuchos::ArrayView<int>(rank.data(), size),
                                       Teuchos::ArrayView<int>(node.data(), size));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](const int a, const int b) { return rank[a] < rank[b]; });
  std::vector<double> questions, answers; // doubles hold ids exactly
  for (const int ghost : order) {
    ++counts[rank[ghost]];
    questions.push_back(node[ghost]);
  }
  const Exchange exchange(mesh.comm(), counts);
  for (const double lid : exchange.forward(questions, 1))
    answers.push_back(static_cast<double>(mesh.node_id(static_cast<LO>(lid))));
  const std::vector<double> got = exchange.back(answers, 1);
  for (std::size_t k = 0; k < order.size(); ++k) ids(num_owned + order[k]) = static_cast<GO>(got[k]);
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
