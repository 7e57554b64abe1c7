// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/krylov_space.hpp"

#include "rpc/algebra/several_vectors.hpp"

#include <Teuchos_LAPACK.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <cmath>
#include <utility>

namespace rpc::solver
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

/// The rows of some nodes, side by side.
Vector rows_at(const UpdatedOperator &H, const RCP<const Map> &at_nodes, const Vector &x)
{
  Vector rows(at_nodes);
  const int dim = H.dofs_per_node();
  const auto nodes = H.nodes();
  const auto from = device_read(x);
  const auto to = device_write(rows);
  Kokkos::parallel_for(
      "rpc::solver::rows_at", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO n) {
        for (int k = 0; k < dim; ++k) to(dof(dim, n, k)) = from(dof(dim, nodes(n), k));
      });
  Kokkos::fence();
  return rows;
}

/// These rows of x <- rows.
void set_rows(const UpdatedOperator &H, const Vector &rows, Vector &x)
{
  const int dim = H.dofs_per_node();
  const auto nodes = H.nodes();
  const auto from = device_read(rows);
  const auto to = device_write(x);
  Kokkos::parallel_for(
      "rpc::solver::set_rows", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO n) {
        for (int k = 0; k < dim; ++k) to(dof(dim, nodes(n), k)) = from(dof(dim, n, k));
      });
  Kokkos::fence();
}

std::vector<RCP<const Vector>> readable(const std::vector<RCP<Vector>> &vectors)
{
  return {vectors.begin(), vectors.end()};
}

/// The y with A y = b, A symmetric and positive definite, by its lower triangle. Where rounding has made a leading part of A indefinite y is
/// 0 from there on.
std::vector<double> solution_of(const std::vector<std::vector<double>> &A, const std::vector<double> &b)
{
  const int n = static_cast<int>(b.size());
  std::vector<double> scale(n), factor(static_cast<std::size_t>(n) * n), y(n);
  for (int i = 0; i < n; ++i) scale[i] = A[i][i] > 0 ? 1 / std::sqrt(A[i][i]) : 0;
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) factor[static_cast<std::size_t>(j) * n + i] = A[i][j] * scale[i] * scale[j];
    y[j] = b[j] * scale[j];
  }
  const Teuchos::LAPACK<int, double> lapack;
  int info = 0;
  lapack.POTRF('L', n, factor.data(), n, &info);
  const int used = info > 0 ? info - 1 : n;
  if (used > 0) lapack.POTRS('L', used, 1, factor.data(), n, y.data(), n, &info);
  for (int j = 0; j < n; ++j) y[j] = j < used ? y[j] * scale[j] : 0;
  return y;
}

} // namespace

KrylovSpace::KrylovSpace(RCP<const UpdatedOperator> H) : H_(std::move(H)), revision_(H_->revision())
{
  const auto of_rank = H_->nodes().extent(0) * static_cast<std::size_t>(H_->dofs_per_node());
  at_nodes_ =
      rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), of_rank, 0, H_->getDomainMap()->getComm()));
}

bool KrylovSpace::extend(const Operator &B, const Vector &F)
{
  const auto z = rcp(new Vector(F.getMap())), w = rcp(new Vector(F.getMap()));
  B.apply(F, *z);
  const double size = z->norm2();
  if (!(size > 0) || !std::isfinite(size)) return false;
  z->scale(1 / size);
  H_->base().apply(*z, *w);
  K_rows_.push_back(rcp(new Vector(rows_at(*H_, at_nodes_, *w))));
  set_rows(*H_, Vector(at_nodes_), *w);
  z_.push_back(z);
  elsewhere_.push_back(w);
  products_.push_back(dots(readable(elsewhere_), *w));
  return true;
}

/// Brings the rows of the nodes to the present H.
void KrylovSpace::follow()
{
  if (revision_ != H_->revision()) {
    H_rows_.clear();
    at_products_.clear();
    revision_ = H_->revision();
  }
  for (std::size_t j = H_rows_.size(); j < z_.size(); ++j) {
    const auto rows = rcp(new Vector(*K_rows_[j], Teuchos::Copy));
    H_->add_update_at_nodes(*z_[j], *rows);
    H_rows_.push_back(rows);
    at_products_.push_back(dots(readable(H_rows_), *rows));
  }
}

/// @param rows  of F, those of H's nodes   @return what each vector of the space is taken times
std::vector<double> KrylovSpace::least(const Vector &F, const Vector &rows)
{
  follow();
  auto slope = dots(readable(elsewhere_), F);
  const auto slope_at = dots(readable(H_rows_), rows);
  auto products = products_;
  for (std::size_t j = 0; j < slope.size(); ++j) {
    slope[j] = -slope[j] - slope_at[j];
    for (std::size_t i = 0; i <= j; ++i) products[j][i] += at_products_[j][i];
  }
  return solution_of(products, slope);
}

void KrylovSpace::find_least(const Vector &F, Vector &d)
{
  add_combination(least(F, rows_at(*H_, at_nodes_, F)), readable(z_), 0, d);
}

double KrylovSpace::minimize(Vector &d, Vector &F)
{
  Vector rows = rows_at(*H_, at_nodes_, F);
  const auto y = least(F, rows);
  add_combination(y, readable(z_), 0, d);
  add_combination(y, readable(elsewhere_), 1, F);
  add_combination(y, readable(H_rows_), 1, rows);
  set_rows(*H_, rows, F);
  return F.norm2();
}

} // namespace rpc::solver
