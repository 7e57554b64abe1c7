// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/node_interpolation.hpp"

#include "rpc/core/dofs.hpp"

#include <Tpetra_RowMatrixTransposer.hpp>
#include <utility>

namespace rpc::solver
{
namespace
{

using LocalMatrix = NodeInterpolation::LocalMatrix;

template <int Dim, class In, class Out>
struct Interpolate {
  LocalMatrix nodes;             // (nodes, columns)          in
  DeviceView<char *> prescribed; // (dofs, at least) or none  in
  In x;                          // (Dim * columns)           in
  bool add;                      //
  Out y;                         // (dofs)                    inout

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
      if (prescribed.extent(0) > 0 && prescribed(i)) sum[k] = 0;
      y(i) = add ? y(i) + sum[k] : sum[k];
    }
  }
};

/// @param prescribed  none: results are 0 nowhere
void interpolate(const LocalMatrix &nodes, const int dim, const DeviceView<char *> &prescribed, const Vector &x,
                 const bool add, Vector &y)
{
  const auto from = device_read(x);
  const auto to = device_write(y);
  using In = std::decay_t<decltype(from)>;
  using Out = std::decay_t<decltype(to)>;
  const auto range = device_range(nodes.numRows());
  if (dim == 2)
    Kokkos::parallel_for("rpc::solver::interpolate", range, Interpolate<2, In, Out>{nodes, prescribed, from, add, to});
  else
    Kokkos::parallel_for("rpc::solver::interpolate", range, Interpolate<3, In, Out>{nodes, prescribed, from, add, to});
}

/// x <- 0 where displacements are prescribed.
void clear_prescribed(const DeviceView<char *> &prescribed, Vector &x)
{
  const auto to = device_write(x);
  Kokkos::parallel_for(
      "rpc::solver::clear_prescribed", device_range(static_cast<LO>(to.extent(0))), KOKKOS_LAMBDA(const LO i) {
        if (prescribed(i)) to(i) = 0;
      });
}

} // namespace

NodeInterpolation::NodeInterpolation(const RCP<const CrsMatrix> &nodes, const int dim,
                                     DeviceView<char *> fine_prescribed, DeviceView<char *> coarse_prescribed)
    : nodes_(nodes->getLocalMatrixDevice()),
      transposed_(
          Tpetra::RowMatrixTransposer<double, LO, GO, Node>(nodes).createTransposeLocal()->getLocalMatrixDevice()),
      dim_(dim), fine_prescribed_(std::move(fine_prescribed)), coarse_prescribed_(std::move(coarse_prescribed)),
      halo_(nodes->getGraph()->getImporter(), dim)
{
}

void NodeInterpolation::prolong(const Vector &coarse, Vector &fine, const Write how) const
{
  interpolate(nodes_, dim_, fine_prescribed_, halo_.at_columns(coarse), how == Write::add, fine);
}

void NodeInterpolation::restrict_to(const Vector &fine, Vector &coarse) const
{
  if (halo_.is_empty()) return interpolate(transposed_, dim_, coarse_prescribed_, fine, false, coarse);
  interpolate(transposed_, dim_, {}, fine, false, halo_.columns());
  halo_.sum_at_owners(coarse);
  clear_prescribed(coarse_prescribed_, coarse);
}

} // namespace rpc::solver
