#include "node_interpolation.hpp"

#include "rpc/core/dofs.hpp"

#include <Teuchos_Array.hpp>
#include <utility>

namespace rpc::solver
{
namespace
{

template <int Dim, class Matrix, class In, class Out>
struct Interpolate {
  Matrix nodes;                  // (owned nodes, columns)    in
  DeviceView<char *> prescribed; // (owned dofs, at least)    in
  In x;                          // (Dim * columns)           in
  bool add;                      //
  Out y;                         // (owned dofs)              inout

  KOKKOS_FUNCTION void operator()(const LO node) const
  {
    double sum[Dim] = {};
    for (auto e = nodes.graph.row_map(node); e < nodes.graph.row_map(node + 1); ++e) {
      const LO column = nodes.graph.entries(e);
      const double weight = nodes.values(e);
      for (int k = 0; k < Dim; ++k) sum[k] += weight * x(dof(Dim, column, k));
    }
    for (int k = 0; k < Dim; ++k) {
      const LO i = dof(Dim, node, k);
      if (prescribed(i)) sum[k] = 0;
      y(i) = add ? y(i) + sum[k] : sum[k];
    }
  }
};

/// The map of the unknowns at the nodes of a map.
RCP<const Map> dofs_of(const Map &nodes, const int dim)
{
  Teuchos::Array<GO> gids;
  gids.reserve(static_cast<Teuchos_Ordinal>(dim) * num_local(nodes));
  for (LO n = 0; n < num_local(nodes); ++n)
    for (int k = 0; k < dim; ++k) gids.push_back(dof(dim, nodes.getGlobalElement(n), k));
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), gids(), 0, nodes.getComm()));
}

} // namespace

NodeInterpolation::NodeInterpolation(RCP<const CrsMatrix> nodes, const int dim, DeviceView<char *> prescribed,
                                     const RCP<const Map> &from, RCP<const Map> to)
    : nodes_(std::move(nodes)), dim_(dim), prescribed_(std::move(prescribed)), to_(std::move(to))
{
  if (nodes_->getColMap()->isSameAs(*nodes_->getDomainMap())) return;
  const auto columns = dofs_of(*nodes_->getColMap(), dim);
  importer_ = rcp(new Import(from, columns));
  columns_ = rcp(new Vector(columns));
}

void NodeInterpolation::apply(const Vector &x, Vector &y, const Write how) const
{
  if (!importer_.is_null()) columns_->doImport(x, *importer_, Tpetra::INSERT);
  const Vector &source = importer_.is_null() ? x : *columns_;
  const auto from = device_read(source);
  const auto to = device_write(y);
  const auto matrix = nodes_->getLocalMatrixDevice();
  using Matrix = std::decay_t<decltype(matrix)>;
  using In = std::decay_t<decltype(from)>;
  using Out = std::decay_t<decltype(to)>;
  const auto range = device_range(matrix.numRows());
  const bool add = how == Write::add;
  if (dim_ == 2)
    Kokkos::parallel_for("rpc::solver::interpolate", range,
                         Interpolate<2, Matrix, In, Out>{matrix, prescribed_, from, add, to});
  else
    Kokkos::parallel_for("rpc::solver::interpolate", range,
                         Interpolate<3, Matrix, In, Out>{matrix, prescribed_, from, add, to});
  Kokkos::fence();
}

} // namespace rpc::solver
