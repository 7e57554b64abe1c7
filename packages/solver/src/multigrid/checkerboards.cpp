// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/checkerboards.hpp"

#include "multigrid/chebyshev.hpp"
#include "multigrid/node_smoother.hpp"
#include "rpc/algebra/diagonal_matrix.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/math.hpp"
#include "rpc/solver/mixed_form.hpp"
#include "rpc/solver/rules.hpp"

#include <TpetraExt_MatrixMatrix.hpp>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rpc::solver
{
namespace
{

/// (dofs) diag(K)^(-1/2)
Vector roots_of_softness(const StiffnessOperator &K)
{
  Vector roots(K.getDomainMap());
  const auto blocks = K.diagonal_blocks();
  const int dim = K.dofs_per_node();
  const auto to = device_write(roots);
  LO bad = 0;
  Kokkos::parallel_reduce(
      "rpc::solver::roots_of_softness", device_range(blocks.num_nodes()),
      KOKKOS_LAMBDA(const LO n, LO &count) {
        const LO place = blocks.of(n);
        for (int k = 0; k < dim; ++k) {
          const double own = blocks.block(place, k, k);
          count += own > 0 ? 0 : 1;
          to(dof(dim, n, k)) = own > 0 ? 1 / math::sqrt(own) : 0.;
        }
      },
      bad);
  if (sum_all(*K.getDomainMap()->getComm(), GO(bad)) > 0)
    throw std::runtime_error("mixed form: the diagonal of the matrix is not positive");
  return roots;
}

/// (modes) 1/s, s the wave modulus where the stiffness is not split.
Vector softness(const StiffDilatation &dilatation)
{
  Vector softness(dilatation.modes->getRangeMap());
  const auto to = device_write(softness);
  const auto stiffness = dilatation.stiffness, wave = dilatation.wave_modulus;
  Kokkos::parallel_for(
      "rpc::solver::softness", device_range(static_cast<LO>(softness.getLocalLength())),
      KOKKOS_LAMBDA(const LO m) { to(m) = 1 / (stiffness(m) > 0 ? stiffness(m) : wave(m)); });
  Kokkos::fence();
  return softness;
}

/// Z diag(K_0)^-1 Z^T + diag(1/s). Tpetra leaves rows without entries where Z is 0; the sum has its diagonal.
RCP<CrsMatrix> softness_of_pressures(const StiffDilatation &dilatation, const StiffnessOperator &soft)
{
  CrsMatrix scaled(*dilatation.modes, Teuchos::Copy);
  scaled.rightScale(roots_of_softness(soft));
  CrsMatrix product(scaled.getRangeMap(), 0);
  Tpetra::MatrixMatrix::Multiply(scaled, false, scaled, true, product);
  return Tpetra::MatrixMatrix::add(1., false, product, 1., false, *diagonal_matrix(softness(dilatation)));
}

/// (rows) A_mm^(-1/2)
Vector roots_of_diagonal(const CrsMatrix &A)
{
  Vector roots(A.getRowMap());
  A.getLocalDiagCopy(roots);
  const auto value = device_write(roots);
  Kokkos::parallel_for(
      "rpc::solver::roots_of_diagonal", device_range(num_local(*A.getRowMap())),
      KOKKOS_LAMBDA(const LO m) { value(m) = 1 / math::sqrt(value(m)); });
  Kokkos::fence();
  return roots;
}

/// diag(roots) A diag(roots), in A's place.
RCP<const CrsMatrix> scaled(const RCP<CrsMatrix> &A, const Vector &roots)
{
  A->leftScale(roots);
  A->rightScale(roots);
  return A;
}

/// (nodes) 1 / (nodes of a cell times the volume of the split cells at the node), 0 where there are none.
Vector means_at_nodes(const SharedRows &at_nodes)
{
  const auto &N = at_nodes.matrix();
  const auto local = N.getLocalMatrixDevice();
  Vector root(N.getRangeMap()), weight(N.getDomainMap());
  const auto of_cell = device_write(root);
  Kokkos::parallel_for(
      "rpc::solver::roots_of_volumes", device_range(static_cast<LO>(local.numRows())), KOKKOS_LAMBDA(const LO m) {
        const std::size_t begin = local.graph.row_map(m), end = local.graph.row_map(m + 1);
        of_cell(m) = begin < end ? static_cast<double>(end - begin) * local.values(begin) : 0.;
      });
  Kokkos::fence();
  at_nodes.apply_transposed(root, weight, 0.);
  const auto of_node = device_write(weight);
  Kokkos::parallel_for(
      "rpc::solver::means_at_nodes", device_range(num_local(*N.getDomainMap())),
      KOKKOS_LAMBDA(const LO n) { of_node(n) = of_node(n) > 0 ? 1 / of_node(n) : 0.; });
  Kokkos::fence();
  return weight;
}

/// The least eigenvalue is at least the least 1/s, scaled; collective.
double least_softness(const Vector &scale, const StiffDilatation &dilatation)
{
  const auto root = device_read(scale);
  const auto stiffness = dilatation.stiffness;
  double least = 1;
  Kokkos::parallel_reduce(
      "rpc::solver::least_softness", device_range(static_cast<LO>(scale.getLocalLength())),
      KOKKOS_LAMBDA(const LO m, double &smallest) {
        if (stiffness(m) > 0) smallest = math::fmin(smallest, root(m) * root(m) / stiffness(m));
      },
      Kokkos::Min<double>(least));
  return min_all(*scale.getMap()->getComm(), std::min(least, 1.));
}

} // namespace

Checkerboards::Checkerboards(const StiffDilatation &dilatation, const StiffnessOperator &soft)
    : Checkerboards(dilatation, softness_of_pressures(dilatation, soft))
{
}

Checkerboards::Checkerboards(const StiffDilatation &dilatation, const RCP<CrsMatrix> &A)
    : at_nodes_(dilatation.at_nodes), of_node_(means_at_nodes(at_nodes_)), scale_(roots_of_diagonal(*A)),
      A_(scaled(A, scale_), 1), at_node_(of_node_.getMap()), scaled_(scale_.getMap()), product_(scale_.getMap()),
      move_(scale_.getMap())
{
  largest_ = largest_eigenvalue(*A, [](const Vector &r, Vector &z) { z.assign(r); });
  const double softest = largest_ / least_softness(scale_, dilatation);
  const double of_least_degree = std::pow(linear_rules.least_degree / linear_rules.degree_of_root, 2);
  const double condition = dilatation.alternating_ones_move ? std::min(softest, of_least_degree) : softest;
  const double root = std::sqrt(condition);
  degree_ = degree_for_pressures(condition);
  const double reached = std::min(root, degree_ / linear_rules.degree_of_root);
  smallest_ = largest_ / std::max(reached * reached, 2.);
}

int degree_for_pressures(const double condition)
{
  return std::clamp<int>(static_cast<int>(std::ceil(linear_rules.degree_of_root * std::sqrt(condition))),
                         linear_rules.least_degree, linear_rules.largest_degree);
}

/// y <- (I - F) y
void Checkerboards::without_smooth(Vector &y) const
{
  at_nodes_.apply_transposed(y, at_node_, 0.);
  at_node_.elementWiseMultiply(1., of_node_, at_node_, 0.);
  at_nodes_.apply(at_node_, product_);
  y.update(-1., product_, 1.);
}

void Checkerboards::apply(const Vector &x, Vector &y) const
{
  y.assign(x);
  without_smooth(y);
  scaled_.elementWiseMultiply(1., scale_, y, 0.);
  const auto b = device_read(scaled_);
  chebyshev(largest_, smallest_, degree_, [&](const int k, const double keep, const double add) {
    const bool at_zero = k == 0;
    if (!at_zero) A_.apply(y, product_);
    const auto product = device_read(product_);
    const auto move = device_write(move_), to = device_write(y);
    Kokkos::parallel_for(
        "rpc::solver::step_of_pressures", device_range(static_cast<LO>(y.getLocalLength())), KOKKOS_LAMBDA(const LO m) {
          move(m) = at_zero ? add * b(m) : keep * move(m) + add * (b(m) - product(m));
          to(m) = at_zero ? move(m) : to(m) + move(m);
        });
    Kokkos::fence();
  });
  y.elementWiseMultiply(1., scale_, y, 0.);
  without_smooth(y);
}

} // namespace rpc::solver
